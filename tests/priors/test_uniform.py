"""The flat density, on the whole axis and on a range."""

import math

import numpy as np
import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors import UniformPrior
from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, Parameter, RealParameter

REAL = RealParameter(name="r", low=0, high=10)
LOG = RealParameter(name="l", low=0.01, high=100, log=True)
INTEGER = IntegerParameter(name="i", low=1, high=8)
ORDINAL = OrdinalParameter(name="o", values=(16.0, 32.0, 64.0, 128.0))
CATEGORICAL = CategoricalParameter(name="c", values=("a", "b"))


def masses(axis: Parameter, **ends: float | None) -> np.ndarray:
    """Return the probability of each level."""
    return np.exp(UniformPrior(**ends).on(axis).log_density(axis.level_codes())) * np.diff(axis.bin_edges())


def test_a_range_is_in_native_units() -> None:
    density = UniformPrior(low=2, high=7).on(REAL)
    assert np.exp(density.log_density(np.array([0.1, 0.2, 0.5, 0.7, 0.71]))) == pytest.approx([0, 2, 2, 2, 0])
    assert density.mode() == pytest.approx(0.45)


def test_a_range_on_a_log_axis_is_even_in_the_logarithm() -> None:
    density = UniformPrior(low=0.1, high=10).on(LOG)
    assert density.cdf(np.array([0.25, 0.5, 0.75])) == pytest.approx([0, 0.5, 1])


@pytest.mark.parametrize(
    ("axis", "ends", "part"),
    [
        pytest.param(REAL, {"low": -5, "high": 5}, (0, 0.5), id="below-the-bounds"),
        pytest.param(REAL, {"low": 5, "high": 50}, (0.5, 1), id="above-the-bounds"),
        pytest.param(REAL, {"low": -5, "high": 50}, (0, 1), id="all"),
        pytest.param(REAL, {"low": 5}, (0.5, 1), id="low-only"),
        pytest.param(REAL, {"high": 5}, (0, 0.5), id="high-only"),
        pytest.param(LOG, {"low": -1, "high": 1}, (0, 0.5), id="below-zero-on-a-log-axis"),
    ],
)
def test_a_range_is_cut_off_at_the_bounds(axis: Parameter, ends: dict, part: tuple[float, float]) -> None:
    density = UniformPrior(**ends).on(axis)
    assert (density.start, density.end) == pytest.approx(part)


@pytest.mark.parametrize(
    ("axis", "ends", "expected"),
    [
        pytest.param(INTEGER, {"low": 3, "high": 6}, [0, 0, 1, 1, 1, 1, 0, 0], id="integer"),
        pytest.param(INTEGER, {"low": 2.2, "high": 4.8}, [0, 0, 1, 1, 0, 0, 0, 0], id="integer-between-levels"),
        pytest.param(INTEGER, {"low": -9, "high": 2}, [1, 1, 0, 0, 0, 0, 0, 0], id="integer-cut-off"),
        pytest.param(ORDINAL, {"low": 20, "high": 64}, [0, 1, 1, 0], id="ordinal"),
        pytest.param(ORDINAL, {"low": 100}, [0, 0, 0, 1], id="ordinal-low-only"),
    ],
)
def test_levels_in_the_range_are_equally_likely(axis: Parameter, ends: dict, expected: list) -> None:
    assert masses(axis, **ends) == pytest.approx(np.array(expected) / sum(expected))


def test_an_integer_range_on_a_log_axis_keeps_whole_bins() -> None:
    axis = IntegerParameter(name="k", low=1, high=64, log=True)
    found = masses(axis, low=2, high=4)
    assert found[1:4] == pytest.approx(np.log([2.5 / 1.5, 3.5 / 2.5, 4.5 / 3.5]) / math.log(4.5 / 1.5))
    assert found.sum() == pytest.approx(1)


@pytest.mark.parametrize(
    ("axis", "ends", "message"),
    [
        pytest.param(REAL, {"low": 5, "high": 5}, "is empty", id="empty"),
        pytest.param(REAL, {"low": 7, "high": 5}, "is reversed", id="reversed"),
        pytest.param(REAL, {"low": "a"}, "a finite number", id="no-number"),
        pytest.param(REAL, {"low": 11}, "from 11 to the bound has no value of 'r'", id="above"),
        pytest.param(REAL, {"low": -3, "high": -1}, "from -3 to -1 has no value of 'r'", id="below"),
        pytest.param(LOG, {"low": -3, "high": -1}, "has no value of 'l'", id="below-zero-on-a-log-axis"),
        pytest.param(INTEGER, {"low": 2.2, "high": 2.8}, "has no value of 'i'", id="between-integers"),
        pytest.param(ORDINAL, {"low": 17, "high": 31}, "has no value of 'o'", id="between-levels"),
        pytest.param(CATEGORICAL, {"low": 0}, "'c' has no order", id="categorical"),
    ],
)
def test_impossible_ranges_are_refused(axis: Parameter, ends: dict, message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        UniformPrior(**ends).on(axis)
