"""From a valid, filled document to the frozen `Scenario`."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from hypermap_lite.errors import ScenarioError
from hypermap_lite.objectives import FeasibleOutput, Goal, Objective
from hypermap_lite.scenario.defaults import has_own_belief, is_belief
from hypermap_lite.scenario.model import (
    AcquisitionSpec,
    BudgetSpec,
    ComponentSpec,
    DesignSpec,
    EvaluatorSpec,
    ObjectivePriors,
    OutputSpec,
    ParameterSpec,
    RacingSpec,
    Scenario,
)
from hypermap_lite.scenario.sources import Layer

EVALUATOR_KEYS = ("replicates", "racing", "timeout_seconds", "workers", "max_consecutive_failures")
"""Keys of the section that are about the calls, not about the evaluator."""


def build_scenario(
    document: Mapping[str, Any], *, directory: Path, layers: tuple[Layer, ...] = (), notes: tuple[str, ...] = ()
) -> Scenario:
    """Return the scenario of a document that holds every key, as `fill_derived` returns it."""
    return Scenario(
        application_name=document["application_name"],
        description=document["description"],
        seed=document["seed"],
        parameters=tuple(_parameter(name, entry) for name, entry in document["input_parameters"].items()),
        constraints=tuple(document["constraints"]),
        joint_priors=tuple(_component(prior, f"$.priors[{i}]") for i, prior in enumerate(document["priors"])),
        objectives=tuple(_objective(entry) for entry in document["objectives"]),
        objective_priors=tuple(_objective_priors(document["objectives"])),
        design=_design(document["design_of_experiment"]),
        feasible_output=_feasible_output(document["feasible_output"]),
        budget=BudgetSpec(**document["budget"]),
        optimizer=_component(document["optimizer"], "$.optimizer"),
        surrogate=_component(document["surrogate"], "$.surrogate"),
        acquisition=_acquisition(document["acquisition"]),
        maximizer=_component(document["maximizer"], "$.maximizer"),
        evaluator=_evaluator(document["evaluator"]),
        output=_output(document["output"]),
        earlier_evaluations=document["earlier_evaluations"],
        canonical=document,
        directory=directory,
        layers=layers,
        notes=notes,
    )


def _component(section: Mapping[str, Any], path: str, *, kind: str = "type") -> ComponentSpec:
    options = {key: value for key, value in section.items() if key != kind}
    return ComponentSpec(type=section[kind], options=options, path=path)


def _parameter(name: str, entry: Mapping[str, Any]) -> ParameterSpec:
    path, values, default = f"$.input_parameters.{name}", entry["values"], entry["parameter_default"]
    if entry["parameter_type"] == "real":
        values, default = map(float, values), None if default is None else float(default)
    if isinstance(default, list):
        default = tuple(default)
    return ParameterSpec(
        name=name,
        parameter_type=entry["parameter_type"],
        values=tuple(values),
        scale=entry.get("scale", "linear"),
        kernel=entry.get("kernel", "spearman"),
        parameter_default=default,
        prior=_component(entry["prior"], f"{path}.prior") if entry["prior"] else None,
        description=entry["description"],
    )


def _objective(entry: Mapping[str, Any]) -> Objective:
    return Objective(name=entry["name"], goal=Goal(entry["goal"]), reference_point=entry["reference_point"])


def _objective_priors(entries: Sequence[Mapping[str, Any]]) -> Iterator[ObjectivePriors]:
    for i, entry in enumerate(entries):
        if has_own_belief(entry):
            path = f"$.objectives[{i}].priors"
            specs = {name: _component(prior, f"{path}.{name}") for name, prior in entry["priors"].items() if prior}
            said = {name: spec for name, spec in specs.items() if is_belief(spec.type, spec.options)}
            yield ObjectivePriors(objective=entry["name"], priors=said)


def _design(section: Mapping[str, Any]) -> DesignSpec:
    spec = _component(section, "$.design_of_experiment")
    options = {key: value for key, value in spec.options.items() if key != "number_of_samples"}
    return DesignSpec(type=spec.type, number_of_samples=section["number_of_samples"], options=options)


def _feasible_output(entry: Mapping[str, Any] | None) -> FeasibleOutput | None:
    try:
        return None if entry is None else FeasibleOutput(**entry)
    except ScenarioError as error:
        raise error.below("$.feasible_output") from None


def _acquisition(section: Mapping[str, Any]) -> AcquisitionSpec:
    path = "$.acquisition"
    inner = ("scalarization", "weights", "prior_weighting", "feasibility_weighting")
    weighting = _component(section["prior_weighting"], f"{path}.prior_weighting", kind="method")
    by_feasibility = _component(section["feasibility_weighting"], f"{path}.feasibility_weighting", kind="method")
    return AcquisitionSpec(
        function=_component({key: value for key, value in section.items() if key not in inner}, path),
        scalarization=_component(section["scalarization"], f"{path}.scalarization"),
        weights=_component(section["weights"], f"{path}.weights"),
        prior_weighting=None if weighting.type == "none" else weighting,
        feasibility_weighting=None if by_feasibility.type == "none" else by_feasibility,
    )


def _evaluator(section: Mapping[str, Any]) -> EvaluatorSpec:
    own = {key: value for key, value in section.items() if key not in EVALUATOR_KEYS}
    component = None if section["type"] == "none" else _component(own, "$.evaluator")
    keys = {key: section[key] for key in EVALUATOR_KEYS}
    if keys["racing"] is not None:
        keys["racing"] = RacingSpec(**keys["racing"])
    return EvaluatorSpec(component=component, batch=section.get("batch", False), **keys)


def _output(section: Mapping[str, Any]) -> OutputSpec:
    files = {key: section[key] and os.path.expanduser(section[key]) for key in ("samples_file", "pareto_file")}
    return OutputSpec(**{**section, **files, "directory": os.path.expanduser(section["directory"])})
