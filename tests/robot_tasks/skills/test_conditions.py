"""Tests for conditions.py."""

from math import cos, inf, radians, sin

import pytest

from robot_tasks.geometry import Pose
from robot_tasks.skills.conditions import At, Not, PointsDown, Within, first_violated
from tests.robot_tasks.skills.scripted import Scene


def turned(position=(0.0, 0.0, 0.0), degrees=0.0):
    half = radians(degrees) / 2
    return Pose(position, (cos(half), 0.0, 0.0, sin(half)))


CORNER = At(thing="prism", place=turned(), place_name="corner", distance=0.03, angle=radians(10))


@pytest.mark.parametrize(
    ("pose", "holds"),
    [
        pytest.param(turned((0.02, 0.02, 0.0), 9.0), True, id="near and turned little"),
        pytest.param(turned((0.02, 0.02, 0.02)), False, id="too far"),
        pytest.param(turned((0.0, 0.0, 0.0), 11.0), False, id="turned too much"),
        pytest.param(turned((0.0, 0.0, 0.0), -9.0), True, id="turned little the other way"),
    ],
)
def test_a_thing_is_at_a_place_within_distance_and_angle(pose, holds):
    assert CORNER.holds(Scene(prism=pose)) is holds
    assert Not(CORNER).holds(Scene(prism=pose)) is not holds


def test_without_an_angle_the_orientation_does_not_matter():
    assert At(thing="pin", place=turned(), place_name="hole", distance=0.1).holds(Scene(pin=turned(degrees=170.0)))


@pytest.mark.parametrize(
    ("goal", "holds"),
    [
        pytest.param(turned((0.5, 0.1, 0.0)), True, id="there"),
        pytest.param(turned((0.5, 0.07, 0.0)), False, id="too far"),
        pytest.param(turned((0.5, 0.1, 0.0), 15.0), False, id="turned too much"),
    ],
)
def test_a_place_given_by_name_is_where_the_world_has_it(goal, holds):
    arrived = At(thing="prism", place="goal", place_name="goal", distance=0.03, angle=radians(10))
    assert arrived.holds(Scene(prism=turned((0.5, 0.1, 0.0)), goal=goal)) is holds


@pytest.mark.parametrize(
    ("tilt", "holds"), [(0.0, True), (14.9, True), (-14.9, True), (15.1, False), (-15.1, False), (180.0, False)]
)
def test_a_tool_points_down_within_an_angle_wherever_it_is(tilt, holds):
    half = radians(tilt) / 2
    tool = Pose((1.0, 2.0, 3.0), (-sin(half), cos(half), 0.0, 0.0))  # turned further about world x than straight down
    assert PointsDown(thing="tool", angle=radians(15)).holds(Scene(tool=tool)) is holds


def test_a_turn_about_the_vertical_is_no_tilt():
    half = radians(120) / 2
    tool = Pose((0.0, 0.0, 0.0), (0.0, cos(half), sin(half), 0.0))
    assert PointsDown(thing="tool", angle=radians(1)).holds(Scene(tool=tool))


@pytest.mark.parametrize(("z", "holds"), [(-5.0, True), (0.69, True), (0.7, False)])
def test_within_is_a_box_that_may_be_open(z, holds):
    region = Within(thing="pin", low=(-0.1, -0.1, -inf), high=(0.1, 0.1, 0.69), region_name="hole")
    assert region.holds(Scene(pin=turned((0.0, 0.05, z)))) is holds
    assert not region.holds(Scene(pin=turned((0.2, 0.0, 0.0))))


def test_relations_read_like_predicates():
    assert str(CORNER) == "at(prism, corner) within 0.03 m and 10 deg"
    assert str(Not(CORNER)) == "not at(prism, corner) within 0.03 m and 10 deg"
    assert str(PointsDown(thing="tool_tip", angle=radians(15))) == "points_down(tool_tip) within 15 deg"
    assert str(Within(thing="pin", low=(0, 0, 0), high=(1, 1, 1), region_name="hole")) == "within(pin, hole)"


def test_the_first_violated_relation_is_found():
    world = Scene(prism=turned())
    assert first_violated([CORNER, Not(CORNER)], world) == Not(CORNER)
    assert first_violated([CORNER], world) is None
