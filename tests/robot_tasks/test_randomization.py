"""Tests for randomization.py."""

from collections import Counter
from math import cos, sin

import numpy as np
import pytest

from robot_tasks.geometry import TOOL_DOWN, Pose, rotation_angle
from robot_tasks.randomization import BodyShift, ObjectPlacement, Randomization

STARTS = {"a": (0.0,) * 7, "b": (0.1,) * 7, "c": (0.2,) * 7}
ENGINE = BodyShift(bodies=("engine",), sigma=0.02)
PRISM = ObjectPlacement(body="prism", pose=Pose((-0.2, 0.35, 0.67), TOOL_DOWN), sigma=0.007, sigma_yaw=0.01)


def test_offsets_are_clipped_at_one_sigma_and_a_third_sits_on_each_axis_bound():
    rng = np.random.default_rng(0)
    offsets = np.array([ENGINE.sample(rng)["engine"] for _ in range(4000)])
    assert np.abs(offsets[:, :2]).max() == 0.02
    assert (offsets[:, 2] == 0.0).all()
    assert np.mean(np.abs(offsets[:, 0]) == 0.02) == pytest.approx(0.317, abs=0.03)


def test_bodies_of_one_shift_move_together_and_those_of_another_on_their_own():
    corner = BodyShift(bodies=("block", "fixture"), sigma=0.007)
    shifts = Randomization(starts=STARTS, shifts=(corner, ENGINE)).sample(np.random.default_rng(3)).shifts
    assert list(shifts) == ["block", "fixture", "engine"]
    assert shifts["block"] == shifts["fixture"] != shifts["engine"]


def test_start_states_are_equally_likely():
    rng = np.random.default_rng(1)
    counts = Counter(Randomization(starts=STARTS).sample(rng).start for _ in range(3000))
    assert [counts[start] / 3000 for start in STARTS.values()] == pytest.approx([1 / 3] * 3, abs=0.04)


def test_objects_stay_on_their_height_and_within_one_sigma():
    rng = np.random.default_rng(2)
    poses = [PRISM.sample(rng) for _ in range(1000)]
    offsets = np.array([pose.position for pose in poses]) - PRISM.pose.position
    assert np.abs(offsets).max(axis=0) == pytest.approx([0.007, 0.007, 0.0])
    angles = [rotation_angle(pose.quaternion, TOOL_DOWN) for pose in poses]
    assert max(angles) == pytest.approx(0.01)


def test_an_object_turns_about_the_vertical():
    _, (w, x, y, z) = PRISM.sample(np.random.default_rng(2))
    half = np.arctan2(y, x)  # of a thing that is upside down
    assert 0.0 < abs(half) <= 0.005
    assert (w, x, y, z) == pytest.approx((0.0, cos(half), sin(half), 0.0))


def test_an_object_without_spread_is_at_its_nominal_pose():
    exact = ObjectPlacement(body="prism", pose=PRISM.pose, sigma=0.0, sigma_yaw=0.0)
    assert exact.sample(np.random.default_rng(0)) == PRISM.pose


def test_equal_seeds_give_equal_variations():
    randomization = Randomization(starts=STARTS, shifts=(ENGINE,), objects=(PRISM,))
    first, second = (randomization.sample(np.random.default_rng(7)) for _ in range(2))
    assert first == second


def test_objects_take_no_luck_from_starts_and_shifts():
    with_object, without = (Randomization(starts=STARTS, shifts=(ENGINE,), objects=o) for o in ((PRISM,), ()))
    first, second = (randomization.sample(np.random.default_rng(7)) for randomization in (with_object, without))
    assert (first.start, first.shifts) == (second.start, second.shifts)


def test_applying_a_variation_moves_bodies_from_their_nominal_place_each_time(simulation):
    randomization = Randomization(starts=STARTS, shifts=(ENGINE,))
    variation = randomization.sample(np.random.default_rng(7))
    nominal = np.array([-0.52, 0.3, 0.751])
    engine = simulation.id_of("body", "engine")
    for _ in range(2):
        variation.apply(simulation)
        assert simulation.data.xpos[engine] == pytest.approx(nominal + variation.shifts["engine"])
    randomization.nominal("b").apply(simulation)
    assert simulation.data.xpos[engine] == pytest.approx(nominal)
    assert simulation.data.qpos == pytest.approx(STARTS["b"])


def test_applying_a_variation_puts_objects_at_rest_at_their_poses(push_simulation):
    randomization = Randomization(starts=STARTS, objects=(PRISM,))
    variation = randomization.sample(np.random.default_rng(7))
    variation.apply(push_simulation)
    assert np.concatenate(push_simulation.pose_of("prism")) == pytest.approx(np.concatenate(variation.objects["prism"]))
    assert not push_simulation.data.qvel.any()
    randomization.nominal("a").apply(push_simulation)
    assert np.concatenate(push_simulation.pose_of("prism")) == pytest.approx(np.concatenate(PRISM.pose))
