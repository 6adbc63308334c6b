"""The corner from which the hypervolume of one or several runs is measured, and how to say where it lies."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hypermap_lite.errors import UsageError, nearest
from hypermap_lite.objectives import to_minimization
from hypermap_lite.pareto import infer_reference_point
from hypermap_lite.plotting.runs import Run
from hypermap_lite.plotting.settled import settled
from hypermap_lite.typing import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ReferencePoint:
    """One value per objective, and whether somebody chose it."""

    values: FloatArray
    """In the user's units and directions, shape (m,)."""

    names: tuple[str, ...]
    is_inferred: bool
    """Whether at least one value was inferred from the fronts."""

    def __str__(self) -> str:
        """Return it as text for axis labels and messages."""
        values = ", ".join(f"{name} {number(value)}" for name, value in zip(self.names, self.values, strict=True))
        return f"{'inferred ' if self.is_inferred else ''}reference point: {values}"


def common_reference_point(runs: Sequence[Run], given: Mapping[str, float] | None = None) -> ReferencePoint:
    """Choose one reference point for all runs.

    Per objective: the value given here, else the scenarios', else the one inferred from the front of all runs
    together (`infer_reference_point`).

    Parameters
    ----------
    runs
        Runs with the same objectives and at least one completed evaluation.
    given
        Values by objective, in the user's units and directions.

    Returns
    -------
    ReferencePoint
        In the user's units and directions.

    Raises
    ------
    UsageError
        If `given` names no objective, or the scenarios disagree.
    """
    objectives = runs[0].objectives
    names = tuple(o.name for o in objectives)
    for name, value in (given or {}).items():
        if name not in names:
            hint = nearest(name, names)
            raise UsageError(
                f"reference point for an unknown objective '{name}'; known: {', '.join(names)}. {hint}".rstrip()
            )
        if not math.isfinite(value):
            raise UsageError(f"reference point of '{name}': expected a finite number, got {value}")
    chosen: dict[str, float | None] = {
        name: given[name] if given and name in given else _scenarios_value(runs, i) for i, name in enumerate(names)
    }
    inferred = to_minimization(objectives, infer_reference_point(np.vstack([settled(run).Y for run in runs])))
    values = [inferred[i] if chosen[name] is None else chosen[name] for i, name in enumerate(names)]
    return ReferencePoint(values=np.array(values, dtype=float), names=names, is_inferred=None in chosen.values())


def number(value: float, digits: int = 4) -> str:
    """Write a number for people: so many significant digits, no exponent where zeros do (1234.5 is 1234, not 1.2e3)."""
    rounded = float(f"{value:.{digits - 1}e}")
    return f"{rounded:.{digits}g}" if not 1 <= abs(rounded) < 1e7 else f"{rounded:.15g}"


def _scenarios_value(runs: Sequence[Run], objective: int) -> float | None:
    """Return the reference value on which the scenarios agree, or None if none gives one."""
    values = {v for run in runs if (v := run.objectives[objective].reference_point) is not None}
    if len(values) > 1:
        name = runs[0].objectives[objective].name
        listed = ", ".join(f"{v:g}" for v in sorted(values))
        raise UsageError(f"the scenarios' reference points for '{name}' differ ({listed}): pass one to use for all")
    return next(iter(values), None)
