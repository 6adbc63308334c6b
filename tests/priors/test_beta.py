"""Known values of HyperMapper's shapes, and what a beta prior refuses."""

import numpy as np
import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors import BetaPrior
from hypermap_lite.space import OrdinalParameter, RealParameter

UNIT = RealParameter(name="x", low=0, high=1)


@pytest.mark.parametrize(
    ("shape", "u", "expected"),
    [("gaussian", 0.5, 30 / 16), ("decay", 0.1, 0.8 * 0.1**-0.2), ("exponential", 0.9, 0.8 * 0.1**-0.2)],
)
def test_named_shapes_have_hypermappers_densities(shape: str, u: float, expected: float) -> None:
    density = BetaPrior(shape=shape).on(UNIT)
    assert np.exp(density.log_density(np.array([u])))[0] == pytest.approx(expected)


def test_gaussian_shape_on_four_levels_has_hypermappers_masses() -> None:
    density = BetaPrior(shape="gaussian").on(OrdinalParameter(name="o", values=(1.0, 2.0, 3.0, 4.0)))
    masses = np.exp(density.log_density(np.array([0.1, 0.4, 0.6, 0.9]))) / 4
    assert masses == pytest.approx([0.104, 0.396, 0.396, 0.104], abs=1e-3)


def test_a_density_without_bound_is_finite_at_the_bound() -> None:
    assert np.isfinite(BetaPrior(shape="decay").on(UNIT).log_density(np.array([0.0]))).all()


@pytest.mark.parametrize(
    ("alpha", "beta", "mode"), [(3, 3, 0.5), (1, 1, 0.5), (2, 1, 1.0), (1, 2, 0.0), (0.8, 1, 0.01), (1, 0.8, 0.99)]
)
def test_mode(alpha: float, beta: float, mode: float) -> None:
    assert BetaPrior(alpha=alpha, beta=beta).on(UNIT).mode() == pytest.approx(mode)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "needs a shape, or alpha and beta"),
        ({"shape": "decay", "alpha": 1, "beta": 1}, "needs a shape, or alpha and beta"),
        ({"shape": "gausian"}, "Did you mean 'gaussian'"),
        ({"alpha": 1}, "beta is None"),
        ({"alpha": 0, "beta": 1}, "alpha is 0"),
        ({"alpha": 1, "beta": 0.05}, "beta is 0.05"),
    ],
)
def test_impossible_options_are_refused(options: dict, message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        BetaPrior(**options)
