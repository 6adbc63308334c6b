"""What a run has found."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from hypermap_lite.evaluation.runner import StopReason
from hypermap_lite.reports import ParameterImportance, PosteriorFront

if TYPE_CHECKING:
    import pandas as pd

    from hypermap_lite.evaluation.outcome import Evaluation
    from hypermap_lite.typing import Configuration

Point = tuple["Configuration", Mapping[str, float]]
"""A configuration and its objective values, as the user directed them."""

MOST_SHOWN: Final = 5
"""Members of a front that are printed with a result."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """What a run has found."""

    evaluations: tuple[Evaluation, ...]
    """All configurations, trial 0 first, whatever their state."""

    pareto_front: tuple[Point, ...]
    """The non-dominated ones, in the order of their trials; for one objective the best, with its ties."""

    best: Point | None
    """The best one of a single objective, the first of equals; None for several objectives."""

    hypervolume: float | None
    """Volume between front and reference point; None for a single objective, without a front or beyond all floats."""

    reference_point: Mapping[str, float] | None
    """Corner the hypervolume is measured from: the scenario's, or inferred where an objective has none."""

    run_folder: Path
    stop_reason: StopReason
    parameter_importance: ParameterImportance | None = None
    """How much each parameter matters, if the scenario asks for it and there are enough evaluations."""

    posterior_best: PosteriorFront | None = None
    """What is best by the surrogate, likewise: the `posterior_front`."""

    posterior_front: PosteriorFront | None = None
    """The evaluated configurations that are best by the surrogate's means, as ``posterior_front.csv`` has them.

    None if there are too few evaluations for a model, or too many for one that no other part of the run needs.
    """

    def __str__(self) -> str:
        """Return how many evaluations ended how, why the run did, and what is best, a line each."""
        lines = [f"{count_states(self)}; the run ended because {self.stop_reason.value}"]
        if self.best is not None:
            lines.append(f"best: {_line(self.best)}")
        elif self.pareto_front:
            volume = "" if self.hypervolume is None else f", hypervolume {self.hypervolume:.6g}"
            n_more = len(self.pareto_front) - MOST_SHOWN
            lines.append(f"front of {len(self.pareto_front)}{volume}:")
            lines += [f"  {_line(point)}" for point in self.pareto_front[:MOST_SHOWN]]
            lines += [f"  and {n_more} more"] * (n_more > 0)
        return "\n".join([*lines, f"files in {self.run_folder}"])

    def to_frame(self) -> pd.DataFrame:
        """Return ``history.csv`` as a data frame: a row per configuration, every number as it was written."""
        import pandas as pd  # slow to import, used here only

        return pd.read_csv(self.run_folder / "history.csv")  # exact to the last digit since pandas 3.1


def count_states(result: Result) -> str:
    """Return how many evaluations ended how: ``60 evaluations: 58 completed, 2 failed``."""
    counts = Counter(evaluation.state.value for evaluation in result.evaluations)
    parts = ", ".join(f"{n} {state}" for state, n in counts.most_common())
    return f"{len(result.evaluations)} evaluation{'s' * (len(result.evaluations) != 1)}: {parts}"


def _line(point: Point) -> str:
    configuration, values = point
    return f"{_listed(values)} at {_listed(configuration)}"


def _listed(values: Mapping[str, Any]) -> str:
    texts = {name: f"{value:.6g}" if isinstance(value, float) else str(value) for name, value in values.items()}
    return ", ".join(f"{name}={text}" for name, text in texts.items())
