"""The composition root: names in a scenario become objects here, and only here."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from hypermap_lite.acquisition import ACQUISITIONS, Bopro, FeasibilityWeighting, Pibo, PriorWeighting
from hypermap_lite.design import DESIGNS, Grid, InitialDesign, PriorSampling, RandomSampling
from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.evaluation import EVALUATORS
from hypermap_lite.evaluation.batch_plan import BatchPlan
from hypermap_lite.evaluation.earlier import earlier_evaluations
from hypermap_lite.evaluation.evaluator import Evaluator
from hypermap_lite.evaluation.exhaustive import Exhaustive
from hypermap_lite.evaluation.python_function import PythonFunction
from hypermap_lite.history.history import History
from hypermap_lite.maximizers import MAXIMIZERS
from hypermap_lite.optimizers import OPTIMIZERS, SEARCHES, Optimizer
from hypermap_lite.optimizers.bayesian import BayesianOptimizer
from hypermap_lite.optimizers.confirmation import Confirmation
from hypermap_lite.optimizers.fitness import Fitness, normalized_weights
from hypermap_lite.optimizers.initial import InitialPhase
from hypermap_lite.optimizers.method import Method
from hypermap_lite.optimizers.model_free import ModelFreeOptimizer
from hypermap_lite.optimizers.sampling import SamplingOptimizer, SamplingPhase
from hypermap_lite.priors import JOINT_PRIORS, PRIORS, AsJoint, Density, JointDensity, ProductPrior
from hypermap_lite.priors.beliefs import Belief, completed, together
from hypermap_lite.scalarization import SCALARIZATIONS, WEIGHTS, BoundingBox, WeightSampling
from hypermap_lite.scenario.model import ComponentSpec, ParameterSpec, Scenario
from hypermap_lite.space import Parameter, SearchSpace
from hypermap_lite.space_assembly import build_parameter as build_parameter
from hypermap_lite.space_assembly import build_space as build_space
from hypermap_lite.space_assembly import require_allowed as require_allowed
from hypermap_lite.surrogates import SURROGATES

Member = TypeVar("Member")

SAMPLING_PHASES: Mapping[str, SamplingPhase] = {
    "random_search": SamplingPhase(design=RandomSampling(), name="random"),
    "prior_sampling": SamplingPhase(design=PriorSampling(uniform_share=0.0), name="prior"),
}
"""What the optimizers without a model do after the initial design."""

PRIOR_WEIGHTINGS: Mapping[str, type[PriorWeighting]] = {"pibo": Pibo, "bopro": Bopro}
"""JSON name of each way the prior enters the acquisition function."""

FEASIBILITY_WEIGHTINGS: Mapping[str, type[FeasibilityWeighting]] = {"probability": FeasibilityWeighting}
"""JSON name of each way infeasible evaluations enter the acquisition function."""


def build_member(family: Mapping[str, type[Member]], spec: ComponentSpec, kind: str, **extra: Any) -> Member:
    """Make the member of a family that a specification names.

    Raises
    ------
    ScenarioError
        If the family has no such member, or the member refuses its options.
    """
    if spec.type not in family:
        known = ", ".join(family)
        hint = nearest(spec.type, family)
        raise ScenarioError(f"{spec.path}.type", f"unknown {kind} {spec.type!r}", allowed=known, hint=hint)
    try:
        return family[spec.type](**spec.options, **extra)
    except ScenarioError as error:
        raise error.below(spec.path) from None
    except TypeError as error:
        raise ScenarioError(spec.path, f"the options of the {kind} {spec.type!r} do not fit: {error}") from None


def build_prior(scenario: Scenario, space: SearchSpace) -> ProductPrior:
    """Make the whole belief: the common priors, or the equal mixture of those of the objectives.

    Raises
    ------
    ScenarioError
        As `build_common_prior`.
    """
    return together(build_beliefs(scenario, space))


def build_common_prior(scenario: Scenario, space: SearchSpace) -> ProductPrior:
    """Make the product of the priors on single parameters and on groups of them, for all objectives.

    Raises
    ------
    ScenarioError
        If a joint prior names an unknown parameter, or a parameter has two priors.
    """
    factors: list[tuple[tuple[int, ...], JointDensity]] = []
    owners: dict[str, str] = {}
    for j, spec in enumerate(scenario.parameters):
        if spec.prior is not None and spec.has_belief:
            owners[spec.name] = spec.prior.path
            factors.append(((j,), AsJoint(_marginal_density(spec, spec.prior, space.parameters[j]))))
    factors.extend(_joint_factor(joint, space, owners) for joint in scenario.joint_priors)
    return ProductPrior(space.dimension, tuple(factors))


def build_beliefs(scenario: Scenario, space: SearchSpace) -> tuple[Belief, ...]:
    """Make the priors that suggestions follow: one for all objectives, or one per objective that has any.

    An objective's own priors are completed by the common ones; with common priors, every objective has some.

    Raises
    ------
    ScenarioError
        As `build_prior`.
    """
    common = build_common_prior(scenario, space)
    own = {entry.objective: entry.priors for entry in scenario.objective_priors}
    if not own:
        return (Belief(prior=common),)
    beliefs = []
    for i, objective in enumerate(scenario.objectives):
        specs = own.get(objective.name, {})
        prior = completed(_product(scenario, space, specs), common)
        if not prior.is_uniform:
            beliefs.append(Belief(prior=prior, name=objective.name, objective=i))
    return tuple(beliefs)


def _product(scenario: Scenario, space: SearchSpace, priors: Mapping[str, ComponentSpec]) -> ProductPrior:
    """Return the product of priors on single parameters."""
    places = {spec.name: (j, spec) for j, spec in enumerate(scenario.parameters)}
    factors = []
    for name, prior in priors.items():
        j, spec = places[name]
        factors.append(((j,), AsJoint(_marginal_density(spec, prior, space.parameters[j]))))
    return ProductPrior(space.dimension, tuple(factors))


def _marginal_density(spec: ParameterSpec, prior: ComponentSpec, parameter: Parameter) -> Density:
    if prior.type == "weights" and spec.parameter_type == "ordinal":
        prior = _in_rising_order(prior, spec)
    try:
        return build_member(PRIORS, prior, "prior").on(parameter)
    except ScenarioError as error:
        raise (error if error.path.startswith(prior.path) else error.below(prior.path)) from None


def _in_rising_order(prior: ComponentSpec, spec: ParameterSpec) -> ComponentSpec:
    """Sort the weights of an ordinal parameter, written in the order of its values, as the values are sorted."""
    weights = list(prior.options.get("weights", ()))
    if len(weights) != len(spec.values):
        return prior
    order = sorted(range(len(weights)), key=lambda i: float(spec.values[i]))
    return replace(prior, options={"weights": [weights[i] for i in order]})


def _joint_factor(
    spec: ComponentSpec, space: SearchSpace, owners: dict[str, str]
) -> tuple[tuple[int, ...], JointDensity]:
    prior = build_member(JOINT_PRIORS, spec, "joint prior")
    for name in prior.names:
        if name not in space.names:
            hint = nearest(name, space.names)
            problem = f"it names '{name}', which is no parameter"
            raise ScenarioError(spec.path, problem, allowed=", ".join(space.names), hint=hint)
        if name in owners:
            problem = f"'{name}' has a prior already, at {owners[name]}"
            raise ScenarioError(spec.path, problem, allowed="one prior per parameter", hint="Drop one of the two.")
        owners[name] = spec.path
    axes = tuple(space.names.index(name) for name in prior.names)
    try:
        return axes, prior.on([space.parameters[j] for j in axes])
    except ScenarioError as error:
        raise error.below(spec.path) from None


def build_history(scenario: Scenario) -> History:
    """Make the empty history of a run; without batches a model takes results in any order, a search without one not."""
    in_order = not scenario.budget.asynchronous or scenario.optimizer.type in SEARCHES
    return History(build_space(scenario), scenario.objectives, in_order=in_order)


def build_optimizer(scenario: Scenario, history: History | None = None) -> Optimizer:
    """Make the optimizer, which goes on from the given history."""
    history = build_history(scenario) if history is None else history
    require_allowed(history.space)
    prior = build_prior(scenario, history.space)
    initial = build_initial(scenario, history.space, prior, history)
    optimizer = _build_optimizer(scenario, history, prior, initial)
    if scenario.budget.confirm_front:
        optimizer.confirmation = Confirmation(
            n=scenario.budget.confirm_front,
            budget=scenario.budget.evaluations,
            seed=scenario.seed,
            initial=initial,
            posterior=_model_of(scenario, optimizer).fitted,
        )
    return optimizer


def _model_of(scenario: Scenario, optimizer: Optimizer) -> BayesianOptimizer:
    """Return the optimizer, or a Bayesian one on the same history for one that has no model."""
    if not isinstance(optimizer, BayesianOptimizer):
        bayesian = ComponentSpec(type="bayesian", path="$.optimizer")
        optimizer = build_optimizer(replace(scenario, optimizer=bayesian), optimizer.history)
        assert isinstance(optimizer, BayesianOptimizer)
    return optimizer


def _build_optimizer(scenario: Scenario, history: History, prior: ProductPrior, initial: InitialPhase) -> Optimizer:
    if scenario.optimizer.type == "bayesian":
        return BayesianOptimizer(
            history,
            prior=prior,
            initial=initial,
            method=build_method(scenario),
            budget=scenario.budget.exploring,
            seed=scenario.seed,
            batch_size=scenario.budget.batch_size,
            beliefs=build_beliefs(scenario, history.space),
        )
    if scenario.optimizer.type in SAMPLING_PHASES:
        sampling = SAMPLING_PHASES[scenario.optimizer.type]
        return SamplingOptimizer(history, prior=prior, initial=initial, sampling=sampling, seed=scenario.seed)
    if scenario.optimizer.type in SEARCHES:
        return _build_search(scenario, history, prior, initial)
    path, known = f"{scenario.optimizer.path}.type", ", ".join(OPTIMIZERS)
    hint = nearest(scenario.optimizer.type, OPTIMIZERS)
    raise ScenarioError(path, f"unknown optimizer {scenario.optimizer.type!r}", allowed=known, hint=hint)


def _build_search(
    scenario: Scenario, history: History, prior: ProductPrior, initial: InitialPhase
) -> ModelFreeOptimizer:
    """Make an optimizer that needs no model; its fitness is the acquisition's scalarization, with fixed weights."""
    search = build_member(SEARCHES, scenario.optimizer, "optimizer")
    try:
        search.check(history.space)
        weights = normalized_weights(search.weights, len(scenario.objectives))
    except ScenarioError as error:
        raise error.below(scenario.optimizer.path) from None
    scalarization = build_member(SCALARIZATIONS, scenario.acquisition.scalarization, "scalarization")
    n_reference = max(scenario.design.number_of_samples, search.n_initial)
    fitness = Fitness(scalarization=scalarization, weights=weights, n_reference=n_reference)
    return ModelFreeOptimizer(history, prior=prior, initial=initial, search=search, fitness=fitness, seed=scenario.seed)


def build_initial(
    scenario: Scenario, space: SearchSpace, prior: ProductPrior, history: History | None = None
) -> InitialPhase:
    """Make the trials that come before everything else; evaluations of an earlier experiment are in the history."""
    n = scenario.design.number_of_samples
    names = [belief.name for belief in build_beliefs(scenario, space)]
    return InitialPhase(space, prior, build_design(scenario), n, scenario.seed, history, names)


def build_plan(scenario: Scenario) -> BatchPlan:
    """Cut the trials into batches; a client is asked for the whole design at once."""
    size = scenario.budget.batch_size
    if not scenario.evaluator.is_client:
        return BatchPlan(size=size)
    space = build_space(scenario)
    return BatchPlan(size=size, first=len(build_initial(scenario, space, build_prior(scenario, space))))


def build_design(scenario: Scenario) -> InitialDesign:
    """Make the initial design; ``auto`` draws from the priors where there are any, else from a Sobol sequence."""
    name = scenario.design.type
    if name == "auto":
        name = "prior_sampling" if scenario.has_priors else "sobol"
    spec = ComponentSpec(type=name, options=scenario.design.options, path="$.design_of_experiment")
    design = build_member(DESIGNS, spec, "design")
    if isinstance(design, Grid):
        try:
            design.check(build_space(scenario))
        except ScenarioError as error:
            raise error.below(spec.path) from None
    return design


def build_method(scenario: Scenario) -> Method:
    """Make the parts of Bayesian optimization."""
    acquisition = scenario.acquisition
    weighting, by_feasibility = acquisition.prior_weighting, acquisition.feasibility_weighting
    return Method(
        surrogate=build_member(SURROGATES, scenario.surrogate, "surrogate"),
        acquisition=build_member(ACQUISITIONS, acquisition.function, "acquisition function"),
        scalarization=build_member(SCALARIZATIONS, acquisition.scalarization, "scalarization"),
        weights=_build_weights(scenario),
        prior_weighting=None if weighting is None else build_member(PRIOR_WEIGHTINGS, weighting, "prior weighting"),
        feasibility_weighting=None
        if by_feasibility is None
        else build_member(FEASIBILITY_WEIGHTINGS, by_feasibility, "feasibility weighting"),
        maximizer=build_member(MAXIMIZERS, scenario.maximizer, "maximizer"),
        fallback=PriorSampling(uniform_share=0.0),
        epsilon=scenario.optimizer.options.get("epsilon") or 0.0,
        escapes=scenario.optimizer.options.get("escapes", 0),
        boundary_factor=scenario.optimizer.options.get("boundary_factor", 1.0),
        separation=scenario.optimizer.options.get("separation") or 0.0,
    )


def _build_weights(scenario: Scenario) -> WeightSampling:
    spec = scenario.acquisition.weights
    weights = build_member(WEIGHTS, spec, "weight sampling")
    if isinstance(weights, BoundingBox):
        try:
            weights.check(scenario.objectives)
        except ScenarioError as error:
            raise error.below(spec.path) from None
    return weights


def build_evaluator(scenario: Scenario, function: Callable[..., Any] | None = None) -> Evaluator:
    """Make the black box: the scenario's own, or a Python function given instead.

    Raises
    ------
    ScenarioError
        If the scenario names none and none is given, or it cannot be imported or found.
    """
    names = tuple(objective.name for objective in scenario.objectives)
    if function is not None:
        return PythonFunction(
            function=function,
            objectives=names,
            feasible_output=scenario.feasible_output,
            batch=scenario.evaluator.batch,
        )
    spec = scenario.evaluator.component
    if spec is None:
        raise ScenarioError(
            "$.evaluator.type",
            "the scenario names no evaluator",
            allowed=", ".join(EVALUATORS),
            hint='Add one, such as "evaluator": {"type": "python", "function": "module:function"}, or pass a function '
            "to hypermap_lite.optimize.",
        )
    outputs = {"objectives": names, "feasible_output": scenario.feasible_output}
    return build_member(EVALUATORS, spec, "evaluator", **outputs, **_surroundings(spec, scenario))


def _surroundings(spec: ComponentSpec, scenario: Scenario) -> dict[str, Any]:
    """Return what an evaluator needs of the rest of the scenario."""
    if spec.type == "command":
        names = tuple(p.name for p in scenario.parameters)
        return {"parameters": names, "working_directory": scenario.command_folder()}
    if spec.type == "python":
        folders = (*scenario.folders_of(f"{spec.path}.function"), Path.cwd())
        return {"search_path": tuple(dict.fromkeys(map(str, folders)))}
    space = build_space(scenario)
    if spec.type == "exhaustive":
        places = (*scenario.folders_of(f"{spec.path}.file"), Path.cwd())
        return {"space": space, "folders": tuple(dict.fromkeys(places))}
    return {"space": space}


def evaluator_warnings(scenario: Scenario, evaluator: Evaluator) -> Iterator[str]:
    """Yield what is probably not meant about an evaluator that was made: a table that does not cover the space."""
    if isinstance(evaluator, Exhaustive) and scenario.evaluator.component is not None:
        yield from (f"{scenario.evaluator.component.path}.file: {text}" for text in evaluator.warnings())


def validate(scenario: Scenario) -> list[str]:
    """Build everything once, so that every mistake shows before the first evaluation; return warnings.

    Raises
    ------
    ScenarioError
        For the first mistake found.
    """
    optimizer = build_optimizer(scenario)
    earlier_evaluations(scenario, optimizer.history.space)
    if scenario.evaluator.component is None:
        return []
    return list(evaluator_warnings(scenario, build_evaluator(scenario)))
