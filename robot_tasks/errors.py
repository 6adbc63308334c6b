"""Every error that `robot_tasks` raises on purpose."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping


class RobotTasksError(Exception):
    """Base class of all errors of this package."""


class UnknownNameError(RobotTasksError, LookupError):
    """Something was asked for by a name that does not exist.

    Parameters
    ----------
    kind
        What was looked up, for instance ``"site"`` or ``"task"``.
    name
        The name asked for.
    available
        The names that exist.
    """

    def __init__(self, kind: str, name: str, available: Iterable[str]) -> None:
        known = sorted(available)
        close = difflib.get_close_matches(name, known, n=1)
        hint = f" Did you mean '{close[0]}'?" if close else ""
        super().__init__(f"unknown {kind} '{name}'. Known: {', '.join(known)}.{hint}")


class ParameterError(RobotTasksError, ValueError):
    """A configuration does not fit the parameters of a task.

    Parameters
    ----------
    task
        Name of the task.
    parameter
        Name of the parameter.
    problem
        What is wrong and what was given.
    allowed
        What is allowed, as the end of a sentence.
    """

    def __init__(self, task: str, parameter: str, problem: str, allowed: str) -> None:
        super().__init__(f"task '{task}', parameter '{parameter}': {problem}. Give {allowed}.")


class GapError(RobotTasksError, ValueError):
    """A number of a reality gap has no meaning, or names something that does not exist.

    Parameters
    ----------
    key
        Name of the number.
    problem
        What is wrong and what was given.
    allowed
        What is allowed, as the end of a sentence.
    """

    def __init__(self, key: str, problem: str, allowed: str) -> None:
        super().__init__(f"reality gap, '{key}': {problem}. Give {allowed}.")


class SimulationError(RobotTasksError, RuntimeError):
    """The physics left the range in which its numbers mean anything.

    Parameters
    ----------
    time
        Simulated time in [s].
    problem
        The simulator's own words.
    """

    def __init__(self, time: float, problem: str) -> None:
        super().__init__(f"simulation at t = {time:.3f} s: {problem}. Report the configuration and the seed as a bug.")


class OptionError(RobotTasksError, ValueError):
    """An option of a picture is out of its range.

    Parameters
    ----------
    option
        Name of the option.
    given
        What was given.
    allowed
        What is allowed, as the end of a sentence.
    """

    def __init__(self, option: str, given: object, allowed: str) -> None:
        super().__init__(f"{option}: got {given}. Give {allowed}.")


class MissingPackageError(RobotTasksError, ImportError):
    """A package that only some commands need is not installed.

    Parameters
    ----------
    package
        Name of the package to install.
    """

    def __init__(self, package: str) -> None:
        super().__init__(f"the package {package} is not installed. Run: pip install 'hypermap-lite[robot]'")


class GraphicsError(RobotTasksError, RuntimeError):
    """There is no OpenGL to draw with off the screen.

    Parameters
    ----------
    problems
        What went wrong with each way to OpenGL that was tried.
    """

    def __init__(self, problems: Mapping[str, str]) -> None:
        tried = "; ".join(f"{backend}: {problem}" for backend, problem in problems.items())
        super().__init__(
            f"no off-screen OpenGL ({tried}). Install libegl1 and libgl1-mesa-dri (names of Debian and Ubuntu), or"
            " libosmesa6 and set MUJOCO_GL=osmesa. Neither needs a display or a graphics card."
        )
