"""Tests for next_feasible.py."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hypermap_lite.assembly import build_optimizer
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.optimizers import Optimizer
from hypermap_lite.optimizers.next_feasible import PATIENCE, WIDTHS, attempt, draw_near
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.space.categorical import CategoricalParameter
from hypermap_lite.space.integer import IntegerParameter
from hypermap_lite.space.real import RealParameter
from hypermap_lite.space.search_space import SearchSpace
from tests.optimizers.runs import resumed, scenario_of

SQUARE = SearchSpace(tuple(RealParameter(name=name, low=0.0, high=1.0) for name in "ab"))
CLASSIFIER = {"feasibility_weighting": {"next_feasible": "classifier"}}


def judged(suggestion: Suggestion, is_feasible: Callable[[Mapping[str, Any]], bool]) -> Evaluation:
    c = suggestion.configuration
    values = {"near": float(c["a"]) + float(c["b"]), "far": float(c["b"]) - float(c["a"])}
    state = State.COMPLETED if is_feasible(c) else State.INFEASIBLE
    return Evaluation(suggestion=suggestion, state=state, values=values)


def run(scenario, is_feasible, n: int, batch: int = 1) -> Optimizer:
    optimizer = build_optimizer(load_scenario(scenario))
    while len(optimizer.history) < n:
        optimizer.tell([judged(s, is_feasible) for s in optimizer.ask(min(batch, n - len(optimizer.history)))])
    return optimizer


def is_in_sliver(c: Mapping[str, Any]) -> bool:
    """Tell whether a point is in a twentieth of the space."""
    return abs(float(c["a"]) - 0.05) < 0.025


def scenario(**changes: Any) -> dict[str, Any]:
    parameters = {name: {"parameter_type": "real", "values": [0, 1]} for name in "abc"}
    return scenario_of(input_parameters=parameters, budget={"evaluations": 50}, **changes)


def n_feasible(optimizer: Optimizer) -> int:
    return len(optimizer.history.completed)


def test_more_of_a_sliver_is_found_next_to_its_first_point_than_by_the_classifier() -> None:
    near, without = (
        [n_feasible(run(scenario(seed=seed, acquisition=a), is_in_sliver, 40)) for seed in range(3)]
        for a in ({}, CLASSIFIER)
    )
    assert np.mean(near) > 1.5 * np.mean(without)


@pytest.mark.parametrize("batch", [1, 3])
def test_the_same_points_come_after_a_resume(batch: int) -> None:
    whole = list(run(scenario(seed=1), is_in_sliver, 30, batch).history)
    first = next(i for i, row in enumerate(whole) if row.is_completed)
    for n in (first + 1, first + 4, 27):
        n -= n % batch
        again = resumed(scenario(seed=1), whole[:n]).ask(batch)
        assert [replace(s, seconds=0.0) for s in again] == [
            replace(row.suggestion, seconds=0.0) for row in whole[n : n + batch]
        ]


def test_eight_others_in_a_row_call_for_five_draws_and_from_then_on_every_second_suggestion_is_one() -> None:
    known = np.zeros(40, dtype=bool)
    known[9] = True
    due = [attempt(known[:n]) for n in range(1, 41)]
    assert due[:17] == [None] * 17
    assert due[17:] == [0, 1, 2, 3, 4] + [k for later in range(5, 14) for k in (None, later)]
    assert [attempt(known[:n], n_pending=3) for n in (14, 15, 19, 20, 21)] == [None, 0, 4, None, 5]


def test_three_feasible_points_or_none_or_nothing_else_call_for_no_draw() -> None:
    infeasible = [False] * PATIENCE
    assert attempt(np.array([True, True, *infeasible])) == 0
    assert attempt(np.array([True, True, True, *infeasible])) is None
    assert attempt(np.array(infeasible)) is None
    assert attempt(np.array([True, True]), n_pending=PATIENCE) is None
    assert attempt(np.array([], dtype=bool)) is None


def test_draws_are_within_boxes_that_shrink_and_grow_again_around_each_feasible_point_by_turns() -> None:
    feasible, rng = np.array([[0.5, 0.4], [0.1, 0.9]]), np.random.default_rng(0)
    for k in range(2 * len(WIDTHS)):
        centre, width = feasible[::-1][k % 2], WIDTHS[k % len(WIDTHS)]
        X = np.array([draw_near(SQUARE, feasible, k, [], rng) for _ in range(200)])
        assert (np.abs(X - centre) <= width + 1e-12).all()
        assert (np.abs(X - centre).max(axis=0) > 0.9 * width).all()
        assert ((X >= 0) & (X <= 1)).all()


def test_categories_stay_and_what_is_known_is_not_drawn_again() -> None:
    mode = CategoricalParameter(name="mode", values=("slow", "fast"))
    space = SearchSpace((IntegerParameter(name="n", low=0, high=7), mode))
    rng, taken = np.random.default_rng(0), list[bytes]()
    centre = space.encode([{"n": 3, "mode": "fast"}])
    drawn = []
    while (x := draw_near(space, centre, 0, taken, rng)) is not None:
        taken += space.keys(x[None])
        drawn.append(space.decode(x[None])[0])
    assert sorted(int(c["n"]) for c in drawn) == [1, 2, 3, 4, 5]
    assert {c["mode"] for c in drawn} == {"fast"}


def test_known_constraints_hold() -> None:
    history = run(scenario(seed=1, constraints=["a + b + c <= 1.5"]), is_in_sliver, 40).history
    assert all(sum(float(v) for v in row.configuration.values()) <= 1.5 + 1e-9 for row in history)
    assert 0 < len(history.completed) < 40


def test_steps_that_a_prior_guides_are_not_replaced() -> None:
    asked = scenario(seed=1)
    asked["input_parameters"]["c"] |= {"prior": {"type": "gaussian", "mean": 0.5, "std": 0.2}}
    optimizer = build_optimizer(load_scenario(asked))
    while len(optimizer.history) < 40:
        optimizer.tell([judged(s, lambda _: len(optimizer.history) == 3) for s in optimizer.ask()])
    later = [row.suggestion for row in optimizer.history if row.suggestion.phase in {"model", "random"}]
    assert {s.phase for s in later if s.prior_weight} == {"model"}
    assert "random" in {s.phase for s in later if s.prior_weight == 0}


def test_evaluations_that_fail_count_as_infeasible() -> None:
    optimizer = build_optimizer(load_scenario(scenario(seed=1)))
    while len(optimizer.history) < 30:
        rows = [judged(s, lambda _: len(optimizer.history) == 3) for s in optimizer.ask()]
        optimizer.tell([row if row.is_completed else replace(row, state=State.FAILED, values={}) for row in rows])
    distances = np.abs(optimizer.history.X_all() - optimizer.history.X_all()[3]).max(axis=1)
    assert distances[4 : 4 + PATIENCE].max() > WIDTHS[0]
    assert (distances[4 + PATIENCE :][: len(WIDTHS)] <= WIDTHS).all()
