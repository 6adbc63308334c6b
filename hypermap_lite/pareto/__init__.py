"""What several objectives add up to: the front, the volume it dominates, what repeated runs attain; all minimized."""

from hypermap_lite.pareto.attainment import attainment_surface
from hypermap_lite.pareto.contributions import hypervolume_contributions
from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.pareto.hypervolume import hypervolume, hypervolume_trace, infer_reference_point

__all__ = [
    "attainment_surface",
    "hypervolume",
    "hypervolume_contributions",
    "hypervolume_trace",
    "infer_reference_point",
    "non_dominated",
]
