"""The trials before there is a model."""

import pytest

from hypermap_lite.design import DESIGNS, Grid, PriorSampling, RandomSampling, Sobol
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.objectives import Objective
from hypermap_lite.optimizers.initial import InitialPhase
from hypermap_lite.priors import AsJoint, GaussianPrior, ProductPrior
from hypermap_lite.space import Constraint, IntegerParameter, RealParameter, SearchSpace

LINE = SearchSpace((RealParameter(name="x", low=0, high=1, default=0.5),))


def test_the_default_counts_as_one_of_the_samples() -> None:
    phase = InitialPhase(LINE, ProductPrior(1), Sobol(), 4, seed=0)
    assert len(phase) == 4
    assert phase.suggestion(0).configuration == {"x": 0.5}
    assert [phase.suggestion(i).phase for i in range(4)] == ["default", "design", "design", "design"]


@pytest.mark.parametrize("constraint", [None, "x <= 2/3", "x >= 2/3", "x == 2/3 or x > 0.9"])
def test_a_default_of_many_digits_is_the_default_and_allowed(constraint: str | None) -> None:
    parameters = (RealParameter(name="x", low=0, high=1, default=2 / 3),)
    space = SearchSpace(parameters, () if constraint is None else (Constraint(constraint, parameters),))
    first = InitialPhase(space, ProductPrior(1), Sobol(), 4, seed=0).suggestion(0)
    assert first.phase == "default"
    assert space.contains(first.configuration)


def test_the_default_is_not_repeated_by_the_design() -> None:
    space = SearchSpace((IntegerParameter(name="n", low=0, high=2, default=1),))
    phase = InitialPhase(space, ProductPrior(1), RandomSampling(), 10, seed=0)
    assert sorted(phase.suggestion(i).configuration["n"] for i in range(len(phase))) == [0, 1, 2]


@pytest.mark.parametrize("design", [Sobol(), RandomSampling()])
def test_rows_that_are_there_are_not_in_the_design_whatever_their_last_digits(design: Sobol | RandomSampling) -> None:
    space = SearchSpace(
        tuple(RealParameter(name=f"x{j}", low=a, high=b) for j, (a, b) in enumerate([(0.05, 2), (0.25, 1.3), (2, 15)]))
    )
    for seed in range(6):
        rows = InitialPhase(space, ProductPrior(3), design, 40, seed=seed).configurations[:20]
        history = History(space, [Objective(name="f")])
        for trial, row in enumerate(rows):
            suggestion = Suggestion(trial=trial, configuration=row, phase="earlier")
            history.append(Evaluation(suggestion=suggestion, state=State.COMPLETED, values={"f": 0.0}))
        rest = InitialPhase(space, ProductPrior(3), design, 40, seed=seed, history=history).configurations
        assert len(rest) == 20
        assert not [c for c in rest if c in rows]


def test_there_may_be_no_design() -> None:
    bare = SearchSpace((RealParameter(name="x", low=0, high=1),))
    assert len(InitialPhase(bare, ProductPrior(1), Sobol(), 0, seed=0)) == 0


def test_a_default_leaves_the_design_whole() -> None:
    square = SearchSpace(tuple(RealParameter(name=n, low=0, high=1, default=0.3) for n in "ab"))
    phase = InitialPhase(square, ProductPrior(2), Grid(), 10, seed=0)
    assert [phase.suggestion(0).phase, len(phase)] == ["default", 10]
    others = {tuple(phase.suggestion(i).configuration.values()) for i in range(1, 10)}
    assert others == {(a, b) for a in (0.0, 0.5, 1.0) for b in (0.0, 0.5, 1.0)}


def test_the_same_seed_gives_the_same_first_trials() -> None:
    a, b = (InitialPhase(LINE, ProductPrior(1), Sobol(), 6, seed=7) for _ in range(2))
    assert [a.suggestion(i) for i in range(6)] == [b.suggestion(i) for i in range(6)]


@pytest.mark.parametrize("name", list(DESIGNS))
def test_a_partial_default_is_completed_by_the_design(name: str) -> None:
    space = SearchSpace((RealParameter(name="a", low=0, high=1, default=0.3), RealParameter(name="b", low=0, high=1)))
    phase = InitialPhase(space, ProductPrior(2), DESIGNS[name](), 4, seed=0)
    first = phase.suggestion(0)
    assert (first.phase, first.configuration["a"]) == ("default", 0.3)
    assert 0 <= first.configuration["b"] <= 1
    assert [phase.suggestion(i).phase for i in range(1, len(phase))] == ["design"] * (len(phase) - 1)


def test_a_partial_default_is_completed_from_the_prior_where_the_design_draws_from_it() -> None:
    axis = RealParameter(name="b", low=0, high=1)
    space = SearchSpace((RealParameter(name="a", low=0, high=1, default=0.3), axis))
    prior = ProductPrior(2, (((1,), AsJoint(GaussianPrior(mean=0.8, std=0.01).on(axis))),))
    phase = InitialPhase(space, prior, PriorSampling(), 4, seed=0)
    assert phase.suggestion(0).configuration["b"] == pytest.approx(0.8, abs=0.05)


def test_completing_a_default_leaves_the_points_of_the_design_as_they_were() -> None:
    bare = SearchSpace(tuple(RealParameter(name=n, low=0, high=1) for n in "ab"))
    partial = SearchSpace((RealParameter(name="a", low=0, high=1, default=0.3), bare.parameters[1]))
    phase = InitialPhase(partial, ProductPrior(2), Sobol(), 4, seed=0)
    assert phase.configurations[1:] == InitialPhase(bare, ProductPrior(2), Sobol(), 3, seed=0).configurations


def test_design_without_earlier_rows_does_not_depend_on_the_history() -> None:
    with_history = InitialPhase(LINE, ProductPrior(1), Sobol(), 6, seed=7, history=History(LINE, [Objective(name="f")]))
    assert with_history.configurations == InitialPhase(LINE, ProductPrior(1), Sobol(), 6, seed=7).configurations
    assert (with_history.n_earlier, with_history.n_beyond) == (0, 0)


@pytest.mark.parametrize(("n_earlier", "n_own", "n_beyond"), [(2, 4, 0), (6, 0, 0), (8, 0, 2)])
def test_earlier_rows_count_towards_the_design(n_earlier: int, n_own: int, n_beyond: int) -> None:
    history = History(LINE, [Objective(name="f")])
    for trial in range(n_earlier):
        suggestion = Suggestion(trial=trial, configuration={"x": trial / 10}, phase="earlier")
        history.append(Evaluation(suggestion=suggestion, state=State.COMPLETED, values={"f": 0.0}))
    phase = InitialPhase(LINE, ProductPrior(1), Sobol(), 6, seed=7, history=history)
    assert (len(phase.configurations), len(phase), phase.n_beyond) == (n_own, n_earlier + n_own, n_beyond)
