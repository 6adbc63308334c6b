"""The scenario file: from JSON to one frozen `Scenario`, or one clear error."""

from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.scenario.model import (
    AcquisitionSpec,
    BudgetSpec,
    ComponentSpec,
    DesignSpec,
    EvaluatorSpec,
    OutputSpec,
    ParameterSpec,
    Scenario,
)

__all__ = [
    "AcquisitionSpec",
    "BudgetSpec",
    "ComponentSpec",
    "DesignSpec",
    "EvaluatorSpec",
    "OutputSpec",
    "ParameterSpec",
    "Scenario",
    "load_scenario",
]
