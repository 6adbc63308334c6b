"""Robot skills to tune: MuJoCo rollouts of behaviour trees under Cartesian impedance control.

The functions here are evaluators: called with a configuration and a seed, they run one rollout and return numbers.
Each task has three: as the paper means it, as its published code computes it, and on a stand-in for the real robot.
Importing the package is cheap; MuJoCo is loaded at the first call.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

__all__ = [
    "RolloutFunction",
    "object_pushing",
    "object_pushing_as_published_code",
    "object_pushing_real",
    "obstacle_avoidance",
    "obstacle_avoidance_as_published_code",
    "obstacle_avoidance_real",
    "peg_insertion",
    "peg_insertion_as_published_code",
    "peg_insertion_real",
]


@dataclass(frozen=True, slots=True)
class RolloutFunction:
    """One rollout of a task as a function of its parameters and a seed; see `docs/robot_tasks.md`."""

    task: str
    """Name of the task."""
    variant: str = "paper"
    """One of `robot_tasks.evaluation.VARIANTS`."""

    def __call__(self, configuration: Mapping[str, float], seed: int = 0) -> Mapping[str, float]:
        """Run one rollout and measure it.

        Parameters
        ----------
        configuration
            Value of every parameter of the task; ``python -m robot_tasks show TASK`` lists them with bounds and units.
        seed
            Chooses the start state of the arm and where exactly things stand.

        Returns
        -------
        Mapping
            The task's objectives, both to be maximized, and further numbers; see `robot_tasks.evaluation.summarize`.

        Raises
        ------
        robot_tasks.errors.ParameterError
            If a parameter is missing, unknown, not finite or out of bounds.
        robot_tasks.errors.SimulationError
            If the physics broke down; the rollout has no score.
        """
        from robot_tasks.evaluation import evaluate

        return evaluate(self.task, configuration, seed, variant=self.variant)


peg_insertion: Final = RolloutFunction("peg_insertion")
peg_insertion_as_published_code: Final = RolloutFunction("peg_insertion", "published_code")
peg_insertion_real: Final = RolloutFunction("peg_insertion", "real")

object_pushing: Final = RolloutFunction("object_pushing")
object_pushing_as_published_code: Final = RolloutFunction("object_pushing", "published_code")
object_pushing_real: Final = RolloutFunction("object_pushing", "real")

obstacle_avoidance: Final = RolloutFunction("obstacle_avoidance")
obstacle_avoidance_as_published_code: Final = RolloutFunction("obstacle_avoidance", "published_code")
obstacle_avoidance_real: Final = RolloutFunction("obstacle_avoidance", "real")

_SUFFIXES: Final = {"_as_published_code": "published_code", "_real": "real"}


def __getattr__(name: str) -> RolloutFunction:
    """Make the function of a task that has no name above, such as one you have just added to the table."""
    from robot_tasks.evaluation import VARIANTS

    suffix = next((suffix for suffix in _SUFFIXES if name.endswith(suffix)), "")
    task, variant = name.removesuffix(suffix), _SUFFIXES.get(suffix, "paper")
    if task not in VARIANTS[variant]:
        raise AttributeError(f"module 'robot_tasks' has no attribute '{name}'")
    return RolloutFunction(task, variant)
