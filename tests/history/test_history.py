"""The record of a run in memory."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.history.pooling import pooled
from hypermap_lite.objectives import Goal, Objective
from hypermap_lite.space import RealParameter, SearchSpace

SPACE = SearchSpace((RealParameter(name="x", low=0, high=2),))
OBJECTIVES = (Objective(name="cost"), Objective(name="speed", goal=Goal.MAXIMIZE))


def row(trial: int, state: State = State.COMPLETED) -> Evaluation:
    values = {"cost": float(trial), "speed": 10.0 * trial} if state is State.COMPLETED else {}
    return Evaluation(
        suggestion=Suggestion(trial=trial, configuration={"x": 0.5 * trial}, phase="design"), state=state, values=values
    )


def test_only_completed_evaluations_have_values_which_are_minimized() -> None:
    history = History(SPACE, OBJECTIVES)
    history.extend([row(0), row(1, State.FAILED), row(2)])
    assert history.X().tolist() == [[0.0], [0.5]]
    assert history.Y().tolist() == [[0.0, 0.0], [2.0, -20.0]]
    assert history.X_all().shape == (3, 1)


def test_what_a_history_returns_grows_with_it_and_is_the_callers_to_write_to() -> None:
    history = History(SPACE, OBJECTIVES)
    history.append(row(0))
    for known in (history.X(), history.Y(), history.X_all()):
        known[:] = 7.0
    assert history.X().tolist() == history.X_all().tolist() == [[0.0]]
    assert history.Y().tolist() == [[0.0, 0.0]]
    history.append(row(1, State.FAILED))
    assert history.X().tolist() == [[0.0]]
    assert history.X_all().tolist() == [[0.0], [0.25]]
    history.append(row(2))
    assert history.X().tolist() == [[0.0], [0.5]]
    assert history.X_all().tolist() == [[0.0], [0.25], [0.5]]
    assert history.Y().tolist() == [[0.0, 0.0], [2.0, -20.0]]


def test_an_empty_history_has_the_right_shapes() -> None:
    history = History(SPACE, OBJECTIVES)
    assert history.X().shape == (0, 1)
    assert history.Y().shape == (0, 2)
    assert np.array_equal(history.X_all(), np.empty((0, 1)))


def test_a_history_in_any_order_keeps_the_order_of_its_rows_and_takes_each_trial_once() -> None:
    history = History(SPACE, OBJECTIVES, in_order=False)
    history.extend([row(2), row(0), row(3)])
    assert history.X().tolist() == [[0.5], [0.0], [0.75]]
    with pytest.raises(UsageError, match="trial 2 cannot be recorded: it is there already"):
        history.append(row(2))


def test_trials_come_in_order() -> None:
    history = History(SPACE, OBJECTIVES)
    with pytest.raises(UsageError, match="trial 1 cannot be recorded: the next trial is 0"):
        history.append(row(1))


def sampled(trial: int, x: float, sample: list[float], phase: str = "design") -> Evaluation:
    """Return the row of these replicates of the cost; the speed is ten times as much."""
    n, error = len(sample), np.std(sample, ddof=1) / np.sqrt(len(sample)) if len(sample) > 1 else np.nan
    return Evaluation(
        suggestion=Suggestion(trial=trial, configuration={"x": x}, phase=phase),
        state=State.COMPLETED,
        values={"cost": float(np.mean(sample)), "speed": 10 * float(np.mean(sample))},
        standard_errors={"cost": float(error), "speed": 10 * float(error)},
        replicates=n,
    )


def test_samples_pool_the_rows_of_a_configuration() -> None:
    history = History(SPACE, OBJECTIVES)
    history.extend([sampled(0, 1.0, [1, 3]), sampled(1, 2.0, [4, 4]), sampled(2, 1.0, [5, 7, 9], "confirm")])
    samples = history.samples()
    assert samples.X.tolist() == [[0.5], [1.0]]
    assert pytest.approx(np.array([[5, -50], [4, -40]])) == samples.Y
    assert samples.replicates.tolist() == [5, 2]
    assert samples.freedom.tolist() == [[4, 4], [1, 1]]
    assert samples.own_variances == pytest.approx(np.array([[10, 1000], [0, 0]]))
    # pooled: (4 * 10 + 1 * 0) / 5 = 8; then (4 * 8 + 4 * 10) / 8 = 9 and (4 * 8 + 0) / 5 = 6.4
    assert samples.variances == pytest.approx(np.array([[9, 900], [6.4, 640]]))
    assert samples.noise_variance == pytest.approx(np.array([[9 / 5, 180], [3.2, 320]]))


def test_samples_of_the_first_rows_know_nothing_of_later_ones() -> None:
    history = History(SPACE, OBJECTIVES)
    history.extend([sampled(0, 1.0, [1, 3]), sampled(1, 2.0, [4, 4]), sampled(2, 1.0, [5, 7, 9], "confirm")])
    assert history.samples(2).Y[:, 0].tolist() == [2, 4]
    assert history.samples(2).replicates.tolist() == [2, 2]


def test_noise_is_not_known_from_single_replicates() -> None:
    history = History(SPACE, OBJECTIVES)
    history.extend([sampled(0, 1.0, [1]), sampled(1, 2.0, [4])])
    assert history.samples().noise_variance is None
    assert History(SPACE, OBJECTIVES).samples().X.shape == (0, 1)


def test_repeated_rows_of_single_replicates_tell_of_noise() -> None:
    history = History(SPACE, OBJECTIVES)
    history.extend([sampled(0, 1.0, [1], "earlier"), sampled(1, 1.0, [3], "earlier"), sampled(2, 2.0, [9])])
    assert history.samples().variances[:, 0] == pytest.approx([2.0, 2.0])
    assert history.samples().noise_variance[:, 0] == pytest.approx([1.0, 2.0])


@pytest.mark.parametrize("states", ["CI", "IC", "CCF"])
def test_sample_is_what_completed_of_an_earlier_configuration(states: str) -> None:
    history = History(SPACE, OBJECTIVES)
    for trial, state in enumerate(states):
        earlier = Suggestion(trial=trial, configuration={"x": 1.0}, phase="earlier")
        failed = Evaluation(suggestion=earlier, state=State.INFEASIBLE if state == "I" else State.FAILED)
        history.append(sampled(trial, 1.0, [1, 2], "earlier") if state == "C" else failed)
    assert history.samples().replicates.tolist() == [2 * states.count("C")]


@given(
    st.lists(
        st.tuples(st.sampled_from([0.5, 1.0, 2.0]), st.sampled_from(State), st.sampled_from(["earlier", "confirm"]))
    )
)
def test_samples_are_of_the_configurations_that_may_be_confirmed(rows: list[tuple[float, State, str]]) -> None:
    history = History(SPACE, OBJECTIVES)
    for trial, (x, state, phase) in enumerate(rows):
        suggestion = Suggestion(trial=trial, configuration={"x": x}, phase=phase)
        done = sampled(trial, x, [trial, 2 * trial], phase)
        history.append(done if state is State.COMPLETED else Evaluation(suggestion=suggestion, state=state))
    candidates = {e.configuration["x"] for e in pooled(history) if e.is_completed}
    assert sorted(candidates) == sorted(e["x"] for e in SPACE.decode(history.samples().X))


def test_configuration_whose_confirmation_failed_is_no_sample() -> None:
    history = History(SPACE, OBJECTIVES)
    failed = Suggestion(trial=1, configuration={"x": 1.0}, phase="confirm")
    history.extend([sampled(0, 1.0, [1, 2]), Evaluation(suggestion=failed, state=State.FAILED)])
    assert len(history.samples().X) == 0


def test_ends_of_samples_are_the_rows_that_bring_something_new() -> None:
    history = History(SPACE, OBJECTIVES)
    history.extend([sampled(0, 1.0, [1]), row(1, State.FAILED), sampled(2, 1.0, [3], "confirm"), sampled(3, 2.0, [9])])
    assert history.ends_of_samples() == [1, 4]
