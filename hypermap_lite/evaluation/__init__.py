"""The black box: how it is called, what it answers, and the loop that drives it."""

from collections.abc import Mapping
from typing import Final

from hypermap_lite.evaluation.command import Command
from hypermap_lite.evaluation.python_function import PythonFunction

EVALUATORS: Final[Mapping[str, type[PythonFunction] | type[Command]]] = {
    "python": PythonFunction,
    "command": Command,
}
"""JSON name of each kind of black box."""

__all__ = ["EVALUATORS", "Command", "PythonFunction"]
