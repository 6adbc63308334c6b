"""Tests for echoes.py."""

import pytest

from hypermap_lite.evaluation.echoes import differences, distance, find_request
from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, RealParameter, SearchSpace

SPACE = SearchSpace(
    (
        RealParameter(name="x", low=-5.0, high=10.0),
        RealParameter(name="rate", low=1e-8, high=1.0, log=True),
        IntegerParameter(name="n", low=0, high=9),
        OrdinalParameter(name="o", values=(0.5, 1.0, 2.0)),
        CategoricalParameter(name="c", values=("red", "green")),
    )
)
ASKED = {"x": 3.14159265358979, "rate": 1.23456789e-06, "n": 3, "o": 1.0, "c": "red"}
ECHO = {"x": "3.14159265358979", "rate": "1.23456789e-06", "n": "3", "o": "1", "c": "red"}


def test_exact_echo_is_at_distance_zero():
    assert distance(SPACE, ASKED, ECHO) == 0.0


@pytest.mark.parametrize(
    "change", [{"x": "3.14159"}, {"rate": "1.23457e-06"}, {"n": "3.0"}, {"o": "1.0"}, {"n": "3e0", "extra": "7"}]
)
def test_rounded_or_rewritten_echo_is_the_same(change):
    assert find_request(SPACE, {0: ASKED}, ECHO | change, 0) == 0


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"x": "3.142"}, "x is 3.142, asked for 3.14159265358979"),
        ({"rate": "0.000001"}, "rate is 0.000001, asked for 1.23456789e-06"),
        ({"n": "4"}, "n is 4, asked for 3"),
        ({"o": "2"}, "o is 2, asked for 1"),
        ({"c": "green"}, "c is green, asked for red"),
        ({"x": "nan"}, "x is nan, asked for 3.14159265358979"),
        ({"x": "three"}, "x is three, asked for 3.14159265358979"),
    ],
)
def test_other_echo_is_another_configuration(change, says):
    assert find_request(SPACE, {0: ASKED}, ECHO | change, 0) is None
    assert differences(SPACE, ASKED, ECHO | change) == [says]


def test_rows_in_another_order_find_their_request():
    waiting = {i: ASKED | {"n": i} for i in range(4)}
    for position, n in enumerate([2, 0, 3, 1]):
        assert find_request(SPACE, waiting, ECHO | {"n": str(n), "x": "3.14159"}, position) == n
        del waiting[n]


def test_of_configurations_that_round_to_the_same_the_one_in_order_is_meant():
    waiting = {0: ASKED, 1: ASKED | {"x": 3.1415926}}
    assert find_request(SPACE, waiting, ECHO | {"x": "3.14159"}, 1) == 1


def test_exact_echo_goes_before_the_order():
    waiting = {0: ASKED | {"x": 3.1415926}, 1: ASKED}
    assert find_request(SPACE, waiting, ECHO, 0) == 1
