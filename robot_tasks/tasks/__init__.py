"""Tasks: a scene, a skill with parameters to tune, and objectives.

Adding one: a file with a `Task`, its scene in `models`, a line in the table below, from which tests pick it up.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

from robot_tasks.reality_gap import read_gaps
from robot_tasks.tasks.base import Parameter, Task
from robot_tasks.tasks.object_pushing import OBJECT_PUSHING, OBJECT_PUSHING_PUBLISHED
from robot_tasks.tasks.obstacle_avoidance import OBSTACLE_AVOIDANCE, OBSTACLE_AVOIDANCE_PUBLISHED
from robot_tasks.tasks.peg_insertion import PEG_INSERTION, PEG_INSERTION_PUBLISHED

TASKS: Final[Mapping[str, Task]] = {task.name: task for task in (PEG_INSERTION, OBJECT_PUSHING, OBSTACLE_AVOIDANCE)}
"""The tasks as the paper means them."""

PUBLISHED: Final[Mapping[str, Task]] = {
    task.name: task for task in (PEG_INSERTION_PUBLISHED, OBJECT_PUSHING_PUBLISHED, OBSTACLE_AVOIDANCE_PUBLISHED)
}
"""The same tasks with the choices of the published code, where these differ and change an objective."""

STAND_INS: Final[Mapping[str, Task]] = {
    name: replace(TASKS[name], gap=gap, randomization=replace(TASKS[name].randomization, shifts=()))
    for name, gap in read_gaps(TASKS).items()
}
"""Stand-ins for the real robot: the same tasks across a reality gap.

Nothing is shifted at random. Every body stands off by the gap's offset, of which rewards know as little as skills.
"""

__all__ = ["PUBLISHED", "STAND_INS", "TASKS", "Parameter", "Task"]
