"""Tests for streaks.py."""

import csv
from contextlib import closing

import numpy as np
import pytest

from hypermap_lite.errors import RepeatedFailureError
from hypermap_lite.evaluation.executors import InProcessExecutor
from hypermap_lite.evaluation.outcome import Evaluation, Outcome, State, Suggestion
from hypermap_lite.evaluation.runner import Runner, StopReason
from hypermap_lite.evaluation.streaks import chance_by_parameters, failures_at_end, is_too_long
from hypermap_lite.scenario.model import MOST_FAILURES as MOST
from hypermap_lite.scenario.model import USUAL_FAILURES as USUAL
from hypermap_lite.scenario.model import BudgetSpec
from hypermap_lite.space.real import RealParameter
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.surrogates.feasibility import ProbitProcess
from tests.evaluation.examples import ScriptedOptimizer, folder

SPACE = SearchSpace(tuple(RealParameter(name=name, low=0.0, high=1.0) for name in "ab"))
RNG = np.random.default_rng(5)
SPREAD = RNG.random((24, 2))
BELOW = 0.4 * RNG.random((30, 2))


def rows_of(X, states) -> list[Evaluation]:
    return [
        Evaluation(
            suggestion=Suggestion(trial=i, configuration={"a": float(x[0]), "b": float(x[1])}, phase="model"),
            state=state,
            values={"f": 1.0} if state is State.COMPLETED else {},
        )
        for i, (x, state) in enumerate(zip(X, states, strict=True))
    ]


def by_region(X) -> list[State]:
    return [State.FAILED if x.sum() < 0.8 else State.COMPLETED for x in X]


def in_region(n: int) -> list[Evaluation]:
    """Return evaluations all over the space, of which a third fail, and n that fail where others did."""
    X = np.vstack([SPREAD, [[0.9, 0.9]], BELOW[:n]])
    return rows_of(X, by_region(X))


def broken(n: int) -> list[Evaluation]:
    """Return evaluations all over the space, of which none fails, and n all over the space that fail."""
    X = np.vstack([SPREAD, np.random.default_rng(7).random((n, 2))])
    return rows_of(X, [State.COMPLETED] * 24 + [State.TIMEOUT] * n)


def test_failures_where_others_failed_are_likely_and_those_of_a_broken_evaluator_are_not() -> None:
    assert chance_by_parameters(in_region(USUAL), USUAL, SPACE) > 0.1
    assert chance_by_parameters(broken(USUAL), USUAL, SPACE) < 1e-3


@pytest.mark.parametrize("n", [1, USUAL - 1, USUAL, 8, MOST - 1, MOST])
def test_failures_that_their_parameters_explain_end_a_run_late_only(n: int) -> None:
    assert is_too_long(in_region(n), n, SPACE) == (n >= MOST)
    assert is_too_long(broken(n), n, SPACE) == (n >= USUAL)


@pytest.mark.parametrize("n", [USUAL - 1, USUAL])
def test_where_nothing_ever_worked_the_usual_number_is_enough(n: int) -> None:
    assert is_too_long(rows_of(SPREAD[:n], [State.FAILED] * n), n, SPACE) == (n >= USUAL)


def test_a_number_that_is_given_counts_whatever_explains_the_failures() -> None:
    rows = in_region(8)
    assert [is_too_long(rows, n, SPACE, limit=3) for n in (2, 3, 8)] == [False, True, True]
    assert not is_too_long(broken(8), 8, SPACE, limit=30)


def test_infeasible_evaluations_are_results() -> None:
    X = np.vstack([SPREAD, BELOW[:6]])
    rows = rows_of(X, [State.COMPLETED] * 24 + [State.INFEASIBLE] * 6)
    assert failures_at_end(rows, SPACE) == 0


def test_only_the_last_streak_is_looked_at_and_each_failure_once(monkeypatch) -> None:
    fits = []
    fit = ProbitProcess.fit
    monkeypatch.setattr(ProbitProcess, "fit", lambda self, X, *a, **k: fits.append(len(X)) or fit(self, X, *a, **k))
    X = np.vstack([SPREAD, BELOW[:9], [[0.9, 0.9]], BELOW[10:19]])
    assert failures_at_end(rows_of(X, by_region(X)), SPACE) == 9
    assert fits == [*range(34, 43)]


def test_after_a_stop_for_failures_the_count_begins_anew_and_else_goes_on() -> None:
    assert failures_at_end(broken(USUAL), SPACE) == 0
    assert failures_at_end(broken(USUAL + 2), SPACE) == 2
    assert failures_at_end(in_region(USUAL + 2), SPACE) == USUAL + 2
    assert failures_at_end(in_region(7), SPACE, limit=5) == 2


def test_failures_that_ended_a_run_do_not_explain_those_of_the_next_call() -> None:
    near_each_other = rows_of(np.vstack([SPREAD, BELOW[:15]]), [State.COMPLETED] * 24 + [State.FAILED] * 15)
    for rows in (near_each_other, broken(15)):
        assert [failures_at_end(rows[: 24 + n], SPACE) for n in (4, 5, 9, 10, 14, 15)] == [4, 0, 4, 0, 4, 0]


class Probing(ScriptedOptimizer):
    """Suggests points all over [-2, 2], but trials 30 to 39 in [0.8, 1.2]."""

    def _suggest(self, trial: int) -> Suggestion | None:
        u = np.random.default_rng(trial).random()
        x = 0.8 + 0.4 * u if 30 <= trial < 40 else 4 * u - 2
        return Suggestion(trial=trial, configuration={"x": float(x)}, phase="model")


def run(path, is_bad, n):
    def evaluate(request):
        if is_bad(request.trial, x := request.configuration["x"]):
            raise ValueError("no inverse kinematics")
        return Outcome(state=State.COMPLETED, values={"f": x, "g": -x})

    with folder(path) as open_folder, closing(InProcessExecutor()) as executor:
        return Runner(
            optimizer=Probing(),
            evaluator=evaluate,
            executor=executor,
            folder=open_folder,
            budget=BudgetSpec(evaluations=n),
            seed=0,
        ).run()


def configurations(path) -> list[tuple[str, str]]:
    with (path / "history.csv").open() as file:
        return [(row["x"], row["state"]) for row in csv.DictReader(file)]


def test_a_run_ends_five_failures_after_its_evaluator_broke(tmp_path) -> None:
    with pytest.raises(RepeatedFailureError, match="last 5 configurations"):
        run(tmp_path, lambda trial, _: trial >= 20, 60)
    assert len(configurations(tmp_path)) == 25


def test_a_run_with_a_streak_that_its_parameters_explain_goes_on_and_may_be_resumed_within(tmp_path) -> None:
    assert run(tmp_path / "whole", lambda _, x: x > 0.6, 60) is StopReason.BUDGET
    for n in (33, 37, 60):
        run(tmp_path / "parts", lambda _, x: x > 0.6, n)
    assert configurations(tmp_path / "whole") == configurations(tmp_path / "parts")
    assert len(configurations(tmp_path / "whole")) == 60
