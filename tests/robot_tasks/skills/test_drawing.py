"""Tests for drawing.py: trees and descriptions with a known text."""

import pytest

from robot_tasks.geometry import TOOL_DOWN, Pose
from robot_tasks.skills import CoordinateBelow, NoFail, Serial, SetGoalPose, Skill, SkillDescription
from robot_tasks.skills.drawing import describe, draw, skills_in
from robot_tasks.skills.library import pass_over_obstacle
from robot_tasks.tasks import TASKS

PASS_OVER_OBSTACLE = """\
Skill pass_over_obstacle
└─ ParallelFs
   ├─ Selector
   │  ├─ Serial
   │  │  ├─ CoordinateBelow y, 0.05 m
   │  │  └─ SetGoalPose (-0.6, 0, 0.7)
   │  ├─ Serial
   │  │  ├─ CoordinateAtLeast z, 0.95 m
   │  │  └─ SetGoalPose (-0.5, 0, 1)
   │  └─ SetGoalPose (-0.5, 0.7, 1.1)
   └─ PositionDistance to (-0.6, 0, 0.7) < 0.05 m"""

DESCRIPTION = """\
pass_over_obstacle: Move over an obstacle through two way-points.
  parameters
    first             Pose      learned   Way-point to rise to
    second            Pose      learned   Way-point beyond the obstacle
    clear_height      float  m  learned   Height from which to cross
    passed_y          float  m  learned   World y below which to descend
    goal              Pose      required  Where the tip is to arrive
    success_distance  float  m  optional  How near is near enough
  pre-conditions, at the start
    not at(tool_tip, goal) within 0.05 m
  post-conditions, on success
    at(tool_tip, goal) within 0.05 m"""


@pytest.fixture
def skill():
    first, second, goal = ((-0.5, 0.7, 1.1), (-0.5, 0.0, 1.0), (-0.6, 0.0, 0.7))
    poses = (Pose(position, TOOL_DOWN) for position in (first, second, goal))
    return pass_over_obstacle(*poses, clear_height=0.95, passed_y=0.05, success_distance=0.05)


def test_a_tree_is_drawn_with_one_line_per_node_in_the_order_of_ticks(skill):
    assert draw(skill) == PASS_OVER_OBSTACLE


def test_a_leaf_is_its_label():
    assert draw(CoordinateBelow("y", 0.05)) == "CoordinateBelow y, 0.05 m"


def test_a_skill_is_described_by_its_typed_parameters_and_the_conditions_it_has(skill):
    assert "\n".join(describe(skill.description)) == DESCRIPTION


def test_a_description_may_be_bare():
    assert describe(SkillDescription(name="wait", description="Wait.", parameters=())) == ["wait: Wait."]


def test_skills_are_found_at_any_depth_from_the_root_downwards():
    def named(name, body):
        return Skill(SkillDescription(name=name, description="", parameters=()), body)

    inner = named("inner", SetGoalPose(Pose((0.0, 0.0, 0.0), TOOL_DOWN)))
    tree = named("outer", Serial(CoordinateBelow("z", 1.0), NoFail(inner)))
    assert [skill.description.name for skill in skills_in(tree)] == ["outer", "inner"]


@pytest.mark.parametrize("task", TASKS.values(), ids=TASKS)
def test_every_task_fits_a_terminal_of_110_columns(task):
    tree = task.build_tree({parameter.name: parameter.low for parameter in task.parameters})
    descriptions = [line for skill in skills_in(tree) for line in describe(skill.description)]
    assert max(len(line) for line in [*draw(tree).splitlines(), *descriptions]) <= 110
