"""Cholesky factors that do not fail."""

from typing import Literal

import numpy as np
import pytest

from hypermap_lite.surrogates.linear_algebra import inverse_from_cholesky, safe_cholesky, solve_lower


def test_a_good_matrix_gets_no_jitter() -> None:
    K = np.array([[2.0, 0.5], [0.5, 1.0]])
    assert safe_cholesky(K) == pytest.approx(np.linalg.cholesky(K), abs=0)


def test_a_singular_matrix_gets_a_little() -> None:
    L = safe_cholesky(np.ones((5, 5)))
    assert L is not None
    assert pytest.approx(np.ones((5, 5)), abs=1e-8) == L @ L.T


def test_an_indefinite_or_infinite_matrix_has_none() -> None:
    assert safe_cholesky(np.array([[1.0, 2.0], [2.0, 1.0]])) is None
    assert safe_cholesky(np.array([[np.nan]])) is None


def test_the_inverse_is_symmetric() -> None:
    K = np.array([[2.0, 0.5, 0.1], [0.5, 1.0, 0.3], [0.1, 0.3, 3.0]])
    L = safe_cholesky(K)
    assert L is not None
    inverse = inverse_from_cholesky(L)
    assert inverse == pytest.approx(np.linalg.inv(K))
    assert np.array_equal(inverse, inverse.T)


def test_a_factor_with_a_zero_on_its_diagonal_has_no_inverse() -> None:
    L = np.array([[1.0, 0.0], [1.0, 0.0]])
    with pytest.raises(np.linalg.LinAlgError, match=r"row 2 .* zero"):
        solve_lower(L, np.ones(2))
    with pytest.raises(np.linalg.LinAlgError, match=r"row 2 .* zero"):
        inverse_from_cholesky(L)


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("shape", [(2,), (2, 3), (2, 0)])
def test_triangular_solves(order: Literal["C", "F"], shape: tuple[int, ...]) -> None:
    L = np.array([[2.0, 0.0], [1.0, 3.0]], order=order)
    B = np.random.default_rng(0).random(shape)
    assert L @ solve_lower(L, B) == pytest.approx(B)
    assert L.T @ solve_lower(L, B, transposed=True) == pytest.approx(B)
