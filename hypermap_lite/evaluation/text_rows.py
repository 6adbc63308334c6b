"""Rows of text, as clients and tables hold them, turned into outcomes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final

from hypermap_lite.evaluation.evaluator import FEASIBLE_KEY, outcome_of
from hypermap_lite.evaluation.outcome import Outcome, State
from hypermap_lite.objectives import FeasibleOutput

INFEASIBLE: Final = "the black box answered: not feasible"

_TRUTH: Final = {"true": 1.0, "false": 0.0}


def outcome_of_texts(
    row: Mapping[str, str],
    objectives: Sequence[str],
    feasible: FeasibleOutput | None = None,
    extras: Sequence[str] = (),
) -> Outcome:
    """Return what a row says.

    Parameters
    ----------
    row
        Texts by column.
    objectives
        Names of the objectives.
    feasible
        The column that says whether the row is feasible, if there is one.
    extras
        Other columns, of which finite numbers become metrics; a column ``feasible`` among them counts if it is not
        that of an objective.

    Returns
    -------
    Outcome
        Completed; failed if an objective is NaN or infinite; or infeasible, with those values that are finite.

    Raises
    ------
    ValueError
        If an objective is no number, or the feasibility neither of its two texts.
    """
    numbers = _extra_numbers(row, extras)
    if feasible is None or _is_feasible(feasible, row[feasible.name]):
        return outcome_of({**{name: _number(row[name], name) for name in objectives}, **numbers}, objectives)
    given = {name: _number(row[name], name) for name in objectives if row[name]}
    values = {name: value for name, value in given.items() if math.isfinite(value)}
    metrics = {name: value for name, value in numbers.items() if math.isfinite(value)}
    return Outcome(state=State.INFEASIBLE, values=values, metrics=metrics, error=INFEASIBLE)


def _is_feasible(output: FeasibleOutput, text: str) -> bool:
    verdict = output.verdict(text, None)
    if verdict is None:
        raise ValueError(f"'{output.name}' is {text!r}, neither {output.true_value!r} nor {output.false_value!r}")
    return verdict


def _extra_numbers(row: Mapping[str, str], names: Sequence[str]) -> dict[str, float]:
    numbers = {}
    for name in names:
        text = row[name].lower()
        if name == FEASIBLE_KEY and text in _TRUTH:
            numbers[name] = _TRUTH[text]
            continue
        try:
            numbers[name] = float(text)
        except ValueError:
            continue
    return numbers


def _number(text: str, name: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"'{name}' is {text!r}, not a number") from None
