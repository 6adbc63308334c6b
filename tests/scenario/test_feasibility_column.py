"""Tests for feasibility_column.py."""

from __future__ import annotations

import pytest

from hypermap_lite.scenario.feasibility_column import FeasibilityColumn, usual_feasibility


@pytest.mark.parametrize(
    ("text", "verdict"),
    [("True", True), ("true", True), ("1", True), ("FALSE", False), ("0", False), ("", None), ("perhaps", None)],
)
def test_usual_column_says_it_in_many_ways(text: str, verdict: bool | None) -> None:
    (column,) = usual_feasibility(["x", "Valid"], ["x"])
    assert column.is_feasible(text) is verdict


def test_scenarios_own_texts_count_alone() -> None:
    column = FeasibilityColumn.of({"feasible_output": {"name": "ok", "true_value": "YES", "false_value": "NO"}})
    assert column is not None
    assert [column.is_feasible(text) for text in ("yes", "NO", "1")] == [True, False, None]


def test_texts_that_differ_in_case_alone_are_told_apart() -> None:
    column = FeasibilityColumn(name="ok", yes=("T",), no=("t",))
    assert (column.is_feasible("T"), column.is_feasible("t")) == (True, False)


def test_column_that_is_a_parameter_says_nothing() -> None:
    assert usual_feasibility(["Valid", "f"], ["Valid", "f"]) == []
    assert FeasibilityColumn.of({"feasible_output": None}) is None
