"""What an acquisition function is: how promising a point is, given what is known.

Larger is better. An acquisition function is options; for one suggestion it becomes a `Scorer`, so that whatever is
drawn at random is drawn once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Protocol

from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.scalarization.base import Normalization, Scalarization
from hypermap_lite.surrogates.base import Posterior
from hypermap_lite.typing import FloatArray, Rng


@dataclass(frozen=True, slots=True, kw_only=True)
class AcquisitionContext:
    """All an acquisition function may know when it becomes a scorer. Objectives are to be minimized."""

    posterior: Posterior
    X: FloatArray
    """Completed evaluations, shape (n, d)."""

    Y: FloatArray
    """Their objectives, shape (n, m)."""

    X_pending: FloatArray
    """Configurations under evaluation, shape (p, d)."""

    scalarization: Scalarization
    weights: FloatArray
    """Of the scalarization, for this suggestion, shape (m,)."""

    normalization: Normalization
    rng: Rng
    reference_point: FloatArray | None = None
    """Worst objectives that still count, shape (m,); None if an objective has none."""

    beside: FloatArray | None = None
    """Objectives of k evaluations that the posterior does not know and the front has, shape (k, m); None for none."""

    iteration: int = 1
    """Running number, from 1, of the batch of model-based suggestions this one belongs to."""


class Scorer(Protocol):
    """The acquisition function of one suggestion."""

    @property
    def is_differentiable(self) -> bool:
        """Whether `with_gradient` may be called."""
        ...

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the scores of n points of the cube, shape (n, d), as shape (n,)."""
        ...

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d), zero along categorical axes."""
        ...


Rough = Callable[[FloatArray], FloatArray]
"""Scores of n points, (n, d) to (n,), good enough to tell which of them deserve a closer look."""


def rough_of(scorer: Scorer) -> Rough | None:
    """Return a scorer's cheaper approximation, its `rough`; None if it has none."""
    rough: Rough | None = getattr(scorer, "rough", None)
    return rough


class Acquisition(Protocol):
    """Options of an acquisition function."""

    is_logarithmic: ClassVar[bool]
    """Whether its scores are logarithms of a positive utility, so that a product is a sum."""

    is_scalarizing: ClassVar[bool]
    """Whether it looks at one trade-off of several objectives at a time, by the scalarization and its weights."""

    def scorer(self, context: AcquisitionContext) -> Scorer:
        """Become the scorer of one suggestion."""
        ...


class PriorWeighting(Protocol):
    """Options of how the user's prior enters the choice, and for how long."""

    @property
    def is_factor(self) -> bool:
        """Whether the prior is a factor of the acquisition value, not part of an acquisition function of its own."""
        ...

    @property
    def prior_free(self) -> float:
        """Share of the model-based suggestions that leave the prior out, in [0, 1]."""
        ...

    @property
    def safeguard(self) -> bool:
        """Whether the prior is checked against the evaluations, and loses its weight where it misleads."""
        ...

    @property
    def make_up(self) -> bool:
        """Whether uniform draws make up for those that the design took from a prior that is dropped."""
        ...

    def weight(self, n: int, model_budget: int) -> float:
        """Return the exponent of the prior at the n-th model-based suggestion, n >= 1, of a budget of so many."""
        ...

    def scorer(
        self, acquisition: Acquisition, context: AcquisitionContext, prior: ProductPrior, weight: float
    ) -> Scorer:
        """Become the scorer of one suggestion: the acquisition function's, changed by the prior, or another."""
        ...

    def weigh(self, scorer: Scorer, prior: ProductPrior, weight: float) -> Scorer:
        """Return a scorer in log form times the prior, for a choice that has no acquisition function."""
        ...
