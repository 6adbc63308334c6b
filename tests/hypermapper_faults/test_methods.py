"""Faults measured in HyperMapper's search methods: each test fails on the faulty behaviour."""

from __future__ import annotations

import numpy as np
import pytest

from hypermap_lite.acquisition import ACQUISITIONS, AcquisitionContext
from hypermap_lite.scalarization import SCALARIZATIONS, Normalization
from hypermap_lite.surrogates.base import Conditional, Field, Posterior


class TwoPoints(Posterior):
    """A posterior that predicts the same objectives, 0.9 and 0.1, at any place below and above 0.5."""

    hyperparameters = None
    is_differentiable = False

    def field(self, X: np.ndarray) -> Conditional:
        mean = np.where(X[None, :, :1] < 0.5, [0.9, 0.9], [0.1, 0.1])
        return Conditional(mean=mean, std=np.full(mean.shape, 0.1))

    def believe(self, X_pending: np.ndarray) -> TwoPoints:
        return self

    def sample_path(self, rng: np.random.Generator, features: int) -> Field:
        return self.field


def context_of(posterior: Posterior, scalarization: str) -> AcquisitionContext:
    Y = np.array([[0.0, 1.0], [1.0, 0.0], [0.6, 0.6]])
    return AcquisitionContext(
        posterior=posterior,
        X=np.array([[0.2], [0.4], [0.6]]),
        Y=Y,
        X_pending=np.empty((0, 1)),
        scalarization=SCALARIZATIONS[scalarization](),
        weights=np.array([0.5, 0.5]),
        normalization=Normalization.of_front(Y),
        rng=np.random.default_rng(0),
    )


@pytest.mark.parametrize("acquisition", ["expected_improvement", "upper_confidence_bound", "thompson_sampling"])
@pytest.mark.parametrize("scalarization", list(SCALARIZATIONS))
def test_a_better_prediction_has_the_better_score_with_every_scalarization(
    acquisition: str, scalarization: str
) -> None:
    score = ACQUISITIONS[acquisition]().scorer(context_of(TwoPoints(), scalarization))
    worse, better = score(np.array([[0.25], [0.75]]))
    assert better > worse
