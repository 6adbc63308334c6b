"""Tests for racing.py, and of runs that race."""

import math
from contextlib import closing

import numpy as np
import pytest
from scipy.stats import t

from hypermap_lite.evaluation.aggregation import summarize
from hypermap_lite.evaluation.executors import InProcessExecutor, ProcessExecutor
from hypermap_lite.evaluation.observer import RunObserver
from hypermap_lite.evaluation.outcome import Outcome, Replicate, State, Suggestion
from hypermap_lite.evaluation.racing import Race, Rivals, moderate
from hypermap_lite.objectives import Goal, Objective
from hypermap_lite.scenario.model import RacingSpec
from tests.evaluation.examples import function
from tests.evaluation.test_runner import Killed, everything, rows, run

OBJECTIVES = (Objective(name="f"), Objective(name="g", goal=Goal.MAXIMIZE))
SPEC = RacingSpec(alpha=0.05, minimum=3, step=2)


def calls_of(samples, trial=0, state=State.COMPLETED):
    """Return a call for each row of samples, shape (r, 2), in the objectives' own directions."""
    return [
        Replicate(
            trial=trial,
            replicate=r,
            seed=r,
            configuration={"x": float(trial)},
            outcome=Outcome(state=state, values={"f": float(f), "g": float(g)} if state is State.COMPLETED else {}),
            seconds=0.0,
        )
        for r, (f, g) in enumerate(samples)
    ]


def row_of(samples, trial=0):
    suggestion = Suggestion(trial=trial, configuration={"x": float(trial)}, phase="design")
    return summarize(suggestion, calls_of(samples, trial))


def scatter(f, g, n, width=0.1):
    """Return n results whose mean is exactly (f, g), shape (n, 2)."""
    steps = width * (np.arange(n) - (n - 1) / 2)
    return np.column_stack([f + steps, g - steps])


def suggestion(phase="model"):
    return Suggestion(trial=9, configuration={"x": 9.0}, phase=phase)


def race_against(*samples, spec=SPEC, replicates=7):
    return Race.against([row_of(s, trial) for trial, s in enumerate(samples)], OBJECTIVES, spec, replicates)


GOOD = scatter(0.0, 10.0, 7)
"""f is to be minimized, g to be maximized."""


def test_variance_is_the_larger_of_own_and_shrunk():
    # own 9, usual 3: shrunk to (4 * 3 + 2 * 9) / 6 = 5, so the own one; own 0: shrunk to 2
    assert moderate(np.array([9.0, 0.0]), np.array([3.0, 3.0]), 2).tolist() == [9.0, 2.0]


@pytest.mark.parametrize("side", [-1, 1])
def test_test_is_welchs_with_moderated_variances(side):
    # Rival: mean 0, variance 7 / 7 = 1 with 6 + 4 degrees of freedom. The other: variance 9 / 3 = 3 with 2 + 4.
    rivals = Rivals.of(np.zeros((1, 1)), np.full((1, 1), 7.0), 7)
    freedom = 4**2 / (1**2 / 10 + 3**2 / 6)
    needed = t.ppf(1 - 0.01, freedom) * 2
    Y = needed + side * 1e-9 + np.array([[-3.0], [0.0], [3.0]])
    assert rivals.beat(Y, 0.01) == (side > 0)


def test_level_is_divided_among_the_rivals():
    Y = np.array([[-3.0], [0.0], [3.0]])
    alone = Rivals.of(np.zeros((1, 1)), np.full((1, 1), 7.0), 7)
    among = Rivals.of(np.array([[0.0], [50.0], [60.0], [70.0]]), np.full((4, 1), 7.0), 7)
    for shift in np.linspace(0, 12, 40):
        assert among.beat(Y + shift, 0.04) == alone.beat(Y + shift, 0.01)


def test_looks_lie_between_the_minimum_and_the_last_replicate():
    assert list(race_against(GOOD).looks) == [3, 5]
    assert list(race_against(GOOD, spec=RacingSpec(minimum=2, step=1), replicates=4).looks) == [2, 3]
    assert list(race_against(GOOD, spec=None).looks) == []


@pytest.mark.parametrize(
    ("place", "required"),
    [
        pytest.param((50.0, -50.0), 3, id="much worse in both"),
        pytest.param((50.0, 10.0), 7, id="as good in one"),
        pytest.param((50.0, 50.0), 7, id="better in one"),
        pytest.param((0.65, 9.35), 5, id="worse by less: stopped at the second look"),
        pytest.param((0.2, 9.8), 7, id="a little worse"),
    ],
)
def test_only_what_is_worse_in_all_objectives_is_stopped(place, required):
    race, calls = race_against(GOOD), calls_of(scatter(*place, 7, width=0.2))
    n = 0
    while (needed := race.required(suggestion(), calls[:n])) > n:
        n = needed
    assert n == required


def test_next_look_waits_for_all_calls_before_it():
    race, calls = race_against(GOOD), calls_of(scatter(50.0, -50.0, 7))
    assert race.required(suggestion(), []) == 3
    assert race.required(suggestion(), [calls[0], calls[2], calls[3]]) == 3
    assert race.required(suggestion(), [calls[2], calls[0], calls[1]]) == 3
    undecided = calls_of(scatter(0.0, 10.0, 7))
    assert race.required(suggestion(), undecided[:3]) == 5


def test_configuration_with_a_failed_call_is_not_stopped():
    calls = [*calls_of(scatter(50.0, -50.0, 2)), *calls_of([(0, 0)] * 3, state=State.FAILED)[2:]]
    more = calls_of(scatter(50.0, -50.0, 5))[3:]
    assert race_against(GOOD).required(suggestion(), calls) == 5
    assert race_against(GOOD).required(suggestion(), [*calls, *more]) == 7


def test_repetition_that_confirms_gets_all_replicates():
    calls = calls_of(scatter(50.0, -50.0, 3))
    assert race_against(GOOD).required(suggestion("confirm"), calls) == 7


@pytest.mark.parametrize(
    "race",
    [
        pytest.param(race_against(), id="no row"),
        pytest.param(race_against(GOOD[:3]), id="rows that were stopped themselves"),
        pytest.param(race_against(GOOD, spec=None), id="no racing"),
    ],
)
def test_without_rivals_all_replicates_are_made(race):
    assert race.required(suggestion(), calls_of(scatter(50.0, -50.0, 3))) == 7


def test_equal_results_are_no_proof_where_others_scatter():
    wide, failing = scatter(0.0, 10.0, 7, width=10.0), np.array([[20.0, -10.0]] * 3)
    assert race_against(wide).required(suggestion(), calls_of(failing)) > 3
    assert race_against(GOOD).required(suggestion(), calls_of(failing)) == 3


def test_huge_values_stop_nobody_by_accident():
    race = race_against(np.array([[1e200, 1e200], [-1e200, 0.0]] * 4)[:7])
    assert race.required(suggestion(), calls_of(np.array([[1e300, -1e300], [-1e300, 1e300], [1e300, 0]]))) > 3


def play(rng, mean, std, race):
    """Return how many replicates a configuration gets that is normal around a mean, shape (2,), to be minimized."""
    samples = (mean + std * rng.standard_normal((race.replicates, 2))) * [1, -1]
    calls, n = calls_of(samples), 0
    while (needed := race.required(suggestion(), calls[:n])) > n:
        n = needed
    return n


def simulated_race(rng, stds, spec):
    """Return a race against 30 normal configurations on a concave front, of which the luckiest lead."""
    angles = rng.uniform(0, np.pi / 2, 30)
    means = -np.column_stack([np.cos(angles), np.sin(angles)])
    found = [(m + s * rng.standard_normal((5, 2))) * [1, -1] for m, s in zip(means, stds, strict=True)]
    return race_against(*found, spec=spec, replicates=5)


@pytest.mark.slow
@pytest.mark.parametrize("spread", ["even", "uneven"])
def test_errors_on_what_is_not_dominated_are_rarer_than_stated(spread):
    """On the front itself, the worst case: no configuration dominates another, and lucky ones look as if they did."""
    rng, stopped, n = np.random.default_rng(1), 0, 500
    spec = RacingSpec(alpha=0.1, minimum=2, step=1)
    for _ in range(n):
        stds = np.full((30, 1), 0.3) if spread == "even" else np.exp(rng.uniform(-4, 0, (30, 1)))
        race = simulated_race(rng, stds, spec)
        angle = rng.uniform(0, np.pi / 2)
        std = 0.3 if spread == "even" else np.exp(rng.uniform(-4, 0))
        stopped += play(rng, -np.array([np.cos(angle), np.sin(angle)]), std, race) < 5
    assert stopped / n <= 0.1


def normal(rng, n):
    return rng.standard_normal((n, 6))


def uneven(rng, n):
    return np.exp(rng.uniform(-4, 0, (n, 1))) * rng.standard_normal((n, 6))


def mostly_exact(rng, n):
    return np.where(rng.random((n, 1)) < 0.7, 0.02, 1.0) * rng.standard_normal((n, 6))


def scattering_most(rng, n):
    """Deviations of 1 where those of the rivals lie between 0.02 and 1."""
    return rng.standard_normal((n, 6))


def of_two_kinds(rng, n):
    return np.where(rng.random((n, 6)) < 0.5, -1.0, 1.0) + 0.02 * rng.standard_normal((n, 6))


@pytest.mark.parametrize(
    ("rivals", "own"),
    [
        pytest.param(normal, normal, id="normal"),
        pytest.param(uneven, uneven, id="uneven"),
        pytest.param(mostly_exact, mostly_exact, id="mostly exact"),
        pytest.param(uneven, scattering_most, id="scattering most"),
        pytest.param(of_two_kinds, of_two_kinds, id="of two kinds"),
    ],
)
def test_errors_with_one_objective_are_rarer_than_stated(rivals, own):
    """One objective and 40 rivals of the same mean, of which the luckiest counts: nothing else protects."""
    rng, stopped, n = np.random.default_rng(2), 0, 1000
    spec = RacingSpec(alpha=0.1, minimum=3, step=1)
    for _ in range(n):
        samples, Y = rivals(rng, 40), own(rng, 1)[0, :, None]
        found = Rivals.of(samples.mean(axis=1)[:, None], samples.var(axis=1, ddof=1)[:, None], 6)
        stopped += any(found.beat(Y[:look], spec.alpha / 3) for look in (3, 4, 5))
    assert stopped / n <= 0.1


def test_test_is_no_looser_than_it_must_be():
    """One look at one objective, a rival that scatters as much, and many degrees of freedom: the level is met."""
    rng, stopped, n = np.random.default_rng(3), 0, 4000
    for _ in range(n):
        sample = rng.standard_normal(50)
        rivals = Rivals.of(np.array([[sample.mean()]]), np.array([[sample.var(ddof=1)]]), 50)
        stopped += rivals.beat(rng.standard_normal((50, 1)), 0.2)
    assert stopped / n == pytest.approx(0.2, abs=0.025)


def test_clearly_dominated_configurations_save_most_of_what_can_be_saved():
    rng, saved = np.random.default_rng(4), []
    for _ in range(200):
        race = simulated_race(rng, np.full((30, 1), 0.05), RacingSpec(minimum=2, step=1))
        saved.append(5 - play(rng, np.array([1.0, 1.0]), 0.05, race))
    assert np.mean(saved) > 1.5  # of 3


RACING = {"racing": RacingSpec(minimum=2, step=1), "replicates": 4}


def noisy(request):
    x, rng = request.configuration["x"], np.random.default_rng(request.seed)
    values = {"f": x**2 + 0.001 * rng.standard_normal(), "g": (x - 0.5) ** 2 + 0.001 * rng.standard_normal()}
    return Outcome(state=State.COMPLETED, values=values)


def test_run_makes_fewer_calls_and_says_how_many(tmp_path):
    run(tmp_path, noisy, n=12, **RACING)
    history, calls = rows(tmp_path, "history.csv"), rows(tmp_path, "evaluations.csv")
    counts = [sum(call["trial"] == row["trial"] for call in calls) for row in history]
    assert counts == [int(row["replicates"]) for row in history]
    assert set(counts) >= {2, 4}
    assert counts[0] == 4
    for row, n in zip(history, counts, strict=True):
        values = [float(call["f"]) for call in calls if call["trial"] == row["trial"]]
        assert len(values) == n
        assert float(row["f"]) == math.fsum(values) / n


def test_members_of_the_front_have_all_replicates(tmp_path):
    run(tmp_path, noisy, n=12, **RACING)
    assert {row["replicates"] for row in rows(tmp_path, "pareto.csv")} == {"4"}


class NoisyUntil:
    def __init__(self, n):
        self.remaining = n

    def __call__(self, request):
        if self.remaining == 0:
            raise Killed
        self.remaining -= 1
        return noisy(request)


@pytest.mark.parametrize("batch", [1, 3])
def test_raced_run_killed_at_any_call_ends_like_one_that_was_not(tmp_path, batch):
    options = {"n": 5, "batch": batch, **RACING}
    run(tmp_path / "whole", noisy, **options)
    n_calls = len(rows(tmp_path / "whole", "evaluations.csv"))
    assert n_calls < 20
    for n in range(n_calls):
        path = tmp_path / str(n)
        with pytest.raises(Killed):
            run(path, NoisyUntil(n), **options)
        run(path, NoisyUntil(n_calls - n), **options)
        assert everything(path) == everything(tmp_path / "whole")


@pytest.mark.parametrize("batch", [1, 3])
def test_number_of_workers_does_not_matter(tmp_path, batch):
    for name, executor in (("here", InProcessExecutor()), ("one", ProcessExecutor(1)), ("two", ProcessExecutor(2))):
        with closing(executor):
            run(tmp_path / name, function("scattering"), executor=executor, n=9, batch=batch, **RACING)
    assert everything(tmp_path / "here") == everything(tmp_path / "one") == everything(tmp_path / "two")
    assert len(rows(tmp_path / "here", "evaluations.csv")) < 36


def test_call_that_is_missing_before_a_look_is_made_up_for(tmp_path):
    options = {"n": 5, **RACING}
    run(tmp_path / "whole", noisy, **options)
    run(tmp_path / "cut", noisy, n=4, **RACING)
    calls = tmp_path / "cut" / "evaluations.csv"
    whole = (tmp_path / "whole" / "evaluations.csv").read_text().splitlines(keepends=True)
    last = [line for line in whole if line.startswith("4,")]
    calls.write_text(calls.read_text() + "".join(last[1:]))  # the first call of the last trial is lost
    run(tmp_path / "cut", noisy, **options)
    assert everything(tmp_path / "cut") == everything(tmp_path / "whole")


def test_progress_is_told_the_most_calls_there_can_be(tmp_path):
    seen = []

    class Counting(RunObserver):
        def on_suggestions(self, trials, n_calls):
            seen.append(n_calls)

    run(tmp_path, noisy, n=6, batch=2, observer=Counting(), **RACING)
    assert seen == [8, 8, 8]
