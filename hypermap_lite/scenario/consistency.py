"""What must fit together across sections and no schema can say; the parts check themselves when they are built."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Final

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.evaluation.placeholders import BUILT_IN
from hypermap_lite.history.rows import RESERVED_COLUMNS
from hypermap_lite.scenario.defaults import default_samples, has_belief
from hypermap_lite.scenario.messages import enumerate_names

RUN_FILES: Final = (
    *("scenario.json", "history.csv", "evaluations.csv", "suggestions.csv", "pareto.csv", "posterior_front.csv"),
    "run.log",
)
"""Files of the run folder that no other file may take the place of."""

RESERVED_NAMES: Final = RESERVED_COLUMNS | {"feasible"}
"""Columns of the result files, and what evaluators answer besides objectives: no names for the user's own things."""


def check_consistency(document: Mapping[str, Any]) -> None:
    """Raise a `ScenarioError` at the first contradiction between the sections of a filled document."""
    _check_names(document["input_parameters"], document["objectives"])
    _check_permutations(document["input_parameters"])
    _check_feasible_output(document)
    _check_joint_priors(document["input_parameters"], document["priors"])
    _check_objective_priors(document["input_parameters"], document["objectives"])
    _check_limits(document)
    _check_budget(document)
    _check_asynchronous(document["budget"], document["evaluator"])
    _check_client(document["evaluator"])
    _check_output(document["output"])


def _check_names(parameters: Mapping[str, Any], objectives: Sequence[Mapping[str, Any]]) -> None:
    places = [(f"$.input_parameters.{name}", name) for name in parameters]
    places += [(f"$.objectives[{i}].name", objective["name"]) for i, objective in enumerate(objectives)]
    counts = Counter(objective["name"] for objective in objectives)
    standard_errors = {f"{name}_sem" for name in counts}
    for path, name in places:
        if counts[name] > 1:
            raise ScenarioError(path, f"{counts[name]} objectives are called '{name}'", allowed="each name once")
        if name in counts and name in parameters:
            problem = f"a parameter and an objective are called '{name}'"
            raise ScenarioError(path, problem, allowed="each name once", hint="Both are columns of the history.")
        if name in BUILT_IN and path == f"$.input_parameters.{name}":
            problem = f"{{{name}}} stands for something else in the commands of evaluators"
            raise ScenarioError(path, problem, allowed="any other name", hint=f"Call it '{name}_value', say.")
        if name in RESERVED_NAMES or name in standard_errors:
            problem = f"'{name}' is the name of a column of the result files"
            raise ScenarioError(path, problem, allowed="any other name", hint=f"Call it '{name}_value', say.")


def _check_permutations(parameters: Mapping[str, Any]) -> None:
    for name, parameter in parameters.items():
        _check_permutation(f"$.input_parameters.{name}.prior", name, parameter, parameter["prior"])


def _check_permutation(path: str, name: str, parameter: Mapping[str, Any], prior: Mapping[str, Any] | None) -> None:
    if parameter["parameter_type"] == "permutation" and prior is not None and has_belief({"prior": prior}):
        problem = f"'{name}' is a permutation, which has no {prior['type']} prior"
        hint = "A kde among the joint priors can speak of it."
        raise ScenarioError(path, problem, allowed="uniform", hint=hint)


def _check_feasible_output(document: Mapping[str, Any]) -> None:
    output, path = document["feasible_output"], "$.feasible_output.name"
    if output is None:
        return
    name, objectives = output["name"], [objective["name"] for objective in document["objectives"]]
    hint = "Name what the evaluator answers besides the objectives."
    for what, names in (("a parameter", document["input_parameters"]), ("an objective", objectives)):
        if name in names:
            raise ScenarioError(path, f"{what} is called '{name}' too", allowed="each name once", hint=hint)
    if name in RESERVED_COLUMNS or name in {f"{objective}_sem" for objective in objectives}:
        problem = f"'{name}' is the name of a column of the result files"
        raise ScenarioError(path, problem, allowed="any other name", hint=hint)


def _check_joint_priors(parameters: Mapping[str, Any], priors: Sequence[Mapping[str, Any]]) -> None:
    for i, prior in enumerate(priors):
        if prior["type"] == "kde":
            _check_density(f"$.priors[{i}]", prior)
    owners = {name: f"$.input_parameters.{name}.prior" for name, p in parameters.items() if has_belief(p)}
    for i, prior in enumerate(priors):
        for path, name in names_in(f"$.priors[{i}]", prior):
            _check_known(path, name, parameters, "parameter")
            kind = parameters[name]["parameter_type"]
            if prior["type"] == "mixture" and kind not in ("real", "integer"):
                allowed = "real and integer parameters"
                raise ScenarioError(path, f"'{name}' is {kind}", allowed=allowed, hint="Give it weights of its own.")
            if owners.setdefault(name, f"$.priors[{i}]") != f"$.priors[{i}]":
                problem = f"'{name}' already has a prior at {owners[name]}"
                raise ScenarioError(path, problem, allowed="one prior per parameter", hint="Drop one of the two.")


def _check_objective_priors(parameters: Mapping[str, Any], objectives: Sequence[Mapping[str, Any]]) -> None:
    for i, objective in enumerate(objectives):
        for name, prior in (objective["priors"] or {}).items():
            path = f"$.objectives[{i}].priors.{name}"
            _check_known(path, name, parameters, "parameter")
            _check_permutation(path, name, parameters[name], prior)


def _check_density(path: str, prior: Mapping[str, Any]) -> None:
    """Check the options of a kernel density prior against each other."""
    if prior["file"] is None and prior["points"] is None:
        raise ScenarioError(
            path, "it has no file to take points from", allowed="a CSV file or run folder", hint="Add 'file'."
        )
    if (prior["rows"] == "best") != (prior["quantile"] is not None):
        is_missing = prior["quantile"] is None
        problem = (
            "'best' needs to know how many" if is_missing else f"a quantile goes with rows best, not {prior['rows']}"
        )
        hint = 'Write "quantile": 0.1, say.' if is_missing else 'Write "rows": "best", or drop it.'
        raise ScenarioError(f"{path}.quantile", problem, allowed="a number > 0 and <= 1, with rows best", hint=hint)
    names, points = prior["parameters"], prior["points"]
    if names is not None and points is not None and set(names) != set(points):
        problem = f"the points are of {enumerate_names(points)}"
        raise ScenarioError(f"{path}.parameters", problem, allowed="the same, or null", hint="Drop one of the two.")


def names_in(path: str, prior: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield each place where a joint prior names a parameter, with the name."""
    yield from ((f"{path}.parameters[{k}]", name) for k, name in enumerate(prior.get("parameters") or ()))
    yield from ((f"{path}.points.{name}", name) for name in prior.get("points") or ())
    for k, component in enumerate(prior.get("components", ())):
        for part in ("mean", "std"):
            yield from ((f"{path}.components[{k}].{part}.{name}", name) for name in component[part])


def _check_limits(document: Mapping[str, Any]) -> None:
    weights, names = document["acquisition"]["weights"], [o["name"] for o in document["objectives"]]
    if weights["type"] != "bounding_box":
        return
    path = "$.acquisition.weights.limits"
    for name, (low, high) in weights["limits"].items():
        _check_known(f"{path}.{name}", name, names, "objective")
        if low >= high:
            problem = f"the limits [{low}, {high}] are {'equal' if low == high else 'reversed'}"
            raise ScenarioError(f"{path}.{name}", problem, allowed="[low, high] with low < high")
    missing = [name for name in names if name not in weights["limits"]]
    if missing:
        raise ScenarioError(path, f"the objective '{missing[0]}' has no limits", allowed="limits for every objective")


def _check_known(path: str, name: str, known: Iterable[str], what: str) -> None:
    if name not in known:
        raise ScenarioError(
            path, f"there is no {what} '{name}'", allowed=enumerate_names(list(known)), hint=nearest(name, known)
        )


def _check_budget(document: Mapping[str, Any]) -> None:
    """Refuse a design that is larger than the budget, unless it has the default size: nobody asked for that one."""
    samples, evaluations = document["design_of_experiment"]["number_of_samples"], document["budget"]["evaluations"]
    if samples > evaluations and samples != default_samples(document):
        raise ScenarioError(
            "$.design_of_experiment.number_of_samples",
            f"a design of {samples} does not fit into a budget of {evaluations} evaluations",
            allowed=f"1 to {evaluations}",
            hint="Raise budget.evaluations or shrink the design.",
        )
    confirming = document["budget"]["confirm_front"]
    if confirming >= evaluations:
        raise ScenarioError(
            "$.budget.confirm_front",
            f"{confirming} of {evaluations} evaluations cannot repeat others",
            allowed=f"0 to {evaluations - 1}",
            hint="Raise budget.evaluations by as many as shall be repeated.",
        )


def _check_asynchronous(budget: Mapping[str, Any], evaluator: Mapping[str, Any]) -> None:
    """Refuse batches where each worker is to go on by itself."""
    if not budget["asynchronous"]:
        return
    path, allowed = "$.budget.asynchronous", "false where configurations come in batches"
    if budget["batch_size"] > 1:
        hint = "Drop budget.batch_size: evaluator.workers says how many run at a time."
        raise ScenarioError(path, f"there are batches of {budget['batch_size']}", allowed=allowed, hint=hint)
    is_batch = evaluator.get("batch", False)
    if is_batch or evaluator["type"] == "client_server":
        whom = "a function that takes a whole batch" if is_batch else "a client that answers batches"
        raise ScenarioError(path, f"the evaluator is {whom}", allowed=allowed)
    if evaluator["racing"] is not None:
        hint = "Drop evaluator.racing: its rivals are those of the time when a batch was suggested."
        raise ScenarioError(path, "replicates race", allowed=allowed, hint=hint)
    if budget["confirm_front"]:
        hint = (
            "Drop budget.confirm_front. A second run, with asynchronous false and the folder of this one as "
            "earlier_evaluations, which count towards its budget, can confirm the front."
        )
        raise ScenarioError(path, "the last evaluations confirm the front", allowed=allowed, hint=hint)


def _check_client(evaluator: Mapping[str, Any]) -> None:
    racing, replicates = evaluator["racing"], evaluator["replicates"]
    if racing is not None and racing["minimum"] >= replicates:
        raise ScenarioError(
            "$.evaluator.racing.minimum",
            f"replicates is {replicates}, so that none is left to save after {racing['minimum']}",
            allowed=f"2 to {replicates - 1}" if replicates > 2 else "no racing with fewer than 3 replicates",
            hint="Raise evaluator.replicates, or drop racing.",
        )
    if evaluator["type"] == "client_server" and evaluator["replicates"] > 1:
        raise ScenarioError(
            "$.evaluator.replicates",
            f"a client cannot be asked {evaluator['replicates']} times for the same configuration",
            allowed="1 with client_server",
            hint="Let the client repeat and average.",
        )


def _check_output(output: Mapping[str, Any]) -> None:
    """Refuse two output files of the same name."""
    taken = {os.path.abspath(os.path.join(output["directory"], name)): f"the run folder's {name}" for name in RUN_FILES}
    taken[os.path.abspath(output["directory"])] = "the run folder"
    for key in ("samples_file", "pareto_file"):
        if output[key] is None:
            continue
        place = os.path.abspath(output[key])
        if place in taken:
            problem = f"'{output[key]}' is {taken[place]}"
            raise ScenarioError(f"$.output.{key}", problem, allowed="a file of its own")
        taken[place] = f"the {key} already"
