"""What holds for every initial design."""

import numpy as np
import pytest

from hypermap_lite.design import DESIGNS, PriorSampling
from hypermap_lite.design.prior_sampling import UNIFORM, evenly_spread
from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors import (
    AsJoint,
    BetaPrior,
    GaussianPrior,
    JointMixturePrior,
    KernelDensityPrior,
    ProductPrior,
    UniformPrior,
    WeightsPrior,
)
from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, RealParameter, SearchSpace
from tests.constrained import SPACES, space_of

MIXED = SearchSpace(
    (
        RealParameter(name="r", low=0, high=1),
        IntegerParameter(name="n", low=0, high=4),
        CategoricalParameter(name="c", values=("a", "b", "c")),
    )
)
FINITE = SearchSpace(MIXED.parameters[1:])
every_design = pytest.mark.parametrize("name", list(DESIGNS))


def points(name: str, space: SearchSpace, n: int, seed: int = 0) -> np.ndarray:
    return DESIGNS[name]().points(space, ProductPrior(space.dimension), n, np.random.default_rng(seed))


@every_design
def test_points_are_legal_and_different(name: str) -> None:
    X = points(name, MIXED, 20)
    assert np.array_equal(MIXED.snap(X), X)
    assert MIXED.unseen(X, ()).all()
    assert 1 <= len(X) <= 20


@every_design
def test_a_finite_space_is_exhausted_without_repeats(name: str) -> None:
    X = points(name, FINITE, 100)
    assert len(X) == 15
    assert FINITE.unseen(X, ()).all()


@every_design
def test_the_same_generator_gives_the_same_points(name: str) -> None:
    assert np.array_equal(points(name, MIXED, 9, seed=3), points(name, MIXED, 9, seed=3))


@pytest.mark.parametrize("name", [n for n in DESIGNS if n != "grid"])
@pytest.mark.parametrize("n", [1, 2, 13])
def test_there_are_as_many_as_asked_for(name: str, n: int) -> None:
    assert points(name, MIXED, n).shape == (n, 3)


def test_a_latin_hypercube_has_one_point_in_every_slice() -> None:
    square = SearchSpace((RealParameter(name="a", low=0, high=1), RealParameter(name="b", low=0, high=1)))
    X = points("latin_hypercube", square, 10)
    assert np.array_equal(np.sort(np.floor(X * 10), axis=0), np.repeat(np.arange(10.0)[:, None], 2, axis=1))


def test_sobol_points_balance_every_half() -> None:
    square = SearchSpace((RealParameter(name="a", low=0, high=1), RealParameter(name="b", low=0, high=1)))
    assert np.array_equal((points("sobol", square, 16) < 0.5).sum(axis=0), [8, 8])


def test_a_grid_is_full_and_includes_the_bounds() -> None:
    square = SearchSpace((RealParameter(name="a", low=0, high=1), RealParameter(name="b", low=0, high=1)))
    X = points("grid", square, 10)
    assert {tuple(x) for x in X} == {(a, b) for a in (0, 0.5, 1) for b in (0, 0.5, 1)}


def test_a_grid_over_a_huge_log_range_is_spread_by_decades() -> None:
    space = SearchSpace((IntegerParameter(name="n", low=1, high=10**8, log=True),))
    values = sorted(c["n"] for c in space.decode(points("grid", space, 3)))
    assert values[0] == 1
    assert 5_000 < values[1] < 20_000
    assert values[2] == 10**8


def test_prior_sampling_draws_from_the_prior() -> None:
    space = SearchSpace((RealParameter(name="a", low=0, high=10),))
    prior = ProductPrior(1, (((0,), AsJoint(GaussianPrior(mean=7, std=0.1).on(space.parameters[0]))),))
    X = PriorSampling(uniform_share=0.0).points(space, prior, 200, np.random.default_rng(0))
    assert X.mean() == pytest.approx(0.7, abs=0.01)


def test_a_share_of_prior_sampling_is_spread_over_the_whole_space() -> None:
    space = SearchSpace((RealParameter(name="a", low=0, high=10),))
    prior = ProductPrior(1, (((0,), AsJoint(GaussianPrior(mean=7, std=0.1).on(space.parameters[0]))),))
    X = PriorSampling(uniform_share=0.25).points(space, prior, 32, np.random.default_rng(0))[:, 0]
    is_uniform = np.arange(32) % 4 == 3
    assert X[~is_uniform] == pytest.approx(np.full(24, 0.7), abs=0.05)
    assert sorted(np.floor(8 * X[is_uniform])) == list(range(8))


def test_prior_sampling_says_which_of_its_points_come_from_the_prior() -> None:
    space = SearchSpace((RealParameter(name="a", low=0, high=10),))
    prior = ProductPrior(1, (((0,), AsJoint(GaussianPrior(mean=7, std=0.1).on(space.parameters[0]))),))
    design = PriorSampling(uniform_share=0.5)
    X = design.points(space, prior, 6, np.random.default_rng(1))
    origins = design.origins(space, prior, 6, np.random.default_rng(1))
    assert [origins[key] for key in space.keys(X)] == [0, UNIFORM, 2, UNIFORM, 4, UNIFORM]


@pytest.mark.parametrize(
    ("n", "share", "places"), [(8, 0.25, [3, 7]), (6, 0.25, [2, 5]), (1, 0.25, []), (3, 1, [0, 1, 2])]
)
def test_places_are_spread_evenly(n: int, share: float, places: list[int]) -> None:
    assert np.flatnonzero(evenly_spread(n, share)).tolist() == places


def test_without_a_prior_there_is_nothing_to_spread() -> None:
    space, generator = space_of("half"), np.random.default_rng
    plain = PriorSampling(uniform_share=0.0).points(space, ProductPrior(2), 9, generator(3))
    assert (PriorSampling(uniform_share=0.5).points(space, ProductPrior(2), 9, generator(3)) == plain).all()


def test_a_share_above_one_is_refused() -> None:
    with pytest.raises(ScenarioError, match=r"\$\.uniform_share: the share is 1.5"):
        PriorSampling(uniform_share=1.5)


def by_level(space: SearchSpace, name: str, X: np.ndarray) -> dict[object, int]:
    levels = [c[name] for c in space.decode(X)]
    return {level: levels.count(level) for level in levels}


def test_every_combination_of_categories_has_a_latin_hypercube_of_its_own() -> None:
    space = SearchSpace((RealParameter(name="r", low=0, high=1), *CATEGORIES))
    X = points("k_latin_hypercube", space, 26)
    shares = {}
    for x, c in zip(X, space.decode(X), strict=True):
        shares.setdefault((c["c"], c["d"]), []).append(x[0])
    assert sorted(map(len, shares.values())) == [4, 4, 4, 4, 5, 5]
    sliced = [sorted(np.floor(np.array(share) * 4)) for share in shares.values() if len(share) == 4]
    assert sliced == [[0, 1, 2, 3]] * 4


def test_with_fewer_points_than_combinations_each_point_is_of_another_combination() -> None:
    many = tuple(CategoricalParameter(name=f"c{i}", values=tuple(map(str, range(64)))) for i in range(12))
    assert len(points("k_latin_hypercube", SearchSpace(many), 5)) == 5
    X = points("k_latin_hypercube", SearchSpace((RealParameter(name="r", low=0, high=1), *CATEGORIES)), 4)
    assert len({tuple(x[1:]) for x in X}) == 4


CATEGORIES = (
    CategoricalParameter(name="c", values=("a", "b", "c")),
    CategoricalParameter(name="d", values=("x", "y")),
)
ONE_OF_EACH = {
    "gaussian": (RealParameter(name="p", low=0, high=10), GaussianPrior(mean=7, std=0.5)),
    "far_gaussian": (RealParameter(name="p", low=0, high=1), GaussianPrior(mean=3, std=0.1)),
    "beta": (RealParameter(name="p", low=0, high=1), BetaPrior(shape="decay")),
    "uniform": (RealParameter(name="p", low=0, high=1), UniformPrior(low=0.2, high=0.4)),
    "integer": (IntegerParameter(name="p", low=0, high=10**6), GaussianPrior(mean=10, std=10**4)),
    "ordinal": (OrdinalParameter(name="p", values=tuple(range(2000))), WeightsPrior(weights=[0, 1, 3, 0] * 500)),
}


@pytest.mark.parametrize(("parameter", "prior"), ONE_OF_EACH.values(), ids=ONE_OF_EACH)
def test_slices_of_a_prior_latin_hypercube_have_equal_prior_mass(parameter, prior) -> None:
    space, density = SearchSpace((parameter,)), prior.on(parameter)
    X = DESIGNS["prior_latin_hypercube"]().points(
        space, ProductPrior(1, (((0,), AsJoint(density)),)), 8, np.random.default_rng(0)
    )
    masses = np.sort(density.cdf(X[:, 0]))
    assert masses == pytest.approx((np.arange(8) + 0.5) / 8, abs=0.5 / 8 + 2e-3)


def test_a_prior_latin_hypercube_takes_the_marginals_of_joint_priors() -> None:
    a, b = RealParameter(name="a", low=0, high=1), IntegerParameter(name="b", low=0, high=99)
    parts = [
        {"mean": {"a": 0.2, "b": 20}, "std": {"a": 0.01, "b": 1}},
        {"mean": {"a": 0.8, "b": 80}, "std": {"a": 0.01, "b": 1}},
    ]
    points_of = {"a": [0.2, 0.21, 0.8, 0.79], "b": [20, 21, 80, 79]}
    joints = [JointMixturePrior(components=parts), KernelDensityPrior(points=points_of, bandwidth_factor=0.1)]
    joints.append(KernelDensityPrior(points=points_of, bandwidth_factor=0.1, independent=True))
    for joint in joints:
        prior = ProductPrior(2, (((0, 1), joint.on([a, b])),))
        X = DESIGNS["prior_latin_hypercube"]().points(SearchSpace((a, b)), prior, 10, np.random.default_rng(0))
        assert (X < 0.5).sum(axis=0).tolist() == [5, 5]
        assert np.minimum(np.abs(X - 0.2), np.abs(X - 0.8)).max() < 0.1


def test_levels_of_a_category_share_a_prior_latin_hypercube_by_their_weights() -> None:
    weights = WeightsPrior(weights=[6, 3, 1]).on(CATEGORIES[0])
    space = SearchSpace((CATEGORIES[0], RealParameter(name="r", low=0, high=1)))
    prior = ProductPrior(2, (((0,), AsJoint(weights)),))
    X = DESIGNS["prior_latin_hypercube"]().points(space, prior, 20, np.random.default_rng(0))
    assert by_level(space, "c", X) == {"a": 12, "b": 6, "c": 2}


@pytest.mark.parametrize("name", ["k_latin_hypercube", "prior_latin_hypercube", "latin_hypercube"])
def test_a_space_of_categories_alone_is_no_trouble(name: str) -> None:
    assert len(points(name, SearchSpace(CATEGORIES), 5)) == 5


def test_a_grid_of_given_levels_holds_all_levels_of_the_other_parameters() -> None:
    space = SearchSpace(
        (RealParameter(name="r", low=0, high=9), IntegerParameter(name="n", low=1, high=9, log=True), *CATEGORIES)
    )
    grid = DESIGNS["grid"](levels=10)
    X = grid.points(space, ProductPrior(4), 1000, np.random.default_rng(0))
    assert len(X) == 10 * 9 * 6
    assert by_level(space, "r", X) == {float(v): 54 for v in range(10)}
    assert len(grid.points(space, ProductPrior(4), 7, np.random.default_rng(0))) == 7


def test_a_grid_too_large_to_list_is_refused() -> None:
    space = SearchSpace(tuple(RealParameter(name=f"r{i}", low=0, high=1) for i in range(400)))
    with pytest.raises(ScenarioError, match=r"\$\.levels: the grid would have 1e\+300 points"):
        DESIGNS["grid"](levels=10).check(space)
    with pytest.raises(ScenarioError, match="levels"):
        DESIGNS["grid"](levels=1)


@every_design
@pytest.mark.parametrize("constrained", SPACES)
@pytest.mark.parametrize("n", [1, 12])
def test_points_meet_the_constraints(name: str, constrained: str, n: int) -> None:
    space = space_of(constrained)
    X = points(name, space, n)
    assert np.array_equal(space.snap(X), X)
    assert space.is_allowed(X).all()
    assert space.unseen(X, ()).all()
    least = min(n, space.n_configurations) if name != "grid" else 1
    assert least <= len(X) <= n


@every_design
def test_a_finite_constrained_space_is_exhausted_without_repeats(name: str) -> None:
    space = space_of("sum")
    X = points(name, space, 100)
    assert len(X) == space.n_configurations
    assert space.unseen(X, ()).all()


def test_a_grid_keeps_most_of_what_it_may_where_constraints_reject_some() -> None:
    X = points("grid", space_of("half"), 30)
    assert 22 <= len(X) <= 30
    assert len(np.unique(np.diff(np.unique(X[:, 0])).round(9))) == 1


def test_sobol_points_stay_evenly_spread_where_constraints_reject_some() -> None:
    X = points("sobol", space_of("half"), 64)
    assert (X[:, 0] < X[:, 1]).mean() == pytest.approx(0.5, abs=0.08)


def test_prior_sampling_draws_from_the_prior_given_the_constraints() -> None:
    space = space_of("half")
    prior = ProductPrior(2, (((0,), AsJoint(GaussianPrior(mean=0.9, std=0.05).on(space.parameters[0]))),))
    X = PriorSampling(uniform_share=0.0).points(space, prior, 500, np.random.default_rng(0))
    assert (X.sum(axis=1) <= 1).all()
    assert np.quantile(X[:, 0], [0.02, 0.98]) == pytest.approx([0.75, 0.94], abs=0.05)  # pulled below 0.9
