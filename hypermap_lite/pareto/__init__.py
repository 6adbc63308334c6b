"""What several objectives add up to: the non-dominated set and the volume it dominates, all minimized."""

from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.pareto.hypervolume import hypervolume, hypervolume_trace, infer_reference_point

__all__ = ["hypervolume", "hypervolume_trace", "infer_reference_point", "non_dominated"]
