"""Tests for parameter_axes.py."""

import numpy as np
import pytest

from hypermap_lite.errors import RunFolderError, UsageError
from hypermap_lite.plotting.parameter_axes import chosen_axes, end_codes, name_with_scale, ticks, values_of
from hypermap_lite.plotting.runs import load_run
from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, RealParameter, SearchSpace
from tests.plotting.run_folders import write_run

SPACE = SearchSpace(tuple(RealParameter(name=name, low=0.0, high=1.0) for name in ("speed", "force", "stiffness")))


@pytest.mark.parametrize(
    ("parameter", "texts"),
    [
        pytest.param(RealParameter(name="p", low=-0.5, high=1.5), "−0.5 0.0 0.5 1.0 1.5", id="linear"),
        pytest.param(RealParameter(name="p", low=1e-3, high=20, log=True), "0.001 0.01 0.1 1 10", id="log"),
        pytest.param(RealParameter(name="p", low=2, high=60, log=True), "2 5 10 20 50", id="less than two decades"),
        pytest.param(RealParameter(name="p", low=6, high=9, log=True), "6 7 8 9", id="no power"),
        pytest.param(IntegerParameter(name="p", low=1, high=4), "1 2 3 4", id="all integers"),
        pytest.param(IntegerParameter(name="p", low=0, high=100), "0 20 40 60 80 100", id="some integers"),
        pytest.param(OrdinalParameter(name="p", values=(8, 0.5, 2)), "0.5 2 8", id="ordinal"),
        pytest.param(CategoricalParameter(name="p", values=("b", "a")), "b a", id="categorical"),
    ],
)
def test_ticks_are_round_numbers_or_levels(parameter, texts):
    codes, found = ticks(parameter)
    assert " ".join(found).replace(".0", "") == texts.replace(".0", "")
    assert ((codes >= 0) & (codes <= 1)).all()


def test_ticks_stand_where_their_values_lie():
    codes, texts = ticks(RealParameter(name="p", low=1e-2, high=1e2, log=True))
    np.testing.assert_allclose(codes[texts.index("1")], 0.5)


def test_axis_ends_with_the_first_and_the_last_value():
    assert end_codes(RealParameter(name="p", low=3, high=4)) == (0, 1)
    assert end_codes(IntegerParameter(name="p", low=1, high=4)) == (0.125, 0.875)


def test_logarithmic_axis_says_so():
    assert name_with_scale(RealParameter(name="p", low=1, high=4, log=True)) == "p (log)"
    assert name_with_scale(CategoricalParameter(name="p", values=("b", "a"))) == "p"


def test_axes_come_in_the_order_of_their_names():
    assert chosen_axes(["stiffness", "speed"], SPACE) == [2, 0]


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (["sped"], r"unknown parameter 'sped'; known: speed, force, stiffness. Did you mean 'speed'"),
        (["force", "force"], "'force' is given twice"),
    ],
)
def test_other_names_are_an_error(names, message):
    with pytest.raises(UsageError, match=message):
        chosen_axes(names, SPACE)


def test_values_are_read_in_native_units(tmp_path):
    run = load_run(write_run(tmp_path, [[1.0, 1.0]] * 2))
    assert values_of(run, RealParameter(name="x", low=0, high=10)) == [0.0, 0.1]


@pytest.mark.parametrize(
    ("parameter", "message"),
    [
        (RealParameter(name="x", low=5, high=10), r"history.csv: x is 0.0, which is not a number from 5 to 10"),
        (RealParameter(name="y", low=5, high=10), r"history.csv: no column 'y'; found x, performance"),
    ],
)
def test_history_of_another_space_is_an_error(tmp_path, parameter, message):
    run = load_run(write_run(tmp_path, [[1.0, 1.0]]))
    with pytest.raises(RunFolderError, match=message):
        values_of(run, parameter)
