"""How much each axis matters to a function."""

import numpy as np
import pytest

from hypermap_lite.space import CategoricalParameter, IntegerParameter, RealParameter, SearchSpace
from hypermap_lite.surrogates.sensitivity import total_sobol_indices

SPACE = SearchSpace(tuple(RealParameter(name=name, low=0, high=1) for name in "abc"))


def test_a_linear_function_has_the_squares_of_its_slopes() -> None:
    rng = np.random.default_rng(0)
    indices = total_sobol_indices(lambda X: np.column_stack([X[:, 0] + 2 * X[:, 1], 1e6 * X[:, 2]]), SPACE, rng)
    assert indices == pytest.approx(np.array([[0.2, 0.8, 0.0], [0.0, 0.0, 1.0]]), abs=0.01)


def test_an_interaction_counts_for_both_axes() -> None:
    # f = (x - 1/2)(y - 1/2) has no main effects at all
    rng = np.random.default_rng(0)
    indices = total_sobol_indices(lambda X: ((X[:, 0] - 0.5) * (X[:, 1] - 0.5))[:, None], SPACE, rng)
    assert indices == pytest.approx(np.array([[1.0, 1.0, 0.0]]), abs=0.05)


def test_a_constant_function_has_no_important_axis() -> None:
    rng = np.random.default_rng(0)
    assert (total_sobol_indices(lambda X: np.full((len(X), 1), 7.3), SPACE, rng) == 0).all()


def test_levels_weigh_alike_whatever_their_order() -> None:
    """A categorical axis before a numeric one keeps its own share: half of its variance is that of a fair coin."""
    space = SearchSpace(
        (CategoricalParameter(name="c", values=("a", "b", "c", "d")), IntegerParameter(name="n", low=1, high=2))
    )

    def function(X: np.ndarray) -> np.ndarray:
        configurations = space.decode(X)
        return np.array([[2.0 * (c["c"] in "ad") + (c["n"] == 2)] for c in configurations])

    indices = total_sobol_indices(function, space, np.random.default_rng(1), points=512)
    assert indices == pytest.approx(np.array([[0.8, 0.2]]), abs=0.03)
