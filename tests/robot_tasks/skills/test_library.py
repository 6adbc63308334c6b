"""Tests for library.py: what each skill demands of a scripted robot, tick by tick."""

from inspect import Parameter, signature
from math import cos, radians, sin

import pytest

from robot_tasks.geometry import TOOL_DOWN, Pose
from robot_tasks.motion import ArchimedesSpiral
from robot_tasks.skills import ParameterKind, Status
from robot_tasks.skills.library import insert_peg, pass_over_obstacle, push_object
from tests.robot_tasks.skills.scripted import context

FIRST = Pose((-0.5, 0.7, 1.1), TOOL_DOWN)
SECOND = Pose((-0.5, 0.0, 1.0), TOOL_DOWN)
GOAL = Pose((-0.6, 0.0, 0.7), TOOL_DOWN)

DEFAULT_STIFFNESS = (400.0, 400.0, 400.0, 50.0)
NO_FORCE = (0.0, 0.0, 0.0)


def move_to(here, tip, quaternion=TOOL_DOWN):
    """Let the robot have moved since the last tick, whose demands are forgotten."""
    here.tip = tip
    here.world["tool_tip"] = Pose(tip, quaternion)
    here.forget_demands()


@pytest.fixture
def tree():
    return pass_over_obstacle(FIRST, SECOND, GOAL, clear_height=0.95, passed_y=0.05, success_distance=0.05)


@pytest.mark.parametrize(
    ("tip", "goal"),
    [
        pytest.param((-0.5, 0.6, 0.75), FIRST, id="low and before the obstacle: rise"),
        pytest.param((-0.5, 0.6, 0.95), SECOND, id="high enough: cross"),
        pytest.param((-0.5, 0.04, 1.0), GOAL, id="past the obstacle: descend"),
        pytest.param((-0.5, 0.04, 0.75), GOAL, id="past the obstacle and low: descend all the same"),
    ],
)
def test_the_position_of_the_tip_chooses_the_goal(tree, tip, goal):
    here = context(tip)
    assert tree.tick(here) is Status.RUNNING
    assert here.goal is goal


def test_the_choice_follows_the_tip_back_and_forth(tree):
    here = context((-0.5, 0.6, 0.9))
    goals = []
    for z in (0.9, 1.0, 0.9):
        move_to(here, (-0.5, 0.6, z))
        tree.tick(here)
        goals.append(here.goal)
    assert goals == [FIRST, SECOND, FIRST]


def test_the_skill_succeeds_near_the_goal(tree):
    assert tree.tick(context((-0.5, 0.6, 0.75))) is Status.RUNNING
    assert tree.tick(context((-0.6, 0.0, 0.749))) is Status.SUCCESS


def test_the_skill_refuses_to_start_at_its_goal(tree):
    assert tree.tick(context((-0.6, 0.0, 0.749))) is Status.FAILURE
    assert str(tree.violated) == "not at(tool_tip, goal) within 0.05 m"


INSERTED = Pose((-0.6, 0.0, 0.653), TOOL_DOWN)
SPIRAL = ArchimedesSpiral(pitch=0.005, speed=0.05, radius=0.012)


@pytest.fixture
def insertion():
    return insert_peg(INSERTED, force=-7.0, search=SPIRAL, success_distance=0.04)


@pytest.mark.parametrize("z", [1.0, 0.75, 0.694])
def test_a_search_presses_by_force_alone_and_overlays_the_spiral_at_every_height(insertion, z):
    here = context((-0.6, 0.01, z))
    for _ in range(3):
        move_to(here, (-0.6, 0.01, z))
        assert insertion.tick(here) is Status.RUNNING
        assert here.goal is INSERTED
        assert here.stiffness == (500.0, 500.0, 0.0, 50.0)
        assert here.force == (0.0, 0.0, -7.0)
        assert here.overlay is SPIRAL


def test_an_insertion_succeeds_within_40_millimetres_of_its_goal_and_halts_its_demands(insertion):
    here = context((-0.6, 0.0, 0.75))
    assert insertion.tick(here) is Status.RUNNING
    move_to(here, (-0.6, 0.0, 0.6931))
    assert insertion.tick(here) is Status.RUNNING
    move_to(here, (-0.6, 0.0, 0.6929))
    assert insertion.tick(here) is Status.SUCCESS
    assert {child.status for child in insertion.children[0].children} == {Status.IDLE, Status.SUCCESS}


def test_an_insertion_beside_the_hole_needs_the_distance_in_space(insertion):
    here = context((-0.6, 0.0, 0.75))
    insertion.tick(here)
    move_to(here, (-0.6, 0.03, 0.68))  # 40.4 mm from the goal
    assert insertion.tick(here) is Status.RUNNING


def test_an_insertion_refuses_to_start_in_the_hole(insertion):
    here = context((-0.6, 0.0, 0.68))
    assert insertion.tick(here) is Status.FAILURE
    assert str(insertion.violated) == "not at(tool_tip, hole) within 0.04 m"
    assert (here.stiffness, here.force, here.overlay) == (DEFAULT_STIFFNESS, NO_FORCE, None)


@pytest.mark.parametrize(("tilt", "status"), [(14.0, Status.RUNNING), (16.0, Status.FAILURE)])
def test_an_insertion_fails_when_the_peg_tilts(insertion, tilt, status):
    here = context((-0.6, 0.0, 0.75))
    insertion.tick(here)
    half = radians(tilt) / 2
    move_to(here, (-0.6, 0.0, 0.7), (-sin(half), cos(half), 0.0, 0.0))
    assert insertion.tick(here) is status


def test_the_tilt_is_named_as_the_reason_of_the_failure(insertion):
    here = context((-0.6, 0.0, 0.75))
    here.world["tool_tip"] = Pose((-0.6, 0.0, 0.75), (1.0, 0.0, 0.0, 0.0))
    assert insertion.tick(here) is Status.FAILURE
    assert str(insertion.violated) == "points_down(tool_tip) within 15 deg"


@pytest.mark.parametrize("tip", [(-0.6, 0.25, 0.9), (-0.9, 0.0, 0.9), (-0.6, 0.09, 0.6)])
def test_an_insertion_starts_only_above_the_hole(insertion, tip):
    assert insertion.tick(context(tip)) is Status.FAILURE
    assert str(insertion.violated) == "within(tool_tip, above hole)"


BESIDE = Pose((-0.27, 0.63, 0.61), TOOL_DOWN)
CORNER = Pose((-0.65, 0.01, 0.6), TOOL_DOWN)
PRISM_AT_START = Pose((-0.2, 0.35, 0.67), TOOL_DOWN)
PRISM_GOAL = Pose((-0.375, 0.075, 0.67), TOOL_DOWN)
PUSH_STIFFNESS = (700.0, 700.0, 700.0, 50.0)


@pytest.fixture
def push():
    return push_object(BESIDE, CORNER, thing="prism", goal_site="prism_goal", arrival_distance=0.05)


@pytest.fixture
def here():
    return context((-0.5, 0.4, 0.9), prism=PRISM_AT_START, prism_goal=PRISM_GOAL)


def test_a_push_begins_with_an_approach_without_force(push, here):
    for tip in ((-0.5, 0.4, 0.9), (-0.3, 0.6, 0.7), (-0.27, 0.63, 0.661)):
        move_to(here, tip)
        assert push.tick(here) is Status.RUNNING
        assert here.goal is BESIDE
        assert (here.stiffness, here.force, here.overlay) == (PUSH_STIFFNESS, NO_FORCE, None)


def test_within_5_centimetres_of_its_start_the_push_heads_for_its_goal_pressing_down(push, here):
    push.tick(here)
    move_to(here, (-0.27, 0.63, 0.6599))
    assert push.tick(here) is Status.RUNNING
    assert here.goal is CORNER
    assert (here.stiffness, here.force, here.overlay) == (PUSH_STIFFNESS, (0.0, 0.0, -7.0), None)


@pytest.mark.parametrize("tip", [(-0.5, 0.4, 0.9), (-0.27, 0.63, 0.62)], ids=["far away", "at the start of the push"])
def test_a_push_never_goes_back_to_its_approach(push, here, tip):
    for visited in ((-0.5, 0.4, 0.9), (-0.27, 0.63, 0.62), tip):
        move_to(here, visited)
        push.tick(here)
    assert here.goal is CORNER
    assert here.force == (0.0, 0.0, -7.0)


@pytest.mark.parametrize(
    ("prism", "status", "violated"),
    [
        pytest.param(PRISM_GOAL, Status.SUCCESS, "None", id="arrived"),
        pytest.param(Pose((-0.35, 0.075, 0.67), TOOL_DOWN), Status.SUCCESS, "None", id="nearly arrived"),
        pytest.param(
            PRISM_AT_START, Status.FAILURE, "at(prism, prism_goal) within 0.03 m and 10 deg", id="left behind"
        ),
        pytest.param(
            Pose((-0.375, 0.075, 0.67), (0.0, cos(radians(6)), sin(radians(6)), 0.0)),
            Status.FAILURE,
            "at(prism, prism_goal) within 0.03 m and 10 deg",
            id="turned by 12 degrees",
        ),
    ],
)
def test_a_push_that_arrives_succeeds_only_with_its_object_at_the_goal(push, here, prism, status, violated):
    for visited in ((-0.5, 0.4, 0.9), (-0.27, 0.63, 0.62), (-0.45, 0.3, 0.6)):
        move_to(here, visited)
        assert push.tick(here) is Status.RUNNING
    move_to(here, (-0.65, 0.01, 0.649))
    here.world["prism"] = prism
    assert push.tick(here) is status
    assert str(push.violated) == violated


def test_a_push_goes_on_while_the_tool_is_not_at_its_goal_even_if_the_object_is(push, here):
    for visited in ((-0.5, 0.4, 0.9), (-0.27, 0.63, 0.62), (-0.6, 0.05, 0.651)):
        move_to(here, visited)
        assert push.tick(here) is Status.RUNNING
        here.world["prism"] = PRISM_GOAL


def test_a_push_refuses_to_start_with_its_object_at_the_goal(push, here):
    here.world["prism"] = PRISM_GOAL
    assert push.tick(here) is Status.FAILURE
    assert str(push.violated) == "not at(prism, prism_goal) within 0.03 m and 10 deg"


@pytest.mark.parametrize(
    ("build", "skill"),
    [
        pytest.param(
            pass_over_obstacle, pass_over_obstacle(FIRST, SECOND, GOAL, clear_height=1, passed_y=0), id="pass"
        ),
        pytest.param(insert_peg, insert_peg(GOAL, force=-3.0, search=SPIRAL), id="insert"),
        pytest.param(push_object, push_object(FIRST, GOAL, thing="prism", goal_site="goal"), id="push"),
    ],
)
def test_a_skill_declares_what_it_is_told_and_only_optional_parameters_have_a_default(build, skill):
    told = signature(build).parameters
    declared = {parameter.name: parameter for parameter in skill.description.parameters}
    assert set(declared) == set(told)
    for name, parameter in declared.items():
        has_default = told[name].default is not Parameter.empty
        assert has_default == (parameter.kind is ParameterKind.OPTIONAL)
        assert told[name].annotation == parameter.value_type.__name__
