"""Peg insertion: find a hole that is not quite where it is believed to be, and press the peg into it, gently."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Final

from robot_tasks.geometry import TOOL_DOWN, Pose, Vector
from robot_tasks.motion.spiral import ArchimedesSpiral, SteppedSpiral
from robot_tasks.randomization import BodyShift, Randomization
from robot_tasks.rewards import Box, BoxAttraction, CommandedForce, FixedSuccess, GoalDistance, RewardTerm
from robot_tasks.skills import Behaviour
from robot_tasks.skills.library import insert_peg
from robot_tasks.tasks.base import Parameter, Task

GOAL: Final[Vector] = (-0.6, 0.0, 0.653)
"""Position in [m] of the inserted tip: the middle of the block."""
SUCCESS_DISTANCE: Final = 0.04
"""Distance of the tip to the goal in [m] that counts as inserted: 10 mm below the rim at z = 0.703."""
MOUTH: Final[Vector] = (-0.6, 0.0, 0.7)
"""Position in [m] that the reward pulls to: just below the rim."""
HOLE: Final = Box(low=(-0.601, -0.001, 0.6), high=(-0.599, 0.001, 0.699))
"""A thin column along the axis of the hole, in [m]."""

STARTS: Final = {
    "s0": (0.67, 0.28, -0.27, -1.40, 1.10, 1.49, -0.58),
    "s1": (0.70, 0.20, -0.27, -1.46, 1.09, 1.47, -0.56),
    "s2": (0.56, 0.08, -0.15, -1.72, 1.07, 1.41, -0.69),
    "s3": (0.50, 0.17, -0.15, -1.72, 1.09, 1.42, -0.80),
    "s4": (0.52, 0.26, -0.15, -1.55, 1.09, 1.44, -0.72),
}
"""Joint angles in [rad] with the tool straight down, 0.3 m above the block and up to 86 mm beside the hole."""


def build_tree(
    parameters: Mapping[str, float], spiral: Callable[..., ArchimedesSpiral] = ArchimedesSpiral
) -> Behaviour:
    """Build the skill from its four parameters, with a kind of spiral."""
    return insert_peg(
        Pose(GOAL, TOOL_DOWN),
        force=parameters["Force"],
        search=spiral(pitch=parameters["PathDistance"], speed=parameters["PathVelocity"], radius=parameters["Radius"]),
        success_distance=SUCCESS_DISTANCE,
    )


def _task(*, build: Callable[[Mapping[str, float]], Behaviour], sigma: float, follows: str | None) -> Task:
    return Task(
        name="peg_insertion",
        description="Find a hole on a spiral and insert a peg with 1.5 mm of radial clearance.",
        scene="peg_insertion.xml",
        duration=18.0,
        parameters=(
            Parameter(name="PathVelocity", low=0.0, high=0.3, unit="m/s", description="Speed along the spiral"),
            Parameter(name="PathDistance", low=0.0, high=0.03, unit="m", description="Pitch of the spiral"),
            Parameter(name="Radius", low=0.0, high=0.08, unit="m", description="Largest radius of the spiral"),
            Parameter(name="Force", low=-20.0, high=-1.0, unit="N", description="Vertical force while searching"),
        ),
        build_tree=build,
        objectives={
            "insertion_reward": (
                RewardTerm(name="success_bonus", reward=FixedSuccess(value=8.0)),
                RewardTerm(
                    name="goal_distance",
                    reward=GoalDistance(goal=MOUTH, width=0.4, offset=0.25, follows=follows),
                    weight=50.0,
                ),
                RewardTerm(
                    name="hole_distance",
                    reward=BoxAttraction(box=HOLE, width=2.0, margin=0.006, follows=follows),
                    weight=0.15,
                ),
            ),
            "force": (RewardTerm(name="commanded_force", reward=CommandedForce(), weight=10.0),),
        },
        randomization=Randomization(starts=STARTS, shifts=(BodyShift(bodies=("block",), sigma=sigma),)),
    )


PEG_INSERTION: Final = _task(build=build_tree, sigma=0.007, follows="block")
"""The paper's task: rewards know where the hole is."""
PEG_INSERTION_PUBLISHED: Final = _task(build=partial(build_tree, spiral=SteppedSpiral), sigma=0.008, follows=None)
"""The published code's: a coarse spiral, a hole shifted a little more, and rewards computed at its nominal place."""
