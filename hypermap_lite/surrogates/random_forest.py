"""A random forest per objective, on scikit-learn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from hypermap_lite.errors import ScenarioError
from hypermap_lite.surrogates.base import (
    NO_PERMUTATIONS,
    Conditional,
    Fantasies,
    Field,
    Permutations,
    Posterior,
    Prediction,
)
from hypermap_lite.surrogates.failures import Failures
from hypermap_lite.surrogates.tails import Tails
from hypermap_lite.typing import BoolArray, FloatArray, Rng

if TYPE_CHECKING:
    from sklearn.tree._tree import Tree

VARIANCE_FLOOR = 1e-8
"""Smallest variance of a leaf, in units of the squared largest difference of outputs."""

SMALLEST_SPREAD = 1e-150
"""Outputs that differ by less are constant: their squares vanish."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RandomForest:
    """Independent random forests; a tree is one draw of what the objective may be.

    The predicted variance is the total variance over the trees: the mean of the leaves' variances plus the variance
    of the leaves' means [1]_. Categorical axes are split as ordered codes, which a deep tree can refine; of a
    permutation the place of each element is split.

    References
    ----------
    .. [1] Hutter, Xu, Hoos, Leyton-Brown. Algorithm Runtime Prediction: Methods & Evaluation, sec. 4.3.2 and 4.3.3.
       AIJ 2014.
    """

    number_of_trees: int = 100
    max_features: float = 0.5
    """Share of the axes looked at for each split, in (0, 1]."""

    min_samples_leaf: int = 2
    min_samples_split: int | None = None
    """Fewest evaluations in a node that is split further; None for two."""

    bootstrap: bool | None = None
    """Whether each tree sees a sample of the evaluations, drawn with replacement, as with None; else all of them."""

    random_thresholds: bool = False
    """Whether a split lies anywhere between the two evaluations it separates, instead of halfway: trees then differ
    where there are no evaluations [1]_."""

    warm_start_growth: ClassVar[float | None] = None
    noise_from_replicates: ClassVar[bool] = False
    """Never: rows that repeat a configuration are rows of their own, and all rows weigh the same."""

    learn_infeasible: ClassVar[bool] = False
    """Never: it cannot tell what infeasible evaluations report from what they should."""

    def __post_init__(self) -> None:
        if self.number_of_trees < 2:
            raise ScenarioError("$.number_of_trees", f"{self.number_of_trees} trees give no variance", allowed=">= 2")
        if not 0 < self.max_features <= 1:
            raise ScenarioError("$.max_features", f"the share is {self.max_features}", allowed="in (0, 1]")
        if self.min_samples_leaf < 1:
            raise ScenarioError("$.min_samples_leaf", f"it is {self.min_samples_leaf}", allowed=">= 1")
        if self.min_samples_split is not None and self.min_samples_split < 2:
            raise ScenarioError("$.min_samples_split", f"it is {self.min_samples_split}", allowed=">= 2")

    def tails(
        self,
        X: FloatArray,
        Y: FloatArray,
        least: FloatArray,
        *,
        is_ordered: BoolArray,
        permutations: Permutations = NO_PERMUTATIONS,
    ) -> Tails:
        """Return none: trees split by order, and where values are far apart."""
        return (None,) * Y.shape[1]

    def failures(
        self,
        X: FloatArray,
        Y: FloatArray,
        least: FloatArray,
        corner: FloatArray | None,
        *,
        is_ordered: BoolArray,
        permutations: Permutations = NO_PERMUTATIONS,
        or_needed: bool = False,
    ) -> Failures | None:
        """Return none: trees split where values have a cliff, and each side has leaves of its own."""
        return None

    def fit(
        self,
        X: FloatArray,
        Y: FloatArray,
        *,
        is_ordered: BoolArray,
        rng: Rng,
        start: Any = None,
        anew: bool = False,
        permutations: Permutations = NO_PERMUTATIONS,
        noise_variance: FloatArray | None = None,
        n_beside: int = 0,
    ) -> Posterior:
        """Fit one forest per objective; see `Surrogate.fit`. Noise variance and `n_beside` have no part in it."""
        seed = int(rng.integers(2**31))
        forests = self.grow(X, Y, seed, permutations)
        return ForestPosterior(options=self, X=X, Y=Y, seed=seed, forests=forests, permutations=permutations)

    def grow(
        self, X: FloatArray, Y: FloatArray, seed: int, permutations: Permutations = NO_PERMUTATIONS
    ) -> tuple[Forest, ...]:
        """Return one forest per objective."""
        features = features_of(X, permutations)
        forests = []
        for k, y in enumerate(Y.T):
            offset, spread = float(y[0]), float(np.abs(y - y[0]).max())
            magnitude = spread if spread > SMALLEST_SPREAD else 1.0
            trees = self._trees(features, (y - offset) / magnitude, (seed + k) % 2**31)
            if self.random_thresholds:
                redraw_thresholds(trees, features, np.random.default_rng([seed, k]))
            forests.append(Forest.of(trees, offset, magnitude))
        return tuple(forests)

    def _trees(self, X: FloatArray, y: FloatArray, seed: int) -> list[Tree]:
        """Grow the trees of one forest, those of scikit-learn's ``RandomForestRegressor`` of the same random state.

        That class copies and checks its options for every tree, which takes longer than growing one on few rows.
        """
        from sklearn import config_context  # slow to import, used here only
        from sklearn.tree import DecisionTreeRegressor
        from sklearn.utils import check_random_state

        random_state, n = check_random_state(seed), len(X)
        single, outputs = np.ascontiguousarray(X, dtype=np.float32), np.ascontiguousarray(y[:, None])
        trees = []
        with config_context(assume_finite=True, skip_parameter_validation=True):
            for _ in range(self.number_of_trees):
                own = int(random_state.randint(np.iinfo(np.int32).max))
                weights = None
                if self.bootstrap is not False:
                    rows = check_random_state(own).randint(0, n, n, dtype=np.int32)
                    weights = np.bincount(rows, minlength=n)
                regressor = DecisionTreeRegressor(
                    max_features=self.max_features,
                    min_samples_leaf=self.min_samples_leaf,
                    min_samples_split=self.min_samples_split or 2,
                    random_state=own,
                )
                trees.append(regressor.fit(single, outputs, sample_weight=weights, check_input=False).tree_)
        return trees


def features_of(X: FloatArray, permutations: Permutations) -> FloatArray:
    """Return what the trees split: n points with each permutation's code replaced by the places of its elements."""
    if not permutations:
        return X
    columns = [permutations[j].positions(X[:, j]) if j in permutations else X[:, j : j + 1] for j in range(X.shape[1])]
    return np.hstack(columns)


def redraw_thresholds(trees: Sequence[Tree], X: FloatArray, rng: Rng) -> None:
    """Move each split of a fitted forest to a place drawn evenly between the two points it separates.

    No point of `X`, shape (n, p), what the trees split, changes its leaf.
    """
    single = X.astype(np.float32)  # as the trees see it
    for tree in trees:
        visits = tree.decision_path(single).tocsc()
        for node in np.flatnonzero(tree.children_left != tree.children_right):
            values = single[visits.indices[visits.indptr[node] : visits.indptr[node + 1]], tree.feature[node]]
            is_left = values <= tree.threshold[node]
            if is_left.any() and not is_left.all():
                low, high = float(values[is_left].max()), float(values[~is_left].min())
                tree.threshold[node] = low + rng.random() * (high - low)


@dataclass(frozen=True, slots=True)
class Forest:
    """One objective's trees, with mean and variance of every leaf."""

    trees: list[Any]
    """Compiled trees; asked themselves, for the forest checks its input longer than it looks up a few points."""

    leaf_means: list[FloatArray]
    leaf_variances: list[FloatArray]
    offset: float
    scale: float

    @classmethod
    def of(cls, trees: Sequence[Tree], offset: float, scale: float) -> Forest:
        """Read the leaves of fitted trees."""
        means = [tree.value[:, 0, 0] for tree in trees]
        variances = [np.maximum(tree.impurity, VARIANCE_FLOOR) for tree in trees]
        return cls(list(trees), means, variances, offset, scale)

    def per_tree(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean and standard deviation, both (T, n), of the leaf of each of T trees, in scaled outputs."""
        single = np.ascontiguousarray(X, dtype=np.float32)  # as the trees see it
        leaves = [tree.apply(single) for tree in self.trees]
        mean = np.array([m[index] for m, index in zip(self.leaf_means, leaves, strict=True)])
        variance = np.array([v[index] for v, index in zip(self.leaf_variances, leaves, strict=True)])
        return mean, np.sqrt(variance)


@dataclass(frozen=True, slots=True, kw_only=True)
class ForestPosterior:
    """What the forests know of m objectives."""

    options: RandomForest
    X: FloatArray
    Y: FloatArray
    seed: int
    forests: tuple[Forest, ...]
    permutations: Permutations = field(default_factory=dict)

    @property
    def start(self) -> None:
        """None: a forest is grown afresh."""
        return

    @property
    def is_differentiable(self) -> bool:
        """False: a forest is piecewise constant."""
        return False

    def outliers(self) -> None:
        """None: a forest does not ask whether the others foretell an evaluation."""
        return

    @property
    def lacks_noise(self) -> tuple[bool, ...]:
        """None of the objectives does: a forest has no noise to do without."""
        return (False,) * len(self.forests)

    def explained(self) -> None:
        """None: that would take as many forests as there are evaluations."""
        return

    @property
    def _offset(self) -> FloatArray:
        return np.array([forest.offset for forest in self.forests])

    @property
    def _scale(self) -> FloatArray:
        return np.array([forest.scale for forest in self.forests])

    def _scaled_per_tree(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        features = features_of(X, self.permutations)
        answers = [forest.per_tree(features) for forest in self.forests]
        return np.stack([a[0] for a in answers], axis=2), np.stack([a[1] for a in answers], axis=2)

    def _per_tree(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean and standard deviation of each of T trees, both (T, n, m)."""
        mean, std = self._scaled_per_tree(X)
        return self._offset + self._scale * mean, self._scale * std

    def predict(self, X: FloatArray) -> Prediction:
        """Predict m objectives at n points, shape (n, d), by the total variance over the trees."""
        mean, std = self._scaled_per_tree(X)
        total = np.sqrt((std**2).mean(axis=0) + mean.var(axis=0))
        return Prediction(mean=self._offset + self._scale * mean.mean(axis=0), std=self._scale * total)

    def field(self, X: FloatArray) -> Conditional:
        """Predict as `predict` does, as a field with one scenario."""
        prediction = self.predict(X)
        return Conditional(mean=prediction.mean[None], std=prediction.std[None])

    def believe(self, X_pending: FloatArray) -> ForestPosterior:
        """Return the forests grown with the pending points at their predicted means."""
        if not len(X_pending):
            return self
        X, Y = np.vstack([self.X, X_pending]), np.vstack([self.Y, self.predict(X_pending).mean])
        return replace(self, X=X, Y=Y, forests=self.options.grow(X, Y, self.seed, self.permutations))

    def fantasies(self, X_pending: FloatArray, n: int, rng: Rng) -> Fantasies:
        """Take every tree as a draw (so there are as many as trees, whatever n); pending points by `believe`."""
        believed = self.believe(X_pending)
        values = believed._per_tree(believed.X)[0]  # (T, b, m)

        def field(X: FloatArray) -> Conditional:
            mean, std = believed._per_tree(X)
            return Conditional(mean=mean, std=std)

        return Fantasies(values=values, field=field)

    def sample_path(self, rng: Rng, features: int) -> Field:
        """Take one tree of each forest as the function."""
        chosen = rng.integers(self.options.number_of_trees, size=len(self.forests))

        def field(X: FloatArray) -> Conditional:
            mean = self._per_tree(X)[0]
            path = np.stack([mean[t, :, k] for k, t in enumerate(chosen)], axis=1)[None]
            return Conditional(mean=path, std=np.zeros_like(path))

        return field
