"""A process given its data, without some of them."""

import math

import numpy as np
import pytest

from hypermap_lite.surrogates.marginal_likelihood import Hyperparameters
from hypermap_lite.surrogates.process import Process, Standardized

ORDERED = np.ones(2, dtype=bool)
X = np.random.default_rng(1).random((9, 2))
Y = np.random.default_rng(2).normal(3, 2, 9)
H = Hyperparameters(lengthscales=np.array([0.4, 0.9]), output_variance=1.3, noise_variance=0.05)


def conditioned(rows: np.ndarray) -> Process:
    return Process.condition(X[rows], Standardized(Y[rows], 0.0, 1.0), H, ORDERED)


def test_what_is_left_out_leaves_the_others_precision() -> None:
    precision, others = conditioned(np.arange(9)).precision(), np.arange(9) != 4
    left = precision - np.outer(precision[4], precision[4]) / precision[4, 4]
    assert left[np.ix_(others, others)] == pytest.approx(conditioned(others).precision())
    assert left[4] == pytest.approx(np.zeros(9), abs=1e-9)


@pytest.mark.parametrize("i", range(9))
def test_left_out_outputs_are_told_from_the_others_with_the_mean_unknown(i: int) -> None:
    """Ordinary kriging, whose variance grows by what is not known of the mean."""
    others = np.arange(9) != i
    process = conditioned(others)
    mean, covariance = process.joint(X[i : i + 1])
    K = H.output_variance * process.kernel(X[others], X[others]) + H.noise_variance * np.eye(8)
    k = H.output_variance * process.kernel(X[others], X[i : i + 1])[:, 0]
    weights = np.linalg.solve(K, np.ones(8))
    of_mean = (1 - weights @ k) ** 2 / weights.sum()
    distance, std = (value[i] for value in conditioned(np.arange(9)).left_out())
    assert distance == pytest.approx(Y[i] - mean[0])
    assert std == pytest.approx(math.sqrt(covariance[0, 0] + H.noise_variance + of_mean))


def test_precision_is_the_same_whether_the_inverse_is_at_hand_or_not() -> None:
    process = conditioned(np.arange(9))
    assert process.inverse is not None
    bare = Process(X, process.output, H, process.kernel, process.mean, process.L, process.alpha)
    assert np.array_equal(bare.precision(), process.precision())


def test_outliers_have_no_part_in_the_units() -> None:
    is_outlier = np.arange(9) == 2
    y = np.where(is_outlier, 1e6, Y)
    output, others = Standardized.without(y, is_outlier), Standardized.of(Y[~is_outlier])
    assert (output.offset, output.scale) == (others.offset, others.scale)
    assert output.values[2] == 0.0
    assert np.array_equal(output.values[~is_outlier], others.values)
