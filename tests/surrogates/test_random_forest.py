"""Predictions of the random forest."""

import numpy as np
import pytest
from sklearn.ensemble import RandomForestRegressor

from hypermap_lite.errors import ScenarioError
from hypermap_lite.space import PermutationParameter
from hypermap_lite.surrogates import RandomForest
from hypermap_lite.surrogates.random_forest import Forest, ForestPosterior, features_of

RNG = np.random.default_rng(0)
X = RNG.random((40, 2))
Y = np.column_stack([np.where(X[:, 0] > 0.5, 10.0, 0.0), X[:, 1]])
ORDERED = np.ones(2, dtype=bool)
FOREST = RandomForest(number_of_trees=30).fit(X, Y, is_ordered=ORDERED, rng=np.random.default_rng(0))
Z = np.array([[0.1, 0.5], [0.9, 0.5]])


@pytest.mark.parametrize("bootstrap", [True, False])
def test_trees_are_scikit_learns_to_the_last_bit(bootstrap: bool) -> None:
    options = {"max_features": 0.5, "min_samples_leaf": 2, "min_samples_split": 4}
    y = np.sin(7 * X[:, 0]) + X[:, 1]
    theirs = RandomForestRegressor(n_estimators=20, random_state=5, bootstrap=bootstrap, **options).fit(X, y)
    ours = RandomForest(number_of_trees=20, bootstrap=bootstrap, **options)._trees(X, y, 5)
    many = RNG.random((300, 2))
    mean, _ = Forest.of(ours, offset=0.0, scale=1.0).per_tree(many)
    assert np.array_equal(mean, [tree.predict(many) for tree in theirs.estimators_])
    assert [tree.node_count for tree in ours] == [tree.tree_.node_count for tree in theirs.estimators_]


def test_a_step_is_learned() -> None:
    assert FOREST.predict(Z).mean[:, 0] == pytest.approx([0, 10], abs=0.5)


def test_variance_is_the_total_over_the_trees() -> None:
    fantasies = FOREST.fantasies(np.empty((0, 2)), 64, np.random.default_rng(0))
    conditional = fantasies.field(Z)
    total = conditional.mean.var(axis=0) + (conditional.std**2).mean(axis=0)
    assert FOREST.predict(Z).std == pytest.approx(np.sqrt(total))
    assert fantasies.values.shape == (30, 40, 2)


def test_pending_points_are_believed() -> None:
    believed = FOREST.believe(Z)
    assert len(believed.X) == 42
    assert believed.Y[40:] == pytest.approx(FOREST.predict(Z).mean)
    assert len(FOREST.X) == 40


def test_a_path_is_one_tree() -> None:
    path = FOREST.sample_path(np.random.default_rng(0), 0)(Z)
    trees = FOREST.fantasies(np.empty((0, 2)), 0, np.random.default_rng(0)).field(Z).mean
    assert any(np.array_equal(path.mean[0, :, 0], tree[:, 0]) for tree in trees)
    assert not path.std.any()


def test_the_same_generator_grows_the_same_forest() -> None:
    again = RandomForest(number_of_trees=30).fit(X, Y, is_ordered=ORDERED, rng=np.random.default_rng(0))
    assert np.array_equal(again.predict(Z).mean, FOREST.predict(Z).mean)


@pytest.mark.parametrize("scale", [1e-300, 1.0, 1e300])
def test_any_magnitude_of_outputs_is_fine(scale: float) -> None:
    forest = RandomForest(number_of_trees=5).fit(X, scale * Y, is_ordered=ORDERED, rng=np.random.default_rng(0))
    assert np.isfinite(forest.predict(Z).mean).all()


def test_a_constant_objective_is_fine() -> None:
    forest = RandomForest(number_of_trees=5).fit(
        X, np.full((40, 1), 7.0), is_ordered=ORDERED, rng=np.random.default_rng(0)
    )
    assert forest.predict(Z).mean[:, 0] == pytest.approx([7, 7])
    assert np.all(forest.predict(Z).std > 0)


def grown(**options: object) -> ForestPosterior:
    forest = RandomForest(number_of_trees=10, min_samples_leaf=1, bootstrap=False, max_features=1.0, **options)
    return forest.fit(X[:, :1], X[:, :1] ** 2, is_ordered=ORDERED[:1], rng=np.random.default_rng(0))


def test_without_bootstrap_every_tree_goes_through_the_evaluations() -> None:
    trees = grown().fantasies(np.empty((0, 1)), 0, np.random.default_rng(0)).values
    assert trees[:, :, 0] == pytest.approx(np.tile(X[:, 0] ** 2, (10, 1)))


def test_random_thresholds_keep_the_evaluations_and_make_trees_differ_between_them() -> None:
    halfway, random = grown(), grown(random_thresholds=True)
    between = np.linspace(0, 1, 200)[:, None]
    assert random.predict(X[:, :1]).mean == pytest.approx(halfway.predict(X[:, :1]).mean)
    assert np.ptp(halfway.predict(between).std) == pytest.approx(0)  # all trees are the same
    assert np.median(random.predict(between).std) > 2 * halfway.predict(between).std.max()


def test_a_node_too_small_is_not_split() -> None:
    forest = grown(min_samples_split=41).fantasies(np.empty((0, 1)), 0, np.random.default_rng(0))
    assert np.ptp(forest.values) == pytest.approx(0)


@pytest.mark.parametrize(
    "options",
    [
        {"number_of_trees": 1},
        {"max_features": 0},
        {"max_features": 1.5},
        {"min_samples_leaf": 0},
        {"min_samples_split": 1},
    ],
)
def test_impossible_options_are_refused(options: dict) -> None:
    with pytest.raises(ScenarioError, match=next(iter(options))):
        RandomForest(**options)


def test_a_permutation_becomes_the_places_of_its_elements() -> None:
    parameter = PermutationParameter(name="order", size=3)
    X = np.column_stack([[0.2, 0.4], parameter.encode([(2, 0, 1), (0, 1, 2)]), [0.6, 0.8]])
    assert features_of(X, {1: parameter}).tolist() == [[0.2, 1, 2, 0, 0.6], [0.4, 0, 1, 2, 0.8]]
    assert features_of(X, {}) is X
