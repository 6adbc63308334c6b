"""The effective scenario as a page of text."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from hypermap_lite.objectives import MAX_CLOSED_FORM
from hypermap_lite.scenario.model import (
    MOST_FAILURES,
    USUAL_FAILURES,
    ComponentSpec,
    ObjectivePriors,
    OutputSpec,
    ParameterSpec,
    Scenario,
)
from hypermap_lite.space.real import FEWEST_CHECKED
from hypermap_lite.typing import as_argument

INDENT = " " * 12
"""Width of the column of headings."""

NO_IMPROVEMENTS = ("upper_confidence_bound", "thompson_sampling")
"""Acquisition functions that do not tell how much a point promises."""

HYPERVOLUME_IMPROVEMENT = "noisy_expected_hypervolume_improvement"
"""The one that tells it of several objectives together."""

CARE = ("prior_free", "safeguard", "make_up")
"""Options against misleading priors."""

UNSAID_IF_OFF = ("ends", "noise_from_replicates", "redraws", "unbounded", "uniform_share")
"""Options that are shown only where they do something."""

SAID_IN_WORDS = (
    *("compress_tails", "doubt_noise", "ignore_outliers", "learn_infeasible"),
    *("separate_failures", "separate_modes"),
)
"""Options that have a sentence of their own."""


def summarize(scenario: Scenario) -> str:
    """Return a page that says what will be run: parameters, objectives, method and why, budget, evaluator, output."""
    sections = {
        "experiment": _experiment(scenario),
        "parameters": _parameters(scenario.parameters),
        "constraints": [*scenario.constraints],
        "priors": [
            *(line for prior in scenario.joint_priors for line in _joint_prior(prior)),
            *map(_objective_priors, scenario.objective_priors),
        ],
        "objectives": _objectives(scenario),
        "feasibility": _feasible_output(scenario),
        "earlier": _earlier(scenario),
        "method": _method(scenario),
        "budget": [_budget(scenario)],
        "evaluator": [_evaluator(scenario), *_failures(scenario)],
        "output": [text for text in _output(scenario.output) if text],
    }
    return "\n".join(f"{heading:<12}" + f"\n{INDENT}".join(lines) for heading, lines in sections.items() if lines)


def _earlier(scenario: Scenario) -> list[str]:
    file = scenario.earlier_evaluations
    return [] if file is None else [f"the evaluations of {file} come first, and count towards design and budget"]


def _output(output: OutputSpec) -> Iterator[str | None]:
    yield output.directory
    yield output.samples_file
    yield output.pareto_file
    yield "parameter importance" if output.parameter_importance else None
    yield "best by the surrogate" if output.posterior_best else None


def _experiment(scenario: Scenario) -> list[str]:
    return [
        f"{scenario.application_name}, seed {scenario.seed}",
        *([scenario.description] * bool(scenario.description)),
    ]


def _parameters(parameters: Sequence[ParameterSpec]) -> list[str]:
    rows = [("name", "type", "values", "scale", "default", "prior")]
    for p in parameters:
        numeric = p.parameter_type in ("real", "integer")
        values = f"{p.values[0]:g} to {p.values[1]:g}" if numeric else _shorten(", ".join(map(str, p.values)))
        if p.parameter_type == "permutation":
            values = f"orders of 0 to {int(p.values[0]) - 1} ({p.kernel})"
        default = "-" if p.parameter_default is None else as_argument(p.parameter_default)
        rows.append((p.name, p.parameter_type, values, p.scale if numeric else "-", default, _prior(p.prior)))
    return _table(rows)


def _prior(prior: ComponentSpec | None) -> str:
    if prior is None:
        return "-"
    if prior.type != "mixture":
        return _component(prior)
    parts = [f"{c['mean']:g} ± {c['std']:g}{_share(c['weight'])}" for c in prior.options["components"]]
    return f"mixture({' + '.join(parts)})"


def _objective_priors(entry: ObjectivePriors) -> str:
    return f"of {entry.objective}: " + ", ".join(f"{name} {_prior(prior)}" for name, prior in entry.priors.items())


def _joint_prior(prior: ComponentSpec) -> list[str]:
    if prior.type == "kde":
        return _kernel_density(prior.options)
    parts = []
    for c in prior.options["components"]:
        terms = [f"{name} {mean:g} ± {c['std'].get(name, math.nan):g}" for name, mean in c["mean"].items()]
        parts.append(f"  {', '.join(terms)}{_share(c['weight'])}")
    return [f"{prior.type} of", *parts]


def _kernel_density(options: Mapping[str, Any]) -> list[str]:
    points = options.get("points") or {}
    n = len(next(iter(points.values()), ()))
    which = {"best": f"best {_value(options['quantile'])} of the rows", "all": "all usable rows"}
    source = f", {which.get(options['rows'], 'non-dominated rows')} of {options['file']}" if options["file"] else ""
    factor = None if options["bandwidth_factor"] == 1 else options["bandwidth_factor"]
    shown = {"weights": options["weights"], "bandwidth_factor": factor, "independent": options["independent"] or None}
    form = _options(shown)
    return [f"kde{form} of {n} point{'s' * (n != 1)}{source}", f"  over {', '.join(points)}"]


def _share(weight: float) -> str:
    return "" if weight == 1 else f" (weight {weight:g})"


def _objectives(scenario: Scenario) -> list[str]:
    rows = [("name", "goal", "reference point")]
    points = ["-" if o.reference_point is None else f"{o.reference_point:g}" for o in scenario.objectives]
    rows += [(o.name, o.goal.value, point) for o, point in zip(scenario.objectives, points, strict=True)]
    return _table(rows)


def _feasible_output(scenario: Scenario) -> list[str]:
    output = scenario.feasible_output
    return [] if output is None else [f"{output.name}: {output.true_value} or {output.false_value}"]


def _method(scenario: Scenario) -> list[str]:
    """Say which evaluations are chosen how, and what of the scenario decides that."""
    whole = scenario.budget.evaluations
    n = min(scenario.design.number_of_samples, whole)
    total = max(whole - scenario.budget.confirm_front, n)
    lines = [f"evaluations 1 to {n}: {scenario.design.type}{_options(scenario.design.options)}"]
    last = [f"evaluations {total + 1} to {whole}: repeat those whose worth for the front is least certain"]
    last *= total < whole
    acquisition, m = scenario.acquisition, len(scenario.objectives)
    if scenario.optimizer.type != "bayesian":
        lines += [f"evaluations {n + 1} to {total}: {_component(scenario.optimizer)}"] * (n < total)
        if m > 1 and scenario.optimizer.type in ("local_search", "cma_es"):
            lines.append(f"{m} objectives: {_component(acquisition.scalarization)} with fixed weights")
        return [*lines, *last]
    if n < total:
        chosen = f"{_component(acquisition.function)} on a {_component(scenario.surrogate)}"
        lines += [f"evaluations {n + 1} to {total}: {chosen},", f"  maximized by {_component(scenario.maximizer)}"]
    if epsilon := scenario.optimizer.options.get("epsilon"):
        lines.append(f"  with probability {epsilon:g} drawn uniformly instead")
    is_promise = acquisition.function.type == HYPERVOLUME_IMPROVEMENT and m <= MAX_CLOSED_FORM
    is_promise = is_promise or (m == 1 and acquisition.function.type not in NO_IMPROVEMENTS)
    escapes = scenario.optimizer.options.get("escapes")
    if escapes and (m == 1 or acquisition.function.type not in NO_IMPROVEMENTS):
        lines.append(f"  where the search stands still, up to {escapes} drawn uniformly between one and the next")
        if is_promise and scenario.surrogate.type == "gaussian_process":
            lines.append("  and as many where promises are broken in a row and nothing is known of an objective")
    factor = scenario.optimizer.options.get("boundary_factor", 1.0)
    if factor < 1 and is_promise and sum(p.parameter_type == "real" for p in scenario.parameters) >= FEWEST_CHECKED:
        lines.append(f"  what is promised on a bound counts {factor:g} of itself while such promises are broken")
    if separation := scenario.optimizer.options.get("separation"):
        lines.append(f"  at least {separation:g} of a range away from what is under evaluation")
    lines += last
    lines.append(_trade_offs(scenario))
    if acquisition.feasibility_weighting is None:
        lines.append("infeasible evaluations: not in the acquisition (feasibility_weighting is none)")
    else:
        if scenario.feasible_output is not None:
            power = acquisition.feasibility_weighting.options["exponent"]
            lines.append(f"acquisition weighted by the probability of being feasible, to the power {power:g}")
        if acquisition.feasibility_weighting.options.get("learn_failed"):
            lines.append("evaluations that fail or run out of time keep the search away from where they were")
    if scenario.feasible_output is not None and scenario.surrogate.options.get("learn_infeasible"):
        lines.append("objective values of infeasible evaluations inform the model, unless they look like placeholders")
    if scenario.surrogate.options.get("compress_tails"):
        lines.append("values far beyond those that count, such as penalties, are compressed for the model")
    if _learns_noise_and(scenario.surrogate.options, "doubt_noise"):
        lines.append("what looks like noise is taken for roughness where a model without noise is likelier")
    if _learns_noise_and(scenario.surrogate.options, "ignore_outliers"):
        lines.append("an evaluation far worse than the others foretell is set aside until one near it is as bad")
    if _separates_failures(scenario):
        lines.append("evaluations in a bad mode of their own, such as failures, are told apart from the others")
    if _separates_modes(scenario):
        lines.append("so are two kinds of which the front needs both; each then has a model of its own")
    return [*lines, _prior_use(scenario)]


def _learns_noise_and(surrogate: Mapping[str, Any], option: str) -> bool:
    """Tell whether a surrogate with these options has one that is of no use to a model that knows its noise."""
    return bool(surrogate.get(option) and surrogate.get("noise") and not surrogate.get("noise_from_replicates"))


def _separates_failures(scenario: Scenario) -> bool:
    """Tell whether a model of where failures are keeps the search away from them."""
    options = scenario.surrogate.options
    return bool(
        options.get("separate_failures")
        and not options.get("noise_from_replicates")
        and scenario.acquisition.feasibility_weighting is not None
    )


def _separates_modes(scenario: Scenario) -> bool:
    """Tell whether two kinds of evaluations that the front needs have models of their own."""
    is_one_front = scenario.acquisition.function.type == HYPERVOLUME_IMPROVEMENT
    weighting = scenario.acquisition.prior_weighting
    return bool(
        _separates_failures(scenario)
        and scenario.surrogate.options.get("separate_modes")
        and is_one_front
        and (weighting is None or weighting.type != "bopro")
        and 1 < len(scenario.objectives) <= MAX_CLOSED_FORM
    )


def _trade_offs(scenario: Scenario) -> str:
    """Say how several objectives are weighed against each other."""
    acquisition, m = scenario.acquisition, len(scenario.objectives)
    is_hypervolume = acquisition.function.type == "noisy_expected_hypervolume_improvement"
    if m == 1:
        return "one objective: " + ("noisy expected improvement" if is_hypervolume else "no scalarization")
    if not is_hypervolume:
        weights = f"{_component(acquisition.scalarization)} with weights from {_component(acquisition.weights)}"
        return f"{m} objectives: {weights}"
    how = "all trade-offs at once" if m <= MAX_CLOSED_FORM else "noisy expected improvement in random directions"
    missing = [o.name for o in scenario.objectives if o.reference_point is None]
    corner = f"inferred from the front (none given for {', '.join(missing)})" if missing else "as given"
    return f"{m} objectives: {how}; reference point {corner}"


def _prior_use(scenario: Scenario) -> str:
    weighting = scenario.acquisition.prior_weighting
    if not scenario.has_priors:
        return "no priors: nothing to weight the acquisition with"
    if weighting is None:
        return "priors: not in the acquisition (prior_weighting is none)"
    options = {key: value for key, value in weighting.options.items() if key not in CARE}
    care = _care(weighting.options)
    if weighting.type == "bopro":
        return f"priors: bopro{_options(options)} takes the place of {scenario.acquisition.function.type}{care}"
    if options.get("beta") is None:
        n_model = scenario.budget.exploring - scenario.design.number_of_samples
        options["beta"] = 0.1 * max(n_model, 1)
    return f"priors: acquisition weighted by {weighting.type}{_options(options)}{care}"


def _care(options: Mapping[str, Any]) -> str:
    """Say what is done against misleading priors."""
    free, is_checked = options["prior_free"], options["safeguard"]
    parts = [f"but for {100 * free:g} % of the steps"] * bool(free) + ["dropped if they mislead"] * is_checked
    return "".join(f", {part}" for part in parts)


def _budget(scenario: Scenario) -> str:
    budget = scenario.budget
    batches = "one at a time" if budget.batch_size == 1 else f"{budget.batch_size} at a time"
    if budget.asynchronous:
        batches = "one for each worker that is free"
    limit = "" if budget.minutes is None else f", at most {budget.minutes:g} min"
    return f"{budget.evaluations} evaluations, {batches}{limit}"


def _evaluator(scenario: Scenario) -> str:
    evaluator = scenario.evaluator
    if evaluator.component is None:
        calls = ", called once per batch" if evaluator.batch else ""
        return f"none: driven by ask and tell, or a function passed from Python{calls}"
    options = evaluator.component.options
    target = options.get("function") or options.get("file") or " ".join(options.get("command", ()))
    limit = "no time limit" if evaluator.timeout_seconds is None else f"{evaluator.timeout_seconds:g} s each"
    what = " ".join(filter(None, [evaluator.component.type, _shorten(str(target), 60)]))
    if evaluator.batch or evaluator.is_client:
        return f"{what}; calls: one per batch, {limit}"
    racing = evaluator.racing
    calls = str(evaluator.replicates)
    if racing is not None:
        calls = f"{racing.minimum} to {calls} by racing (alpha={racing.alpha:g})"
    return f"{what}; calls: {calls} per configuration, {evaluator.workers} at a time, {limit}"


def _failures(scenario: Scenario) -> list[str]:
    """Say when failures end the run."""
    n = scenario.evaluator.max_consecutive_failures
    if scenario.evaluator.component is None:
        return []
    late = f" ({MOST_FAILURES} where their parameters explain them)" if n is None else ""
    if n == 1:
        return ["the run ends after the first failure"]
    return [f"the run ends after {USUAL_FAILURES if n is None else n} failures in a row{late}"]


def _component(spec: ComponentSpec) -> str:
    return spec.type + _options(spec.options)


def _options(options: Mapping[str, Any]) -> str:
    given = [
        f"{key}={_value(value)}"
        for key, value in options.items()
        if value is not None and (value or key not in UNSAID_IF_OFF) and key not in SAID_IN_WORDS
    ]
    return f"({', '.join(given)})" if given else ""


def _value(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key}: {_value(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_value, value)) + "]"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _shorten(text: str, length: int = 40) -> str:
    return text if len(text) <= length else text[: length - 4] + " ..."


def _table(rows: Iterable[Sequence[str]]) -> list[str]:
    rows = list(rows)
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
