"""The black box: how it is called, what it answers, and the loop that drives it."""

from collections.abc import Mapping
from typing import Final, TypeAlias

from hypermap_lite.evaluation.client_server import ClientServer
from hypermap_lite.evaluation.command import Command
from hypermap_lite.evaluation.exhaustive import Exhaustive
from hypermap_lite.evaluation.python_function import PythonFunction

AnyEvaluator: TypeAlias = PythonFunction | Command | ClientServer | Exhaustive

EVALUATORS: Final[Mapping[str, type[AnyEvaluator]]] = {
    "python": PythonFunction,
    "command": Command,
    "client_server": ClientServer,
    "exhaustive": Exhaustive,
}
"""JSON name of each kind of black box."""

__all__ = ["EVALUATORS", "AnyEvaluator", "ClientServer", "Command", "Exhaustive", "PythonFunction"]
