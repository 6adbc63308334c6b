"""What holds for every type of parameter."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypermap_lite.errors import ScenarioError
from hypermap_lite.space import PARAMETERS, IntegerParameter, OrdinalParameter, Parameter, RealParameter
from tests.strategies import integers, parameters

codes = st.lists(st.floats(0, 1), min_size=1, max_size=20).map(np.array)


@given(parameters(), codes)
def test_decoded_values_are_legal_and_encode_and_decode_exactly(parameter: Parameter, u: np.ndarray) -> None:
    values = parameter.decode(u)
    assert all(parameter.contains(value) for value in values)
    assert parameter.decode(parameter.encode(values)) == values


@given(parameters(), codes)
def test_codes_of_values_stay_in_the_unit_interval_and_close_to_where_they_came_from(
    parameter: Parameter, u: np.ndarray
) -> None:
    again = parameter.encode(parameter.decode(u))
    assert np.all((again >= 0) & (again <= 1))
    if parameter.n_levels is None:
        assert np.allclose(again, u, atol=1e-6)  # twelve digits of a narrow range far from zero


@given(parameters(), codes)
def test_snapped_codes_are_those_of_the_decoded_values(parameter: Parameter, u: np.ndarray) -> None:
    if parameter.n_levels is not None:
        assert np.array_equal(parameter.snap(u), parameter.encode(parameter.decode(u)))


def one_by_one(parameter: RealParameter, codes: np.ndarray) -> list[float]:
    """Round each value by itself, as Python does: correctly, ties to even, to twelve digits of the range or value."""
    found = []
    low, high = (math.log10(x) if parameter.log else x for x in (parameter.low, parameter.high))
    for u in codes.tolist():
        position = low + u * (high - low)
        value = 10.0**position if parameter.log else position
        digits = 12 - math.ceil(math.log10(abs(value) if parameter.log else high - low))
        found.append(min(max(round(value, digits), parameter.low), parameter.high) + 0.0)
    return found


RANGES = [(0, 1), (-0.3, 0.3), (2.0, 1024.0), (1e-3, 1e3), (-7.04, -4.53), (1e6, 1e6 + 1e-3), (3.6e10, 1.3e11)]
EXTREME = [(0.0, 1e-12), (1e-40, 1e-38), (-1e30, 1e30), (1e22, 1e24), (1e-300, 1e300), (-1e308, 5e307)]


@pytest.mark.parametrize(
    ("low", "high", "log"),
    [(low, high, log) for low, high in RANGES + EXTREME for log in (False, True) if low > 0 or not log],
)
def test_many_values_are_rounded_to_the_same_bits_as_one(low: float, high: float, log: bool) -> None:
    parameter, rng = RealParameter(name="x", low=low, high=high, log=log), np.random.default_rng(0)
    ties = [(rng.integers(0, 10**k, 1000) + 0.5) / 10**k for k in (6, 12)]
    u = np.concatenate([rng.random(1000), np.linspace(0, 1, 41), rng.integers(0, 4096, 200) / 4096, *ties])
    found = parameter.decode(u)
    assert {type(value) for value in found} == {float}
    assert [value.hex() for value in found] == [value.hex() for value in one_by_one(parameter, u)]


@given(integers(), st.floats(0, 1))
def test_integers_never_leave_their_bounds(parameter: IntegerParameter, u: float) -> None:
    (value,) = parameter.decode(np.array([u]))
    assert isinstance(value, int)
    assert parameter.low <= value <= parameter.high


@given(parameters(), codes)
def test_codes_of_levels_lie_inside_their_bins_which_hold_the_point(parameter: Parameter, u: np.ndarray) -> None:
    if parameter.n_levels is None:
        return
    levels = parameter.level_index(u)
    low, high = parameter.bins_of_levels(levels)
    level_codes = parameter.codes_of_levels(levels)
    assert np.all((low < level_codes) & (level_codes < high))
    assert np.all((low <= u + 1e-9) & (u <= high + 1e-9))


def test_the_bins_fill_the_interval() -> None:
    edges = IntegerParameter(name="n", low=1, high=64, log=True).bin_edges()
    assert edges[0] == 0
    assert edges[-1] == 1
    assert np.all(np.diff(edges) > 0)


def test_every_integer_of_a_linear_axis_is_equally_likely() -> None:
    parameter = IntegerParameter(name="n", low=0, high=15)
    values = parameter.decode(np.linspace(0, 1, 16_001)[:-1])
    assert sorted(set(values)) == list(range(16))
    assert np.ptp(np.bincount(values)) <= 2


def test_a_log_axis_places_decades_equally() -> None:
    parameter = RealParameter(name="r", low=1e-4, high=1.0, log=True)
    assert np.allclose(parameter.encode([1e-4, 1e-3, 1e-2, 1e-1, 1.0]), [0, 0.25, 0.5, 0.75, 1])


def test_ordinal_levels_are_sorted_and_equally_spaced() -> None:
    parameter = OrdinalParameter(name="o", values=(8.0, 1.0, 2.0))
    assert parameter.decode(np.array([0.1, 0.5, 0.9])) == [1.0, 2.0, 8.0]


def test_a_large_integer_range_is_not_enumerated() -> None:
    parameter = IntegerParameter(name="n", low=0, high=10**12)
    assert parameter.decode(np.array([0.0, 0.5, 1.0])) == [0, 5 * 10**11, 10**12]


@pytest.mark.parametrize("value", [True, "2", None, float("nan"), 11, -1])
def test_illegal_values_are_not_contained(value: object) -> None:
    assert not IntegerParameter(name="n", low=0, high=10).contains(value)
    assert not RealParameter(name="r", low=0, high=10).contains(value)


@pytest.mark.parametrize(
    ("kind", "options", "message"),
    [
        pytest.param("real", {"low": 2, "high": 1}, "reversed", id="reversed"),
        pytest.param("real", {"low": 1, "high": 1}, "equal", id="equal"),
        pytest.param("real", {"low": "a", "high": 1}, "finite number", id="text"),
        pytest.param("real", {"low": 0, "high": float("inf")}, "finite number", id="infinite"),
        pytest.param("real", {"low": 0, "high": 1, "log": True}, "not positive", id="log-from-zero"),
        pytest.param("real", {"low": -1e308, "high": 1e308}, "not finite", id="infinite-range"),
        pytest.param("integer", {"low": 0, "high": 2**60}, "too large", id="beyond-exact-floats"),
        pytest.param("integer", {"low": 0, "high": 10**400}, "finite number", id="beyond-floats"),
        pytest.param("integer", {"low": 0.5, "high": 3}, "not whole", id="half"),
        pytest.param("ordinal", {"values": (1.0,)}, "no choice", id="single-level"),
        pytest.param("ordinal", {"values": (1.0, 2.0, 1.0)}, "twice", id="repeated-level"),
        pytest.param("categorical", {"values": ()}, "no choice", id="empty"),
        pytest.param("categorical", {"values": ("a", "a")}, "twice", id="repeated-category"),
    ],
)
def test_illegal_ranges_are_refused(kind: str, options: dict, message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        PARAMETERS[kind](name="x", **options)


def test_zero_has_no_sign():
    parameter = RealParameter(name="x", low=-5.0, high=10.0)
    assert str(parameter.decode(parameter.encode([0.0]))[0]) == "0.0"
