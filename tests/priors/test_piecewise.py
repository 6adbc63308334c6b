"""Known values of densities drawn by hand, and what they refuse."""

import numpy as np
import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors import PiecewisePrior
from hypermap_lite.space import IntegerParameter, OrdinalParameter, RealParameter

TENT = PiecewisePrior(knots=[1, 2, 3, 2, 1]).on(RealParameter(name="x", low=0, high=10))


def test_the_density_is_linear_between_the_knots() -> None:
    # the trapezoids below [1, 2, 3, 2, 1] have an area of 2 on the unit interval
    assert np.exp(TENT.log_density(np.array([0, 0.125, 0.25, 0.5, 1]))) == pytest.approx([0.5, 0.75, 1, 1.5, 0.5])
    assert TENT.mode() == pytest.approx(0.5)
    assert TENT.cdf(np.array([0, 0.25, 0.5, 1])) == pytest.approx([0, 0.1875, 0.5, 1])


def test_every_draw_has_a_value_of_its_own() -> None:
    assert len(set(TENT.sample(1000, np.random.default_rng(0)))) == 1000


def test_a_part_without_density_is_never_drawn() -> None:
    density = PiecewisePrior(knots=[0, 0, 1]).on(RealParameter(name="x", low=0, high=1))
    assert density.sample(1000, np.random.default_rng(0)).min() > 0.5
    assert density.log_density(np.array([0.2]))[0] == -np.inf
    assert density.log_gradient(np.array([0.2]))[0] == 0


def test_an_integer_gets_the_mass_of_its_bin() -> None:
    density = PiecewisePrior(knots=[0, 1]).on(IntegerParameter(name="n", low=0, high=3))
    masses = np.exp(density.log_density(np.array([0.1, 0.3, 0.6, 0.9]))) / 4
    assert masses == pytest.approx([1 / 16, 3 / 16, 5 / 16, 7 / 16])


@pytest.mark.parametrize(
    ("knots", "message"),
    [([1], "there are 1 knots"), ([1, -1], "the density is -1"), ([0, 0], "all densities are zero")],
)
def test_impossible_knots_are_refused(knots: list[float], message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        PiecewisePrior(knots=knots)


def test_a_parameter_without_range_is_refused() -> None:
    with pytest.raises(ScenarioError, match="no range"):
        PiecewisePrior(knots=[1, 2]).on(OrdinalParameter(name="o", values=(1.0, 2.0)))
