"""The kernel against its closed form, scikit-learn's, and finite differences."""

import numpy as np
import pytest
from sklearn.gaussian_process.kernels import Matern

from hypermap_lite.space import PermutationParameter
from hypermap_lite.space.permutation import EMBEDDINGS
from hypermap_lite.surrogates.kernels import MaternHammingKernel

RNG = np.random.default_rng(0)
A, B = RNG.random((6, 3)), RNG.random((4, 3))
LENGTHSCALES = np.array([0.3, 1.1, 2.5])
ORDERED = np.ones(3, dtype=bool)


def test_equals_scikit_learns_matern_on_ordered_axes() -> None:
    ours = MaternHammingKernel(LENGTHSCALES, ORDERED)(A, B)
    assert np.allclose(ours, Matern(LENGTHSCALES, nu=2.5)(A, B), rtol=1e-10)


def test_a_categorical_axis_only_asks_whether_levels_differ() -> None:
    kernel = MaternHammingKernel(np.array([1.0, 0.5]), np.array([True, False]))
    a = np.array([[0.2, 0.25]])
    b = np.array([[0.2, 0.25], [0.2, 0.75], [0.2, 0.5]])
    assert kernel(a, b)[0] == pytest.approx([1.0, np.exp(-2), np.exp(-2)])


def test_close_points_keep_their_correlation() -> None:
    a = np.array([[0.5, 0.5, 0.5]])
    assert MaternHammingKernel(LENGTHSCALES, ORDERED)(a, a + 1e-9)[0, 0] == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("is_ordered", [[True, True, True], [True, False, True]])
def test_gradients_agree_with_finite_differences(is_ordered: list[bool]) -> None:
    mask = np.array(is_ordered)
    X = A.copy()
    X[:, ~mask] = (RNG.integers(3, size=(6, (~mask).sum())) + 0.5) / 3
    W = RNG.random((6, 6))
    W = W + W.T

    def total(log_lengthscales: np.ndarray) -> float:
        return float(np.vdot(W, MaternHammingKernel(np.exp(log_lengthscales), mask)(X, X)))

    kernel = MaternHammingKernel(LENGTHSCALES, mask)
    K, H = kernel.parts(X, X)
    step = 1e-6 * np.eye(3)
    numeric = [(total(np.log(LENGTHSCALES) + e) - total(np.log(LENGTHSCALES) - e)) / 2e-6 for e in step]
    assert kernel.pull_log_lengthscales(W, K, H, X) == pytest.approx(numeric, rel=1e-5, abs=1e-7)


def test_coordinate_gradients_agree_with_finite_differences() -> None:
    kernel = MaternHammingKernel(LENGTHSCALES, ORDERED)
    w = RNG.standard_normal((6, 4))
    gradient = kernel.pull_coordinates(w * kernel.parts(A, B)[1], A, B)
    for j, e in enumerate(1e-6 * np.eye(3)):
        numeric = ((kernel(A + e, B) - kernel(A - e, B)) * w).sum(axis=1) / 2e-6
        assert gradient[:, j] == pytest.approx(numeric, rel=1e-5, abs=1e-8)


ORDERS = PermutationParameter(name="order", size=5, kernel="kendall")


def test_a_permutation_axis_has_the_distance_of_its_kernel() -> None:
    kernel = MaternHammingKernel(np.array([1.0, 0.5]), np.array([True, False]), {1: ORDERS})
    codes = ORDERS.encode([(0, 1, 2, 3, 4), (1, 0, 2, 3, 4), (4, 3, 2, 1, 0)])
    points = np.column_stack([np.full(3, 0.2), codes])
    assert kernel(points[:1], points)[0] == pytest.approx([1.0, np.exp(-2 / 10), np.exp(-2)])


@pytest.mark.parametrize("name", EMBEDDINGS)
def test_gradients_by_the_lengthscale_of_a_permutation_agree_with_finite_differences(name: str) -> None:
    parameter = PermutationParameter(name="order", size=5, kernel=name)
    mask = np.array([True, False, False])
    X = np.column_stack([A[:, 0], parameter.snap(A[:, 1]), (RNG.integers(3, size=6) + 0.5) / 3])
    W = np.ones((6, 6)) + np.eye(6)

    def total(log_lengthscales: np.ndarray) -> float:
        return float(np.vdot(W, MaternHammingKernel(np.exp(log_lengthscales), mask, {1: parameter})(X, X)))

    kernel = MaternHammingKernel(LENGTHSCALES, mask, {1: parameter})
    K, H = kernel.parts(X, X)
    step = 1e-6 * np.eye(3)
    numeric = [(total(np.log(LENGTHSCALES) + e) - total(np.log(LENGTHSCALES) - e)) / 2e-6 for e in step]
    assert kernel.pull_log_lengthscales(W, K, H, X) == pytest.approx(numeric, rel=1e-5, abs=1e-7)
    assert not kernel.pull_coordinates(W * H, X, X)[:, 1:].any()
