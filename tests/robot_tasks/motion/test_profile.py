"""Tests for profile.py."""

from math import sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_tasks.motion import MotionLimits, TrapezoidalProfile

LIMITS = MotionLimits(speed=0.2, acceleration=0.3, deceleration=0.15)
# Speeding up takes 0.2^2 / 0.6 = 1/15 m and 2/3 s, slowing down 0.2^2 / 0.3 = 2/15 m and 4/3 s.


def test_a_long_way_has_a_cruise():
    profile = TrapezoidalProfile.plan(1.0, LIMITS)
    assert (profile.t_accelerate, profile.t_cruise, profile.t_decelerate) == pytest.approx((2 / 3, 4.0, 4 / 3))
    assert profile.duration == pytest.approx(6.0)
    assert profile.travelled(2 / 3) == pytest.approx(1 / 15)
    assert profile.travelled(2 / 3 + 4.0) == pytest.approx(13 / 15)


def test_a_short_way_is_a_triangle():
    profile = TrapezoidalProfile.plan(0.05, LIMITS)
    t_accelerate = sqrt(2 * 0.05 * 0.15 / (0.3 * 0.45))
    assert profile.t_accelerate == pytest.approx(t_accelerate)
    assert profile.t_cruise == 0.0
    assert profile.t_decelerate == pytest.approx(2 * t_accelerate)
    assert profile.travelled(t_accelerate) == pytest.approx(0.5 * 0.3 * t_accelerate**2)


def test_the_way_that_just_reaches_full_speed_is_both():
    profile = TrapezoidalProfile.plan(0.2, LIMITS)
    assert profile.t_cruise == pytest.approx(0.0, abs=1e-12)
    assert profile.t_accelerate == pytest.approx(2 / 3)


def test_no_way_takes_no_time():
    profile = TrapezoidalProfile.plan(0.0, LIMITS)
    assert profile.duration == 0.0
    assert profile.travelled(0.0) == 0.0


@given(st.floats(1e-6, 3.0), st.floats(0.0, 1.0))
def test_the_way_is_covered_forwards_and_within_the_limits(way, fraction):
    profile = TrapezoidalProfile.plan(way, LIMITS)
    time, dt = fraction * profile.duration, 1e-3
    before, here, after = (profile.travelled(max(0.0, t)) for t in (time - dt, time, time + dt))
    assert 0.0 <= before <= here <= after <= way
    assert (after - here) / dt <= 0.2 + 1e-9
    assert -0.15 - 1e-6 <= (after - 2 * here + before) / dt**2 <= 0.3 + 1e-6 or time < dt
    assert profile.travelled(profile.duration) == way


def test_limits_must_be_positive():
    with pytest.raises(ValueError, match=r"motion limits must be positive, got .*speed=0.0"):
        MotionLimits(speed=0.0, acceleration=1.0, deceleration=1.0)
