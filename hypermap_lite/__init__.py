"""Multi-objective Bayesian optimization with user priors, driven by one scenario file."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hypermap_lite.ask_tell import Optimizer
    from hypermap_lite.evaluation.outcome import Evaluation, State
    from hypermap_lite.history.rows import read_history
    from hypermap_lite.pareto import hypervolume, non_dominated
    from hypermap_lite.result import Result
    from hypermap_lite.run import optimize
    from hypermap_lite.scenario import load_scenario

__version__ = "0.1.0"

__all__ = [
    "Evaluation",
    "Optimizer",
    "Result",
    "State",
    "__version__",
    "hypervolume",
    "load_scenario",
    "non_dominated",
    "optimize",
    "read_history",
]

_HOMES = {
    "Evaluation": "hypermap_lite.evaluation.outcome",
    "Optimizer": "hypermap_lite.ask_tell",
    "Result": "hypermap_lite.result",
    "State": "hypermap_lite.evaluation.outcome",
    "hypervolume": "hypermap_lite.pareto.hypervolume",
    "load_scenario": "hypermap_lite.scenario",
    "non_dominated": "hypermap_lite.pareto.dominance",
    "optimize": "hypermap_lite.run",
    "read_history": "hypermap_lite.history.rows",
}
"""Module of each public name, imported when the name is first used: the command line must start fast."""


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
