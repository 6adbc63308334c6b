"""Tasks: a scene, a skill with parameters to tune, and objectives.

Adding one: a file with a `Task`, its scene in `models`, a line in the table below, from which tests pick it up.
"""

from collections.abc import Mapping
from typing import Final

from robot_tasks.tasks.base import Parameter, Task
from robot_tasks.tasks.obstacle_avoidance import OBSTACLE_AVOIDANCE

TASKS: Final[Mapping[str, Task]] = {task.name: task for task in (OBSTACLE_AVOIDANCE,)}
"""The tasks as the paper means them."""

PUBLISHED: Final[Mapping[str, Task]] = {**TASKS}
"""The same tasks with the choices of the published code, where these differ and change an objective."""

__all__ = ["PUBLISHED", "TASKS", "Parameter", "Task"]
