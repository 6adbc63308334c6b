"""Warnings about scenarios that are valid and probably not meant."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TypeAlias

from hypermap_lite.scenario.command_lint import lint_command
from hypermap_lite.scenario.defaults import BEGINNING
from hypermap_lite.scenario.model import ParameterSpec, Scenario
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import Value

Part: TypeAlias = tuple[Mapping[str, float], Mapping[str, float], float]
"""A Gaussian's means and standard deviations by parameter, and its weight."""

MASS_OUTSIDE = 0.95
"""A prior with more of its mass than this outside the bounds is worth a warning."""

PRIOR_DESIGNS = ("prior_sampling", "prior_latin_hypercube")
PRIOR_OPTIMIZERS = ("prior_sampling", "local_search", "evolutionary", "cma_es")
"""What draws from the priors."""

RARELY_ALLOWED = 0.01
"""Constraints that a smaller share of the space than this meets are worth a warning."""

DECADES = 3
"""A linear parameter that spans at least so many decades is worth a warning."""


def lint(scenario: Scenario, space: SearchSpace | None = None) -> list[str]:
    """Return warnings, one sentence or two each, with the place in the JSON in front.

    Those on constraints need the search space, which a scenario only describes.
    """
    warnings = [
        *_levels(scenario),
        *_linear_decades(scenario),
        *_priors_outside(scenario),
        *single_points(scenario),
        *_unused_priors(scenario),
        *_maximizer(scenario),
        *_reference_points(scenario),
        *_constraints(space),
        *_budget(scenario, space),
        *_confirmation(scenario),
        *_replicate_noise(scenario),
        *_workers(scenario),
        *_parallel_options(scenario),
        *lint_command(scenario),
    ]
    return [f"{path}: {text}" for path, text in warnings]


def mass_inside(parameter: ParameterSpec, mean: float, std: float) -> float:
    """Return how much of a Gaussian, not truncated, lies within a numeric parameter's bounds."""
    low, high = float(parameter.values[0]), float(parameter.values[1])
    if parameter.parameter_type == "integer":
        low, high = low - 0.5, high + 0.5
    if parameter.scale == "log":
        low, high, mean = math.log10(low), math.log10(high), math.log10(mean)
    a, b = (low - mean) / (std * math.sqrt(2)), (high - mean) / (std * math.sqrt(2))
    if a > 0:  # both in the upper tail, where 1 - erf would cancel
        return (math.erfc(a) - math.erfc(b)) / 2
    return (math.erfc(-b) - math.erfc(-a)) / 2


def _levels(scenario: Scenario) -> Iterator[tuple[str, str]]:
    for parameter in scenario.parameters:
        numbers = _numbers(parameter)
        if parameter.parameter_type not in ("categorical", "ordinal") or numbers is None:
            continue
        path = f"$.input_parameters.{parameter.name}"
        steps = [b - a for a, b in zip(sorted(numbers), sorted(numbers)[1:], strict=False)]
        if all(step == 1 and numbers[0].is_integer() for step in steps):
            low, high = f"{min(numbers):g}", f"{max(numbers):g}"
            advice = f'declare it "integer" with values [{low}, {high}]'
            yield path, f"the levels are consecutive integers; {advice}, so that the model knows their distances."
        elif parameter.parameter_type == "categorical":
            yield path, 'all categories are numbers; declare it "ordinal", so that the model knows their order.'


def _numbers(parameter: ParameterSpec) -> list[float] | None:
    try:
        return [float(value) for value in parameter.values]
    except ValueError:
        return None


def _linear_decades(scenario: Scenario) -> Iterator[tuple[str, str]]:
    for parameter in scenario.parameters:
        if parameter.parameter_type in ("real", "integer") and parameter.scale == "linear":
            low, high = float(parameter.values[0]), float(parameter.values[1])
            if low > 0 and high / low >= 10**DECADES:
                text = f'it spans {math.log10(high / low):.1f} decades; "scale": "log" searches them evenly.'
                yield f"$.input_parameters.{parameter.name}", text


def _priors_outside(scenario: Scenario) -> Iterator[tuple[str, str]]:
    numeric = {p.name: p for p in scenario.parameters if p.parameter_type in ("real", "integer")}
    for path, parts in _gaussians(scenario):
        outside = 1 - _inside(numeric, parts)
        if outside > MASS_OUTSIDE:
            yield path, f"{_percent(outside)} of its mass lies outside the bounds; only the tail inside counts."


def _gaussians(scenario: Scenario) -> Iterator[tuple[str, list[Part]]]:
    """Yield the path and the weighted Gaussians of each prior that is made of them."""
    common = [(parameter.name, parameter.prior) for parameter in scenario.parameters]
    own = [item for entry in scenario.objective_priors for item in entry.priors.items()]
    for name, prior in [*common, *own]:
        if prior and prior.type == "gaussian":
            yield prior.path, [({name: prior.options["mean"]}, {name: prior.options["std"]}, 1.0)]
        if prior and prior.type == "mixture":
            components = prior.options["components"]
            yield prior.path, [({name: c["mean"]}, {name: c["std"]}, c["weight"]) for c in components]
    for joint in scenario.joint_priors:
        if joint.type == "mixture":
            yield joint.path, [(c["mean"], c["std"], c["weight"]) for c in joint.options["components"]]


def _inside(numeric: Mapping[str, ParameterSpec], parts: list[Part]) -> float:
    masses = [w * math.prod(mass_inside(numeric[n], mean[n], std[n]) for n in mean) for mean, std, w in parts]
    return sum(masses) / sum(weight for _, _, weight in parts)


def single_points(scenario: Scenario) -> Iterator[tuple[str, str]]:
    """Yield path and warning for each density over a single point, whose width is not that of any data."""
    for prior in scenario.joint_priors:
        points = prior.options.get("points")
        if points and len(_distinct(points, prior.options.get("point_weights"))) == 1:
            text = "it rests on a single point; its width is set to a standard deviation of 10 % of each range"
            discrete = {p.name for p in scenario.parameters if p.parameter_type in ("categorical", "ordinal")}
            yield prior.path, f"{text}, and it says nothing about levels." if discrete & set(points) else f"{text}."


def _distinct(points: Mapping[str, list[Value]], weights: list[float] | None) -> set[tuple[Value, ...]]:
    columns = [[tuple(v) if isinstance(v, list) else v for v in column] for column in points.values()]
    rows = list(zip(*columns, strict=False))
    return {row for row, weight in zip(rows, weights or [1.0] * len(rows), strict=False) if weight}


def _percent(share: float) -> str:
    return "more than 99.9 %" if share > 0.999 else f"{100 * share:.1f} %"


def _unused_priors(scenario: Scenario) -> Iterator[tuple[str, str]]:
    uses = scenario.design.type in PRIOR_DESIGNS or scenario.optimizer.type in PRIOR_OPTIMIZERS
    weighted = scenario.optimizer.type == "bayesian" and scenario.acquisition.prior_weighting is not None
    if scenario.has_priors and not uses and not weighted:
        yield (
            "$.optimizer",
            "the priors change nothing: neither the design, the optimizer nor the acquisition uses them.",
        )


def _maximizer(scenario: Scenario) -> Iterator[tuple[str, str]]:
    other = [p.name for p in scenario.parameters if p.parameter_type != "real"]
    if scenario.optimizer.type == "bayesian" and scenario.maximizer.type == "cma_es" and other:
        yield "$.maximizer.type", f"'{other[0]}' is not real; local_search takes the place of cma_es."


def _reference_points(scenario: Scenario) -> Iterator[tuple[str, str]]:
    for i, objective in enumerate(scenario.objectives):
        if len(scenario.objectives) > 1 and objective.reference_point is None:
            text = f"'{objective.name}' has no reference_point; the hypervolume is then not comparable between runs."
            yield f"$.objectives[{i}]", text


def _constraints(space: SearchSpace | None) -> Iterator[tuple[str, str]]:
    if space is None or not space.constraints:
        return
    share = space.share_allowed()
    if share < RARELY_ALLOWED:
        how = "fewer than 0.1 %" if share < RARELY_ALLOWED / 10 else f"only {100 * share:.1f} %"
        yield "$.constraints", f"{how} of uniform draws meet them; narrower ranges would be searched better."


def _budget(scenario: Scenario, space: SearchSpace | None) -> Iterator[tuple[str, str]]:
    evaluations = scenario.budget.evaluations
    if scenario.optimizer.type == "bayesian" and scenario.design.number_of_samples >= evaluations:
        yield "$.budget.evaluations", f"the design takes all {evaluations} evaluations; no model is ever fitted."
    if (begins_with := BEGINNING.get(scenario.optimizer.type)) and scenario.optimizer.options[
        begins_with
    ] >= evaluations:
        text = f"{begins_with} takes all {evaluations} evaluations; {scenario.optimizer.type} never begins."
        yield "$.budget.evaluations", text
    if evaluations < scenario.budget.batch_size:
        text = f"a batch is more than the {evaluations} evaluations of the budget; all are chosen without a result."
        yield "$.budget.batch_size", text
    size = math.prod(_n_levels(p) for p in scenario.parameters) if space is None else space.n_configurations
    if size < evaluations:
        yield "$.budget.evaluations", f"there are only {size:.0f} configurations; the run ends after them."


def _confirmation(scenario: Scenario) -> Iterator[tuple[str, str]]:
    n, path = scenario.budget.confirm_front, "$.budget.confirm_front"
    left = scenario.budget.evaluations - scenario.design.number_of_samples
    if 0 < left < n or (n and left <= 0):
        yield path, f"the design comes first, so that only {max(left, 0)} evaluations can confirm the front."
    component = scenario.evaluator.component
    if n and component is not None and component.type == "exhaustive":
        yield path, "a table answers the same each time; these evaluations bring nothing."
    elif n and scenario.surrogate.options.get("noise") is False:
        yield path, "the surrogate takes evaluations to be exact (noise is false); repeating them brings nothing."


def _replicate_noise(scenario: Scenario) -> Iterator[tuple[str, str]]:
    options, path = scenario.surrogate.options, "$.surrogate.noise_from_replicates"
    if not options.get("noise_from_replicates"):
        return
    if options.get("noise") is False:
        yield path, "it does nothing: the surrogate takes evaluations to be exact (noise is false)."
        return
    has_repetitions = scenario.budget.confirm_front or scenario.earlier_evaluations
    if scenario.evaluator.replicates == 1 and not has_repetitions:
        yield path, "it does nothing: there is one replicate of each configuration, which tells of no noise."


def _parallel_options(scenario: Scenario) -> Iterator[tuple[str, str]]:
    budget = scenario.budget
    if budget.asynchronous and scenario.evaluator.workers == 1:
        yield "$.budget.asynchronous", "it brings nothing: there is one worker (evaluator.workers)."
    is_one_at_a_time = budget.batch_size == 1 and not budget.asynchronous
    if scenario.optimizer.options.get("separation") and is_one_at_a_time:
        yield "$.optimizer.separation", "it does nothing: one configuration is evaluated at a time."


def _n_levels(parameter: ParameterSpec) -> float:
    if parameter.parameter_type == "integer":
        return float(parameter.values[1]) - float(parameter.values[0]) + 1
    if parameter.parameter_type == "permutation":
        return math.factorial(int(parameter.values[0]))
    return math.inf if parameter.parameter_type == "real" else len(parameter.values)


def _workers(scenario: Scenario) -> Iterator[tuple[str, str]]:
    if scenario.evaluator.workers > 1 and (why := _why_workers_are_idle(scenario)):
        yield "$.evaluator.workers", f"they are not used: {why}."
        return
    if scenario.budget.asynchronous:
        return
    racing, at_once, what = scenario.evaluator.racing, scenario.evaluator.replicates, "replicates"
    if racing is not None:
        at_once, what = max(racing.minimum, racing.step), "the replicates between two looks of the race"
    calls = scenario.budget.batch_size * at_once
    if scenario.evaluator.workers > calls:
        text = f"only {calls} calls can run at once (batch_size x {what}); the other workers never get one."
        yield "$.evaluator.workers", text


def _why_workers_are_idle(scenario: Scenario) -> str:
    evaluator = scenario.evaluator
    if evaluator.component is not None and evaluator.component.type == "exhaustive":
        return "a table is looked up at once"
    return "a batch is one call" if evaluator.batch or evaluator.is_client else ""
