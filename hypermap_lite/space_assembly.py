"""The part of the composition root that makes the search space."""

from __future__ import annotations

from typing import Any

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.scenario.model import ParameterSpec, Scenario
from hypermap_lite.space import PARAMETERS, Constraint, Parameter, SearchSpace
from hypermap_lite.space.search_space import MAX_DRAWS
from hypermap_lite.typing import Configuration


def build_parameter(spec: ParameterSpec) -> Parameter:
    """Make one parameter.

    Raises
    ------
    ScenarioError
        If its type is unknown, its values make no range, or its default is not one of them.
    """
    path = f"$.input_parameters.{spec.name}"
    if spec.parameter_type not in PARAMETERS:
        known, hint = ", ".join(PARAMETERS), nearest(spec.parameter_type, PARAMETERS)
        raise ScenarioError(f"{path}.parameter_type", f"unknown type {spec.parameter_type!r}", allowed=known, hint=hint)
    options: dict[str, Any] = {"name": spec.name, "default": spec.parameter_default}
    if spec.parameter_type in ("real", "integer"):
        options |= {"low": spec.values[0], "high": spec.values[1], "log": spec.scale == "log"}
    elif spec.parameter_type == "permutation":
        options |= {"size": spec.values[0], "kernel": spec.kernel}
    else:
        options["values"] = spec.values
    try:
        parameter = PARAMETERS[spec.parameter_type](**options)
    except ScenarioError as error:
        raise error.below(path) from None
    if spec.parameter_default is not None and not parameter.contains(spec.parameter_default):
        problem = f"the default {spec.parameter_default!r} is not a legal value"
        hint = nearest(str(spec.parameter_default), map(str, spec.values))
        raise ScenarioError(f"{path}.parameter_default", problem, allowed=parameter.allowed(), hint=hint)
    return parameter


def build_space(scenario: Scenario) -> SearchSpace:
    """Make the search space.

    Raises
    ------
    ScenarioError
        If a parameter or a constraint is not valid, or the default configuration does not meet all constraints.
    """
    parameters = tuple(build_parameter(spec) for spec in scenario.parameters)
    space = SearchSpace(
        parameters, tuple(_constraint(i, text, parameters) for i, text in enumerate(scenario.constraints))
    )
    if space.default is not None:
        _check_default(space, space.default)
    return space


def _check_default(space: SearchSpace, default: Configuration) -> None:
    for i in space.violated(default):
        constraint = space.constraints[i]
        values = ", ".join(f"{name} = {default[name]}" for name in space.names if name in constraint.names)
        problem = f"the default configuration ({values}) does not meet it: {constraint.text}"
        raise ScenarioError(f"$.constraints[{i}]", problem, allowed="constraints that the default meets")


def _constraint(i: int, text: str, parameters: tuple[Parameter, ...]) -> Constraint:
    try:
        return Constraint(text, parameters)
    except ScenarioError as error:
        raise error.below(f"$.constraints[{i}]") from None


def require_allowed(space: SearchSpace) -> None:
    """Make sure that there is a configuration that meets all constraints.

    Raises
    ------
    ScenarioError
        If none is found.
    """
    if not space.constraints or len(space.known_point):
        return
    alone = (SearchSpace(space.parameters, (constraint,)) for constraint in space.constraints)
    culprit = next((i for i, one in enumerate(alone) if not len(one.known_point)), None)
    drawn = "" if space.n_configurations == 0 else f" among {MAX_DRAWS:,} random ones"
    if culprit is None:
        problem = f"no configuration{drawn} meets all {len(space.constraints)} constraints"
        raise ScenarioError("$.constraints", problem, hint="Each alone can be met; drop or loosen one.")
    problem = f"no configuration{drawn} meets it: {space.constraints[culprit].text}"
    hint = "Loosen it, or give every parameter a default that meets it."
    raise ScenarioError(f"$.constraints[{culprit}]", problem, hint=hint)
