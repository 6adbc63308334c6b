"""From the replicates of one configuration to one row of the history."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from hypermap_lite.evaluation.outcome import WORST_FIRST, Evaluation, Replicate, State, Suggestion

_PHRASES: Final = {
    State.FAILED: "failed",
    State.TIMEOUT: "ran past the time limit",
    State.INFEASIBLE: "were infeasible",
}


def summarize(suggestion: Suggestion, replicates: Sequence[Replicate], timestamp: int = 0) -> Evaluation:
    """Average the replicates of a configuration.

    Parameters
    ----------
    suggestion
        The configuration and why it was chosen.
    replicates
        All calls for it, at least one, in any order.
    timestamp
        Time of this row [ms since the start of the run].

    Returns
    -------
    Evaluation
        Means and standard errors (of the sample, divisor r - 1) if all replicates completed; else the worst state
        among them, with the reason of the first replicate in it. An infeasible configuration has the means over
        those replicates that have a value.
    """
    ordered = sorted(replicates, key=lambda r: r.replicate)
    states = [r.outcome.state for r in ordered]
    state = next((worst for worst in WORST_FIRST if worst in states), State.COMPLETED)
    columns: dict[str, list[float]] = {}
    for outcome in (r.outcome for r in ordered if state in (State.COMPLETED, State.INFEASIBLE)):
        for name, value in outcome.values.items():
            columns.setdefault(name, []).append(value)
    return Evaluation(
        suggestion=suggestion,
        state=state,
        values={name: mean(column) for name, column in columns.items()},
        standard_errors={name: standard_error(column) for name, column in columns.items()},
        replicates=len(ordered),
        seconds=math.fsum(r.seconds for r in ordered),
        timestamp=timestamp,
        error=_error(state, ordered),
    )


def _error(state: State, ordered: Sequence[Replicate]) -> str:
    if state is State.COMPLETED:
        return ""
    affected = [r for r in ordered if r.outcome.state is state]
    reason = affected[0].outcome.error
    if len(ordered) == 1:
        return reason
    return f"{len(affected)} of {len(ordered)} replicates {_PHRASES[state]}: {reason}"


def mean(values: Sequence[float]) -> float:
    """Return the mean, exact to the last bit whatever the order, and finite if the values are."""
    try:
        return math.fsum(values) / len(values)
    except OverflowError:
        return math.fsum(v / len(values) for v in values)


def standard_error(values: Sequence[float]) -> float:
    """Return the standard error of the mean; NaN for fewer than two values."""
    n = len(values)
    if n < 2:
        return math.nan
    center = mean(values)
    return math.hypot(*(v - center for v in values)) / math.sqrt((n - 1) * n)
