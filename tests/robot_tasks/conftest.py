"""Fixtures of the robot tests: one simulation per scene, hand-made episodes, good and bad parameters."""

from collections.abc import Callable

import numpy as np
import pytest

from robot_tasks.episode import Episode
from robot_tasks.simulation import Simulation

OPERATOR_MEANS = {
    "mp1_position_y": 0.7,
    "mp1_position_z": 1.1,
    "mp2_position_y": 0.0,
    "mp2_position_z": 1.0,
    "mp2_threshold": 0.95,
    "mp3_threshold": 0.05,
}
STRAIGHT_THROUGH_THE_ENGINE = OPERATOR_MEANS | {"mp3_threshold": 1.5}
LOWERED_ONTO_THE_ENGINE = OPERATOR_MEANS | {"mp1_position_z": 0.5, "mp3_threshold": -0.5}

SEARCHES_FOR_THE_HOLE = {"PathVelocity": 0.05, "PathDistance": 0.005, "Radius": 0.012, "Force": -7.0}
STANDS_ON_THE_BLOCK = SEARCHES_FOR_THE_HOLE | {"PathVelocity": 0.0}

PUSHES_INTO_THE_CORNER = {
    "offset_x_start": 0.09,
    "offset_y_start": 0.15,
    "offset_x_goal": -0.12,
    "offset_y_goal": -0.05,
}
PUSHES_PAST_THE_CORNER = {
    "offset_x_start": 0.03,
    "offset_y_start": 0.25,
    "offset_x_goal": -0.25,
    "offset_y_goal": -0.03,
}

GOOD_PARAMETERS = {
    "peg_insertion": SEARCHES_FOR_THE_HOLE,
    "object_pushing": PUSHES_INTO_THE_CORNER,
    "obstacle_avoidance": OPERATOR_MEANS,
}


@pytest.fixture(scope="session")
def simulation() -> Simulation:
    return Simulation.from_scene("obstacle_avoidance.xml")


@pytest.fixture(scope="session")
def peg_simulation() -> Simulation:
    return Simulation.from_scene("peg_insertion.xml")


@pytest.fixture(scope="session")
def push_simulation() -> Simulation:
    return Simulation.from_scene("object_pushing.xml")


@pytest.fixture
def make_episode() -> Callable[..., Episode]:
    def make(tip_positions, *, success_time=None, commanded_forces=None, reference_positions=None, **fields) -> Episode:
        tips = np.asarray(tip_positions, dtype=float)
        n = len(tips)
        return Episode(
            times=np.arange(n) * 0.1,
            tip_positions=tips,
            reference_positions=tips if reference_positions is None else np.asarray(reference_positions),
            joint_positions=np.zeros((n, 7)),
            commanded_forces=np.zeros((n, 3)) if commanded_forces is None else np.asarray(commanded_forces),
            success_time=success_time,
            simulated_seconds=(n - 1) * 0.1,
            **fields,
        )

    return make
