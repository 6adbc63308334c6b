"""Cholesky factors that do not fail."""

import numpy as np
import pytest

from hypermap_lite.surrogates.linear_algebra import safe_cholesky, solve_lower


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


def test_triangular_solves() -> None:
    L = np.array([[2.0, 0.0], [1.0, 3.0]])
    b = np.array([2.0, 7.0])
    assert L @ solve_lower(L, b) == pytest.approx(b)
    assert L.T @ solve_lower(L, b, transposed=True) == pytest.approx(b)
