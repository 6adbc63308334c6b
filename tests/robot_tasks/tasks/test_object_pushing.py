"""Tests for object_pushing.py: magnitudes of its objectives, its geometry, and how good and bad parameters fare."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from robot_tasks.evaluation import measure
from robot_tasks.geometry import TOOL_DOWN, Pose, rotation_angle
from robot_tasks.rewards import NegativeTrackingBell
from robot_tasks.rollout import rollout
from robot_tasks.tasks.object_pushing import (
    GOAL_FRAME,
    OBJECT_FRAME,
    OBJECT_PUSHING,
    OBJECT_PUSHING_PUBLISHED,
    PRISM_GOAL,
    PRISM_START,
    PRISM_YAW,
    STARTS,
    TIP_GOAL,
    TOOL_ALONG_HYPOTENUSE,
)
from tests.robot_tasks.conftest import PUSHES_INTO_THE_CORNER, PUSHES_PAST_THE_CORNER
from tests.robot_tasks.skills.scripted import context

TASK = OBJECT_PUSHING
AT_GOAL = (*PRISM_GOAL, *TOOL_DOWN)


def run(simulation, parameters, seed, task=TASK):
    return rollout(task, parameters, task.randomization.sample(np.random.default_rng(seed)), simulation)


def errors(episode):
    """Distance in [mm] and angle in [degrees] of the prism to its goal at the end."""
    *position, w, x, y, z = episode.object_poses[-1].tolist()
    goal = np.add(PRISM_GOAL, episode.shift_of("block"))
    return 1e3 * np.linalg.norm(position - goal), np.degrees(rotation_angle((w, x, y, z), TOOL_DOWN))


def world_vertices(pose):
    """Corners of the prism's upper side at a pose in world axes, shape (3, 3): frame, right angle, far corner."""
    (x, y, z), (_, c, s, _) = pose.position, pose.quaternion
    yaw = 2.0 * np.arctan2(s, c)
    turn = np.array([[np.cos(yaw), np.sin(yaw)], [np.sin(yaw), -np.cos(yaw)]])  # upside down
    corners = np.array([(0.0, 0.0), (-0.3, 0.0), (-0.3, -0.15)]) @ turn.T + (x, y)
    return np.column_stack([corners, np.full(3, z)])


def test_an_episode_spent_with_all_at_its_goal_has_the_published_value(make_episode):
    numbers = measure(TASK, make_episode([TIP_GOAL] * 121, object_poses=np.tile(AT_GOAL, (121, 1))))
    assert numbers["tip_distance"] == pytest.approx(120 * 0.458, abs=0.05)
    assert numbers["object_position"] == pytest.approx(120 * 2.747, abs=0.05)
    assert numbers["object_orientation"] == pytest.approx(120 * 0.916, abs=0.05)
    assert numbers["object_push"] == pytest.approx(120 * (0.458 + 2.747 + 0.916), abs=0.1)
    assert numbers["force"] == 0.0


def test_the_force_is_that_of_the_springs_700_newton_per_metre(make_episode):
    references = [np.add(TIP_GOAL, (0.0, -0.1, 0.0))] * 121
    episode = make_episode([TIP_GOAL] * 121, reference_positions=references, object_poses=np.tile(AT_GOAL, (121, 1)))
    assert measure(TASK, episode)["force"] == pytest.approx(-70.0 * 120)


def test_the_prism_starts_where_the_scene_has_it_and_its_goal_is_the_scenes(push_simulation):
    push_simulation.reset()
    push_simulation.place_arm(STARTS["s0"])
    assert push_simulation.pose_of("prism").position == pytest.approx(PRISM_START.position)
    assert push_simulation.pose_of("prism").quaternion == pytest.approx(PRISM_START.quaternion, abs=1e-5)
    assert push_simulation.pose_of("prism_goal").position == pytest.approx(PRISM_GOAL)
    assert push_simulation.pose_of("prism_goal").quaternion == pytest.approx(TOOL_DOWN)
    assert rotation_angle(PRISM_START.quaternion, TOOL_DOWN) == pytest.approx(PRISM_YAW)


def test_at_its_goal_the_right_angle_of_the_prism_is_in_the_corner(push_simulation):
    push_simulation.reset()
    push_simulation.place_arm(STARTS["s0"])
    model, data = push_simulation.model, push_simulation.data
    fixture, block = (push_simulation.id_of("geom", name) for name in ("fixture", "block"))
    frame, right_angle, far = world_vertices(Pose(PRISM_GOAL, TOOL_DOWN))
    assert right_angle[0] == far[0] == pytest.approx(data.geom_xpos[fixture, 0] + model.geom_size[fixture, 0])
    assert right_angle[1] == frame[1] == pytest.approx(data.geom_xpos[block, 1] + model.geom_size[block, 1])


@pytest.mark.parametrize("pose", [PRISM_START, Pose(PRISM_GOAL, TOOL_DOWN)], ids=["start", "goal"])
def test_the_prism_lies_on_the_table_at_its_start_and_its_goal(push_simulation, pose):
    push_simulation.reset()
    push_simulation.place_arm(STARTS["s0"])
    above_the_table, down = np.array([-0.2, 1.2, 1.0]), np.array([0.0, 0.0, -1.0])
    table = 1.0 - mujoco.mj_ray(
        push_simulation.model, push_simulation.data, above_the_table, down, None, True, -1, None
    )
    assert pose.position[2] - 0.07 == pytest.approx(table, abs=1e-9)


def test_the_frames_of_the_parameters_are_those_of_the_prism(push_simulation):
    TASK.randomization.nominal("s0").apply(push_simulation)
    centre = push_simulation.data.xipos[push_simulation.id_of("body", "prism")]
    frame, _, far = world_vertices(Pose(PRISM_GOAL, TOOL_DOWN))
    assert centre[:2] == pytest.approx(OBJECT_FRAME[:2], abs=5e-4)
    assert (frame + far)[:2] / 2 == pytest.approx(GOAL_FRAME[:2])
    assert (OBJECT_FRAME[2], GOAL_FRAME[2]) == (0.61, 0.6)


def test_one_side_of_the_tool_lies_along_the_hypotenuse():
    frame, _, far = world_vertices(Pose(PRISM_GOAL, TOOL_DOWN))
    _, c, s, _ = TOOL_ALONG_HYPOTENUSE
    side = np.array([c * c - s * s, 2.0 * c * s, 0.0])  # the tool's x axis
    assert np.cross(side, far - frame) == pytest.approx(np.zeros(3))


def test_offsets_are_added_to_the_frames():
    here = context((-0.5, 0.4, 0.9), prism=PRISM_START, prism_goal=Pose(PRISM_GOAL, TOOL_DOWN))
    tree = TASK.build_tree(PUSHES_INTO_THE_CORNER)
    tree.tick(here)
    assert here.goal == Pose(pytest.approx((-0.267, 0.634, 0.61)), TOOL_ALONG_HYPOTENUSE)
    here.tip = (-0.267, 0.634, 0.62)
    tree.tick(here)
    assert here.goal == Pose(pytest.approx((-0.645, 0.1, 0.6)), TOOL_ALONG_HYPOTENUSE)


@pytest.mark.parametrize("seed", range(4))
def test_a_push_through_the_middle_of_the_hypotenuse_puts_the_prism_into_the_corner(push_simulation, seed):
    episode = run(push_simulation, PUSHES_INTO_THE_CORNER, seed)
    distance, angle = errors(episode)
    assert distance < 30.0
    assert angle < 10.0
    assert episode.is_success
    assert episode.contact.touches == 0


@pytest.mark.parametrize("seed", range(4))
def test_a_push_past_the_prism_leaves_it_far_from_the_corner(push_simulation, seed):
    episode = run(push_simulation, PUSHES_PAST_THE_CORNER, seed)
    distance, angle = errors(episode)
    assert distance > 100.0
    assert angle > 20.0
    assert not episode.is_success


def test_the_prism_stays_flat_on_the_table_while_it_is_pushed(push_simulation):
    poses = run(push_simulation, PUSHES_INTO_THE_CORNER, 0).object_poses
    assert poses[:, 2] == pytest.approx(0.67, abs=1e-3)
    assert np.hypot(poses[:, 3], poses[:, 6]).max() < 0.01


def test_success_is_the_prism_being_at_its_goal_from_then_to_the_end(push_simulation):
    episode = run(push_simulation, PUSHES_INTO_THE_CORNER, 0)
    goal = np.add(PRISM_GOAL, episode.shift_of("block"))
    is_near = np.linalg.norm(episode.object_poses[:, :3] - goal, axis=1) < 0.03
    assert (is_near == (episode.times > episode.success_time - 0.01)).all()


def test_a_push_that_fails_is_worth_less(push_simulation):
    good, bad = (
        measure(TASK, run(push_simulation, parameters, 0))
        for parameters in (PUSHES_INTO_THE_CORNER, PUSHES_PAST_THE_CORNER)
    )
    assert bad["object_push"] < good["object_push"] - 100.0


def test_rewards_know_where_the_corner_is(make_episode):
    shift = (0.004, -0.003, 0.0)
    poses = np.tile((*np.add(PRISM_GOAL, shift), *TOOL_DOWN), (3, 1))
    shifted = make_episode([np.add(TIP_GOAL, shift)] * 3, object_poses=poses, shifts={"block": shift})
    nominal = make_episode([TIP_GOAL] * 3, object_poses=np.tile(AT_GOAL, (3, 1)))
    assert measure(TASK, shifted) == pytest.approx(measure(TASK, nominal))


def test_the_published_code_differs_in_placement_force_and_what_rewards_know():
    mended = replace(
        OBJECT_PUSHING_PUBLISHED,
        objectives=TASK.objectives,
        randomization=replace(OBJECT_PUSHING_PUBLISHED.randomization, objects=TASK.randomization.objects),
    )
    assert mended == TASK
    (ours,), (theirs,) = TASK.randomization.objects, OBJECT_PUSHING_PUBLISHED.randomization.objects
    assert theirs == replace(ours, sigma=0.0, sigma_yaw=0.0)


def test_the_published_rewards_follow_nothing_want_the_prism_20_millimetres_lower_and_like_force():
    tip, position, orientation = TASK.objectives["object_push"]
    blind = replace(tip, reward=replace(tip.reward, follows=None))
    lower = replace(position, reward=replace(position.reward, follows=None, goal=(-0.375, 0.075, 0.65)))
    (force,) = OBJECT_PUSHING_PUBLISHED.objectives["force"]
    assert OBJECT_PUSHING_PUBLISHED.objectives["object_push"] == (blind, lower, orientation)
    assert (force.reward, force.weight) == (NegativeTrackingBell(width=0.4, offset=0.25), 1.0)


def test_the_published_force_objective_prefers_to_pull_away_from_the_reference(make_episode):
    poses = np.tile(AT_GOAL, (3, 1))
    near, far = (
        make_episode([TIP_GOAL] * 3, reference_positions=[np.add(TIP_GOAL, (0.0, 0.0, e))] * 3, object_poses=poses)
        for e in (0.01, 0.1)
    )
    assert measure(TASK, near)["force"] > measure(TASK, far)["force"]
    published_near, published_far = (measure(OBJECT_PUSHING_PUBLISHED, e)["force"] for e in (near, far))
    assert published_near < published_far
