"""What holds for every maximizer."""

import numpy as np
import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.maximizers import MAXIMIZERS, MaximizationProblem
from hypermap_lite.priors import AsJoint, GaussianPrior, ProductPrior
from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, RealParameter, SearchSpace
from tests.constrained import SPACES, space_of

REAL = SearchSpace(tuple(RealParameter(name=f"r{i}", low=0, high=1) for i in range(3)))
MIXED = SearchSpace(
    (
        RealParameter(name="r", low=0, high=1),
        IntegerParameter(name="n", low=0, high=999),
        OrdinalParameter(name="o", values=(1.0, 2.0, 4.0)),
        CategoricalParameter(name="c", values=tuple("abcdefgh")),
    )
)
FINITE = SearchSpace(MIXED.parameters[2:])
every_maximizer = pytest.mark.parametrize("name", list(MAXIMIZERS))


class Bowl:
    """A quadratic with its maximum 0 at a known point."""

    def __init__(self, centre: np.ndarray, *, is_differentiable: bool = True) -> None:
        self.centre = centre
        self.is_differentiable = is_differentiable

    def __call__(self, X: np.ndarray) -> np.ndarray:
        return -((X - self.centre) ** 2).sum(axis=1)

    def with_gradient(self, X: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self(X), -2 * (X - self.centre)


def problem(space: SearchSpace, scorer: Bowl, *, seen: tuple[bytes, ...] = (), seed: int = 0) -> MaximizationProblem:
    return MaximizationProblem(
        scorer=scorer,
        space=space,
        prior=ProductPrior(space.dimension),
        incumbents=space.sample_uniform(2, np.random.default_rng(9)),
        seen=seen,
        rng=np.random.default_rng(seed),
    )


@every_maximizer
@pytest.mark.parametrize("is_differentiable", [True, False])
def test_the_maximum_of_a_real_space_is_found(name: str, is_differentiable: bool) -> None:
    centre = np.array([0.217, 0.5, 0.93])
    found = MAXIMIZERS[name]().maximize(problem(REAL, Bowl(centre, is_differentiable=is_differentiable)))
    assert found is not None
    assert found.x == pytest.approx(centre, abs=1e-3)


@every_maximizer
def test_the_maximum_of_a_mixed_space_is_found(name: str) -> None:
    centre = np.array([0.31, 0.7004, 0.5, 0.6875])
    found = MAXIMIZERS[name]().maximize(problem(MIXED, Bowl(centre)))
    assert found is not None
    assert MIXED.decode(found.x[None])[0] == {"r": pytest.approx(0.31, abs=1e-3), "n": 700, "o": 2.0, "c": "f"}


@every_maximizer
def test_a_maximum_at_the_bounds_is_found(name: str) -> None:
    found = MAXIMIZERS[name]().maximize(problem(REAL, Bowl(np.array([-1.0, 2.0, 0.5]))))
    assert found is not None
    assert found.x == pytest.approx([0, 1, 0.5], abs=1e-3)


@every_maximizer
@pytest.mark.parametrize("space", [REAL, MIXED, FINITE], ids=["real", "mixed", "finite"])
def test_seen_points_are_not_chosen_again(name: str, space: SearchSpace) -> None:
    scorer = Bowl(np.full(space.dimension, 0.5))
    seen: list[bytes] = []
    for _ in range(6):
        found = MAXIMIZERS[name](candidates=64).maximize(problem(space, scorer, seen=tuple(seen)))
        assert found is not None
        (key,) = space.keys(found.x[None])
        assert key not in seen
        assert found.score == pytest.approx(scorer(found.x[None])[0])
        seen.append(key)


@every_maximizer
@pytest.mark.parametrize("candidates", [4, 1024])
def test_an_exhausted_space_gives_nothing(name: str, candidates: int) -> None:
    seen = tuple(FINITE.keys(FINITE.enumerate()))
    bowl = Bowl(np.array([0.5, 0.5]))
    assert MAXIMIZERS[name](candidates=candidates).maximize(problem(FINITE, bowl, seen=seen)) is None
    last = MAXIMIZERS[name](candidates=candidates).maximize(problem(FINITE, bowl, seen=seen[:-1]))
    assert last is not None
    assert FINITE.keys(last.x[None])[0] == seen[-1]


@every_maximizer
def test_the_same_generator_finds_the_same_point(name: str) -> None:
    scorer = Bowl(np.full(4, 0.4))
    a, b = (MAXIMIZERS[name]().maximize(problem(MIXED, scorer, seed=5)) for _ in range(2))
    assert a is not None
    assert b is not None
    assert np.array_equal(a.x, b.x)


@every_maximizer
def test_a_narrow_peak_under_the_prior_is_found(name: str) -> None:
    centre = np.array([0.123, 0.456, 0.789])

    class Needle(Bowl):
        def __call__(self, X: np.ndarray) -> np.ndarray:
            return np.maximum(1 - 200 * np.abs(X - self.centre).max(axis=1), 0.0)

    factors = tuple(
        ((j,), AsJoint(GaussianPrior(mean=float(c), std=0.002).on(REAL.parameters[j]))) for j, c in enumerate(centre)
    )
    asked = problem(REAL, Needle(centre, is_differentiable=False))
    with_prior = MaximizationProblem(
        scorer=asked.scorer,
        space=REAL,
        prior=ProductPrior(3, factors),
        incumbents=asked.incumbents,
        seen=(),
        rng=np.random.default_rng(0),
    )
    found = MAXIMIZERS[name]().maximize(with_prior)
    assert found is not None
    assert found.score > 0.5


@every_maximizer
@pytest.mark.parametrize("value", [-np.inf, np.nan])
def test_scores_that_are_not_finite_are_survived(name: str, value: float) -> None:
    class Broken(Bowl):
        def __call__(self, X: np.ndarray) -> np.ndarray:
            return np.where(X[:, 0] > 0.5, value, super().__call__(X))

    found = MAXIMIZERS[name]().maximize(problem(REAL, Broken(np.array([0.9, 0.5, 0.5]))))
    assert found is not None
    assert found.x[0] == pytest.approx(0.5, abs=0.05)


@every_maximizer
@pytest.mark.parametrize("options", [{"candidates": 0}, {"starts": 0}])
def test_impossible_options_are_refused(name: str, options: dict) -> None:
    with pytest.raises(ScenarioError, match=next(iter(options))):
        MAXIMIZERS[name](**options)


@every_maximizer
@pytest.mark.parametrize("constrained", SPACES)
@pytest.mark.parametrize("is_differentiable", [True, False])
def test_the_point_found_meets_the_constraints(name: str, constrained: str, is_differentiable: bool) -> None:
    space = space_of(constrained)
    scorer = Bowl(np.full(space.dimension, 0.9), is_differentiable=is_differentiable)
    found = MAXIMIZERS[name](candidates=64, starts=2).maximize(problem(space, scorer))
    assert found is not None
    assert space.is_allowed(found.x[None]).all()
    assert space.contains(space.decode(found.x[None])[0])


@every_maximizer
@pytest.mark.parametrize("is_differentiable", [True, False])
def test_a_maximum_beyond_the_constraint_is_found_at_its_edge(name: str, is_differentiable: bool) -> None:
    scorer = Bowl(np.array([0.9, 0.6]), is_differentiable=is_differentiable)
    found = MAXIMIZERS[name]().maximize(problem(space_of("half"), scorer))
    assert found is not None
    assert found.x == pytest.approx([0.65, 0.35], abs=0.02)


@every_maximizer
@pytest.mark.parametrize("candidates", [4, 1024])
def test_an_equality_between_levels_does_not_hide_the_maximum(name: str, candidates: int) -> None:
    space = space_of("sum")
    (centre,) = space.encode([{"k": 5, "l": 4, "m": 0}])
    found = MAXIMIZERS[name](candidates=candidates).maximize(problem(space, Bowl(centre)))
    assert found is not None
    assert space.decode(found.x[None]) == [{"k": 5, "l": 4, "m": 0}]


@every_maximizer
def test_an_exhausted_constrained_space_gives_nothing(name: str) -> None:
    space = space_of("sum")
    seen = tuple(space.keys(space.enumerate()))
    for candidates in (4, 1024):
        maximizer = MAXIMIZERS[name](candidates=candidates)
        assert maximizer.maximize(problem(space, Bowl(np.full(3, 0.5)), seen=seen)) is None
        last = maximizer.maximize(problem(space, Bowl(np.full(3, 0.5)), seen=seen[1:]))
        assert last is not None
        assert space.keys(last.x[None])[0] == seen[0]
