"""What a surrogate is: options that turn evaluations into a posterior over the objectives.

All objectives are minimized here. The acquisition functions see a posterior through *fields*: functions of X that
return means and standard deviations for S joint scenarios at once, and can carry a gradient back to X.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from hypermap_lite.space.permutation import PermutationParameter
from hypermap_lite.surrogates.failures import Failures
from hypermap_lite.surrogates.tails import Tails
from hypermap_lite.typing import BoolArray, FloatArray, Rng

Pullback = Callable[[FloatArray, FloatArray], FloatArray]
"""Turns derivatives by mean (S, n, m) and std (S or 1, n, m) into derivatives by X, shape (n, d)."""

Permutations = Mapping[int, PermutationParameter]
"""Permutation parameters by their axes."""

NO_PERMUTATIONS: Permutations = {}
"""For spaces without any; nobody changes it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Prediction:
    """Independent normal predictions of m objectives at n points."""

    mean: FloatArray
    """Shape (n, m)."""

    std: FloatArray
    """Standard deviation of the noise-free objective, shape (n, m), >= 0."""

    def __post_init__(self) -> None:
        if self.mean.shape != self.std.shape or self.mean.ndim != 2:
            raise ValueError(f"mean {self.mean.shape} and std {self.std.shape} must both have shape (n, m)")


@dataclass(frozen=True, slots=True, kw_only=True)
class Conditional:
    """Normal predictions at n points in each of S scenarios."""

    mean: FloatArray
    """Shape (S, n, m)."""

    std: FloatArray
    """Shape (S, n, m), or (1, n, m) if all scenarios share it."""

    pullback: Pullback | None = None
    """Carries gradients back to X; None if the surrogate has none."""

    def gradient(self, by_mean: FloatArray, by_std: FloatArray) -> FloatArray:
        """Return derivatives by X, shape (n, d), from those by mean and std in more scenarios than these may have.

        Where all of them share a mean or a std, the derivatives, both (S, n, m), are summed.
        """
        assert self.pullback is not None
        if len(self.mean) == 1:
            by_mean = by_mean.sum(axis=0, keepdims=True)
        if len(self.std) == 1:
            by_std = by_std.sum(axis=0, keepdims=True)
        return self.pullback(by_mean, by_std)


Field = Callable[[FloatArray], Conditional]
"""Predictions as a function of X, shape (n, d)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fantasies:
    """S joint draws of the noise-free objectives at b base points, and what each draw implies elsewhere."""

    values: FloatArray
    """The draws at those base points that may be on the front, shape (S, b, m)."""

    field: Field
    """Predictions given each draw."""


class Predictor(Protocol):
    """What predicts, and no more."""

    def predict(self, X: FloatArray) -> Prediction:
        """Predict the noise-free objectives at n points, shape (n, d)."""
        ...


class Knowledge(Predictor, Protocol):
    """What predicts, and tells how much it knows."""

    def explained(self) -> FloatArray | None:
        """Return how much of each objective it foretells; see `Posterior.explained`."""
        ...


class Posterior(Knowledge, Protocol):
    """What is known of m objectives after n evaluations. Immutable."""

    @property
    def start(self) -> Any:
        """What a fit to more evaluations may start from; None if there is nothing of the kind."""
        ...

    @property
    def is_differentiable(self) -> bool:
        """Whether its fields carry gradients."""
        ...

    def explained(self) -> FloatArray | None:
        """Return which share of each objective's variance predictions explain that leave each evaluation out.

        Shape (m,), at most 1; with 0 or less nothing is known of an objective but its mean. None if that is not known.
        """
        ...

    def outliers(self) -> BoolArray | None:
        """Return which objectives of the n evaluations are set aside as outliers, shape (n, m).

        Nothing is learnt from these. None if no evaluation ever is.
        """
        ...

    @property
    def lacks_noise(self) -> tuple[bool, ...]:
        """For which of the m objectives this fit took a model without noise in place of one with noise.

        A later fit that starts from it has nothing left to doubt.
        """
        ...

    def field(self, X: FloatArray) -> Conditional:
        """Predict as `predict` does, as a field with a single scenario."""
        ...

    def believe(self, X_pending: FloatArray) -> Posterior:
        """Return the posterior if the pending points, shape (p, d), came out at their predicted means."""
        ...

    def fantasies(self, X_pending: FloatArray, n: int, rng: Rng) -> Fantasies:
        """Draw the noise-free objectives at all observed and pending points n times, jointly.

        The draws at points that only inform are not returned.
        """
        ...

    def sample_path(self, rng: Rng, features: int) -> Field:
        """Draw one function from the posterior; its std is zero everywhere."""
        ...


class Surrogate(Protocol):
    """Options of a model. It does not change when it is fitted."""

    @property
    def warm_start_growth(self) -> float | None:
        """By what factor the evaluations grow between the fits that later ones start from; None for no such starts."""
        ...

    @property
    def noise_from_replicates(self) -> bool:
        """Whether `fit` wants one row per configuration, with the noise of its mean."""
        ...

    @property
    def learn_infeasible(self) -> bool:
        """Whether objective values of infeasible evaluations are among what it is fitted to."""
        ...

    def tails(
        self,
        X: FloatArray,
        Y: FloatArray,
        least: FloatArray,
        *,
        is_ordered: BoolArray,
        permutations: Permutations = NO_PERMUTATIONS,
    ) -> Tails:
        """Return which values of each objective are so far beyond the rest that `fit` wants them compressed.

        Parameters
        ----------
        X, Y, is_ordered, permutations
            As in `fit`.
        least
            What is below these values counts and is left as it is, shape (m,).
        """
        ...

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
        """Return which evaluations are so much of a kind of their own that `fit` wants the others alone; None for none.

        Parameters
        ----------
        X, Y, least, is_ordered, permutations
            As in `tails`.
        corner
            Reference point of the hypervolume, shape (m,), of which failures have next to nothing; None with one
            objective.
        or_needed
            Whether they may also be such that the front needs them.
        """
        ...

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
        """Fit m objectives to n evaluations.

        Parameters
        ----------
        X
            Points of the unit cube, shape (n, d), n >= 1.
        Y
            Objectives to be minimized, shape (n, m), finite.
        is_ordered
            Which axes have an order, shape (d,); the others are categorical, or permutations.
        rng
            Source of all randomness.
        start
            `start` of an earlier posterior, of the first of these evaluations.
        anew
            Whether to start from what is likely before any data, too, for an earlier posterior may have gone astray.
        permutations
            The axes without an order whose codes are permutations.
        noise_variance
            Variance of the noise in each row of `Y`, in its units squared, shape (n, m), as far as it is known from
            replicates; None where it must be learned. A surrogate may ignore it.
        n_beside
            How many of the last rows only inform: they cannot be on the front, being infeasible, and what they report
            may be off by an unknown constant and more; NaN stands for what is not known. A surrogate whose
            `learn_infeasible` is false gets none.
        """
        ...


def as_prediction(conditional: Conditional) -> Prediction:
    """Return a field's answer with a single scenario as a prediction."""
    return Prediction(mean=conditional.mean[0], std=np.broadcast_to(conditional.std, conditional.mean.shape)[0])
