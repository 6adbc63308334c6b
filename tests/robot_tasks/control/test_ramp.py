"""Tests for ramp.py."""

import pytest

from robot_tasks.control import Ramp


def test_a_ramp_starts_settled_at_its_value():
    ramp = Ramp((1.0, 2.0), rate=10.0)
    assert ramp.is_settled
    assert ramp.value == (1.0, 2.0)


def test_components_move_at_the_same_rate_and_stop_at_their_targets():
    ramp = Ramp((0.0, 0.0, 0.0), rate=10.0)
    ramp.aim((1.0, -0.3, 0.0))
    ramp.advance(0.05)
    assert ramp.value == pytest.approx((0.5, -0.3, 0.0))
    assert not ramp.is_settled
    ramp.advance(0.05)
    assert ramp.value == (1.0, -0.3, 0.0)
    assert ramp.is_settled


def test_aiming_at_the_present_value_settles():
    ramp = Ramp((1.0,), rate=10.0)
    ramp.aim((2.0,))
    ramp.aim((1.0,))
    assert ramp.is_settled
