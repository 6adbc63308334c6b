"""What suggestions give adds up to what the run gained."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hypermap_lite import hypervolume

HOME = str(Path(__file__).parents[2] / "benchmarks")


@pytest.fixture(scope="module")
def benchmark():
    sys.path.insert(0, HOME)
    import kept_promises

    yield kept_promises
    sys.path.remove(HOME)


def short(benchmark, name, n):
    """Return a problem with n evaluations after the design."""
    problem = benchmark.PROBLEMS[name]
    return replace(problem, evaluations=problem.design + n)


def test_gains_of_the_suggestions_add_up_to_the_growth_of_the_run(benchmark, monkeypatch):
    problem, made, box = short(benchmark, "branin_currin", 6), [], benchmark.BlackBox
    monkeypatch.setattr(benchmark, "BlackBox", lambda *words: made.append(box(*words)) or made[0])
    steps = list(benchmark.steps_of(problem, 0))
    Y, reference_point = np.array(made[0].truths), np.array(problem.reference_point)
    growth = hypervolume(Y, reference_point) - hypervolume(Y[: problem.design], reference_point)
    assert len(steps) == 6
    assert sum(step.given for step in steps) == pytest.approx(growth / problem.best)
    assert all(step.promised > 0 for step in steps)


def test_model_of_a_smooth_problem_keeps_its_promises_and_that_of_a_cliff_does_not(benchmark):
    kept = {}
    for name in ("vehicle_safety", "penicillin"):
        promised, given, _ = np.sum(list(benchmark.steps_of(short(benchmark, name, 6), 0)), axis=0)
        kept[name] = given / promised
    assert kept["vehicle_safety"] > 0.5
    assert kept["penicillin"] < 0.2


def test_line_has_means_of_what_was_promised_and_the_share_that_was_given(benchmark):
    rows = [
        {"promised_0": "3", "given_0": "1", "promised_1": "1", "given_1": "1", "promised_2": "2", "given_2": "0"},
        {"promised_0": "1", "given_0": "1", "promised_1": "1", "given_1": "2", "promised_2": "2", "given_2": "0"},
    ]
    assert benchmark.line_of("p", rows) == ("p", "2", "2", "50 %", "1", "150 %", "2", "0 %")


def test_line_of_places_has_means_per_suggestion_and_the_share_of_the_promise(benchmark):
    row = dict.fromkeys(benchmark.COLUMNS[3:], "0")
    row |= {"suggestions_inside": "3", "promised_inside": "0.4", "given_inside": "0.3"}
    row |= {"suggestions_on_bounds": "1", "promised_on_bounds": "0.5", "given_on_bounds": "0.05"}
    assert benchmark.line_of_places("p", "m", [row, row]) == ("p", "m", "25 %", "0.1 (75 %)", "0.05 (10 %)")
    nowhere = row | {"suggestions_on_bounds": "0"}
    assert benchmark.line_of_places("p", "m", [nowhere])[2:] == ("0 %", "0.1 (75 %)", "")
