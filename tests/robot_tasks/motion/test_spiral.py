"""Tests for spiral.py: the closed form against its law of motion, and the published points."""

from math import cos, hypot, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from robot_tasks.geometry import TOOL_DOWN, Pose
from robot_tasks.motion import ArchimedesSpiral, MotionGenerator, SteppedSpiral

CORE = 0.001
SPIRALS = {
    "of the operator": ArchimedesSpiral(pitch=0.015, speed=0.1, radius=0.02),
    "fine": ArchimedesSpiral(pitch=0.003, speed=0.05, radius=0.01),
    "less than a turn": ArchimedesSpiral(pitch=0.03, speed=0.3, radius=0.005),
    "wide": ArchimedesSpiral(pitch=0.01, speed=0.3, radius=0.04),
}
every_spiral = pytest.mark.parametrize("spiral", SPIRALS.values(), ids=SPIRALS)

fields = st.fixed_dictionaries(
    {
        "pitch": st.just(0.0) | st.floats(1e-6, 0.03),
        "speed": st.just(0.0) | st.floats(1e-6, 0.3),
        "radius": st.just(0.0) | st.floats(1e-6, 0.08),
    }
)


def seconds_out(spiral):
    """Time in [s] from the centre to the largest radius: the integral of (r + CORE) over the angle."""
    turned = 2.0 * pi * spiral.radius / spiral.pitch
    return (spiral.radius / 2.0 + CORE) * turned / spiral.speed


def radius(spiral, time):
    x, y, _ = spiral.offset(time)
    return hypot(x, y)


def integrate(spiral, seconds, n_times):
    """Integrate the law of motion: the angle, and a radius that turns back at its bounds.

    The radius is that of a way u that grows for ever, folded at every multiple of the largest radius.
    """

    def fold(way):
        return spiral.radius - np.abs(way % (2.0 * spiral.radius) - spiral.radius)

    def law(_, state):
        turning_rate = spiral.speed / (fold(state[0]) + CORE)
        return spiral.pitch / (2.0 * pi) * turning_rate, turning_rate

    times = np.linspace(0.0, seconds, n_times)
    solution = solve_ivp(law, (0.0, seconds), (0.0, 0.0), t_eval=times, rtol=1e-8, atol=1e-11, max_step=seconds / 400)
    r, angle = fold(solution.y[0]), solution.y[1]
    return times, np.column_stack([r * np.cos(angle), r * np.sin(angle), np.zeros(n_times)])


@every_spiral
def test_the_offset_solves_the_law_of_motion_out_and_in_and_out_again(spiral):
    times, offsets = integrate(spiral, 2.7 * seconds_out(spiral), 301)
    assert np.array([spiral.offset(time) for time in times]) == pytest.approx(offsets, abs=2e-6)


@every_spiral
def test_the_largest_radius_is_reached_and_the_centre_again(spiral):
    one_way = seconds_out(spiral)
    assert radius(spiral, one_way) == pytest.approx(spiral.radius)
    assert radius(spiral, 2.0 * one_way) == pytest.approx(0.0, abs=1e-12)
    assert radius(spiral, 3.0 * one_way) == pytest.approx(spiral.radius)


@every_spiral
@pytest.mark.parametrize("turning_point", [1, 2, 3, 4])
def test_the_offset_does_not_leap_where_the_spiral_turns(spiral, turning_point):
    time, dt = turning_point * seconds_out(spiral), 1e-6
    before, after = spiral.offset(time - dt), spiral.offset(time + dt)
    assert np.linalg.norm(np.subtract(after, before)) <= 2.0 * 1.1 * spiral.speed * dt


@pytest.mark.parametrize("part", [0.3, 0.6, 0.9, 1.1, 1.4])
def test_the_path_is_run_at_its_speed_away_from_the_centre(part):
    spiral, dt = ArchimedesSpiral(pitch=0.01, speed=0.1, radius=0.05), 1e-5
    time = part * seconds_out(spiral)
    step = np.linalg.norm(np.subtract(spiral.offset(time + dt), spiral.offset(time)))
    r = radius(spiral, time)
    assert r > 0.02
    assert step / dt == pytest.approx(0.1 * hypot(r, 0.01 / (2.0 * pi)) / (r + CORE), rel=1e-4)
    assert step / dt == pytest.approx(0.1, rel=0.05)


@pytest.mark.parametrize("turns", [0.5, 1.0, 2.25, 3.75])
def test_neighbouring_turns_are_a_pitch_apart(turns):
    spiral = ArchimedesSpiral(pitch=0.01, speed=0.1, radius=0.05)
    angle = 2.0 * pi * turns
    time = (0.01 * turns / 2.0 + CORE) * angle / 0.1  # the integral of (r + CORE) over the angle, at r = pitch x turns
    assert spiral.offset(time) == pytest.approx((0.01 * turns * cos(angle), 0.01 * turns * sin(angle), 0.0))


@given(fields)
def test_a_spiral_starts_at_zero(given_fields):
    assert ArchimedesSpiral(**given_fields).offset(0.0) == (0.0, 0.0, 0.0)


@given(fields, st.floats(0.0, 20.0))
def test_a_spiral_is_horizontal_and_never_beyond_its_radius(given_fields, time):
    x, y, z = ArchimedesSpiral(**given_fields).offset(time)
    assert hypot(x, y) <= given_fields["radius"] * (1.0 + 1e-9)
    assert z == 0.0


@given(fields, st.floats(0.0, 20.0), st.floats(0.0, 0.1))
def test_a_spiral_never_moves_faster_than_its_speed_allows(given_fields, time, dt):
    spiral = ArchimedesSpiral(**given_fields)
    step = np.linalg.norm(np.subtract(spiral.offset(time + dt), spiral.offset(time)))
    fastest = spiral.speed * max(1.0, spiral.pitch / (2.0 * pi) / CORE)
    assert step <= fastest * dt + 1e-9


@pytest.mark.parametrize("kind", [ArchimedesSpiral, SteppedSpiral])
@pytest.mark.parametrize("name", ["pitch", "speed", "radius"])
def test_without_pitch_speed_or_radius_there_is_no_motion(kind, name):
    still = kind(**{"pitch": 0.015, "speed": 0.1, "radius": 0.02, name: 0.0})
    assert [still.offset(time) for time in (0.0, 0.1, 1.0, 17.98)] == [(0.0, 0.0, 0.0)] * 4


@pytest.mark.parametrize("kind", [ArchimedesSpiral, SteppedSpiral])
@pytest.mark.parametrize("name", ["pitch", "speed", "radius"])
def test_no_number_of_a_spiral_may_be_negative(kind, name):
    with pytest.raises(ValueError, match=r"spiral, pitch .* m, .* m/s, radius up to .* m: no number may be negative"):
        kind(**{"pitch": 0.015, "speed": 0.1, "radius": 0.02, name: -0.001})


def test_a_spiral_describes_itself():
    assert str(SPIRALS["of the operator"]) == "spiral, pitch 0.015 m, 0.1 m/s, radius up to 0.02 m"


@pytest.fixture
def stepped():
    return SteppedSpiral(pitch=0.015, speed=0.1, radius=0.02)


def test_the_stepped_spiral_leaps_to_the_largest_radius_in_its_first_step(stepped):
    # 0.1 m/s x 0.1 s / 1 mm = 10 rad, after which r = 10 x 15 mm / (2 pi) = 23.9 mm is cut to 20 mm
    assert stepped.offset(0.1) == pytest.approx((0.02 * cos(10.0), 0.02 * sin(10.0), 0.0))


def test_the_stepped_spiral_goes_in_again_step_by_step(stepped):
    turned = 10.0 + 0.01 / 0.021
    r = 0.02 - 0.01 / 0.021 * 0.015 / (2.0 * pi)
    assert stepped.offset(0.2) == pytest.approx((r * cos(turned), r * sin(turned), 0.0))
    turned, r = turned + 0.01 / (r + CORE), r - 0.01 / (r + CORE) * 0.015 / (2.0 * pi)
    assert stepped.offset(0.3) == pytest.approx((r * cos(turned), r * sin(turned), 0.0))


def test_the_stepped_spiral_turns_at_the_centre():
    # the first step goes to 15 mm and the cut radius of 1 mm, the second turns by 5 rad and ends at r = 0
    spiral = SteppedSpiral(pitch=0.02 * pi, speed=0.1, radius=0.001)
    assert spiral.offset(0.1) == pytest.approx((0.001 * cos(10.0), 0.001 * sin(10.0), 0.0))
    assert spiral.offset(0.2) == pytest.approx((0.0, 0.0, 0.0))
    assert spiral.offset(0.3) == pytest.approx((0.001 * cos(25.0), 0.001 * sin(25.0), 0.0))


def test_the_stepped_spiral_holds_between_its_steps(stepped):
    ticks = [stepped.offset(0.02 * tick) for tick in range(15)]
    assert len(set(ticks)) == 3
    assert ticks[0:5] == [(0.0, 0.0, 0.0)] * 5
    assert ticks[5:10] == [stepped.offset(0.1)] * 5
    assert ticks[10:15] == [stepped.offset(0.2)] * 5


def test_the_stepped_spiral_may_be_asked_in_any_order(stepped):
    late, early = stepped.offset(7.0), stepped.offset(0.3)
    fresh = SteppedSpiral(pitch=0.015, speed=0.1, radius=0.02)
    assert fresh.offset(0.3) == early
    assert fresh.offset(7.0) == late


@given(fields, st.integers(0, 180))
def test_the_stepped_spiral_is_never_beyond_its_radius(given_fields, n_steps):
    x, y, z = SteppedSpiral(**given_fields).offset(0.1 * n_steps)
    assert hypot(x, y) <= given_fields["radius"] * (1.0 + 1e-9)
    assert z == 0.0


def test_a_stepped_spiral_in_small_steps_is_the_spiral(monkeypatch):
    monkeypatch.setattr("robot_tasks.motion.spiral.PUBLISHED_STEP", 1e-4)
    fine = SteppedSpiral(pitch=0.01, speed=0.05, radius=0.02)
    smooth = ArchimedesSpiral(pitch=0.01, speed=0.05, radius=0.02)
    for time in (0.2, 0.6, 1.0, 1.4):
        assert fine.offset(time) == pytest.approx(smooth.offset(time), abs=3e-4)


@pytest.mark.parametrize("kind", [ArchimedesSpiral, SteppedSpiral])
def test_spirals_are_compared_by_value_and_kind_whatever_they_were_asked(kind):
    used, fresh = (kind(pitch=0.015, speed=0.1, radius=0.02) for _ in range(2))
    used.offset(3.0)
    assert used == fresh
    assert used != kind(pitch=0.015, speed=0.1, radius=0.021)
    assert ArchimedesSpiral(pitch=0.015, speed=0.1, radius=0.02) != SteppedSpiral(pitch=0.015, speed=0.1, radius=0.02)


@pytest.mark.parametrize("kind", [ArchimedesSpiral, SteppedSpiral])
def test_an_equal_spiral_goes_on_as_an_overlay_and_another_starts_afresh(kind):
    generator = MotionGenerator(Pose((0.0, 0.0, 1.0), TOOL_DOWN))
    generator.set_overlay(kind(pitch=0.015, speed=0.1, radius=0.02), 1.0)
    generator.set_overlay(kind(pitch=0.015, speed=0.1, radius=0.02), 1.5)
    x, y, _ = kind(pitch=0.015, speed=0.1, radius=0.02).offset(1.0)
    assert generator.reference(2.0).position == pytest.approx((x, y, 1.0))
    generator.set_overlay(kind(pitch=0.015, speed=0.1, radius=0.03), 2.0)
    assert generator.reference(2.0).position == (0.0, 0.0, 1.0)
