"""The scenario as frozen dataclasses: what the user wrote, with every default filled in.

Components are only named here (`ComponentSpec`); `hypermap_lite.assembly` turns the names into objects.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from hypermap_lite.errors import ScenarioError
from hypermap_lite.objectives import FeasibleOutput, Objective
from hypermap_lite.scenario.defaults import is_belief
from hypermap_lite.scenario.sources import Layer, folders_of, located, origin_of
from hypermap_lite.typing import Level, Value

USUAL_FAILURES: Final = 5
"""Failures in a row that end a run, unless their parameters explain them; see `evaluation.streaks`."""

MOST_FAILURES: Final = 20
"""Failures in a row that end a run in any case."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ComponentSpec:
    """A replaceable part: its name in the family's table and its options."""

    type: str
    options: Mapping[str, Any] = field(default_factory=dict)
    """Keyword arguments of the member's class; the loader fills in those the user left out."""

    path: str = "$"
    """Where it stands in the JSON, for messages."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterSpec:
    """One entry of ``input_parameters``."""

    name: str
    parameter_type: str
    values: tuple[Level, ...]
    """Bounds [low, high] of a real or integer parameter, the number of elements of a permutation, else the levels."""

    scale: str = "linear"
    """``linear`` or ``log``."""

    kernel: str = "spearman"
    """Distance of two permutations."""

    parameter_default: Value | None = None
    prior: ComponentSpec | None = None
    description: str = ""

    @property
    def has_belief(self) -> bool:
        """Whether its prior says anything; a uniform one does so only with a range."""
        return self.prior is not None and is_belief(self.prior.type, self.prior.options)


@dataclass(frozen=True, slots=True, kw_only=True)
class ObjectivePriors:
    """The beliefs about where one objective alone is best."""

    objective: str
    priors: Mapping[str, ComponentSpec]
    """By parameter; only those that say anything."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignSpec:
    """Section ``design_of_experiment``: what is evaluated before there is a model."""

    type: str
    number_of_samples: int
    """Points of the design, the default configuration included."""

    options: Mapping[str, Any] = field(default_factory=dict)
    """Keyword arguments of the design's class."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BudgetSpec:
    """Section ``budget``: when the run ends."""

    evaluations: int = 50
    """Configurations to evaluate, the design included."""

    batch_size: int = 1
    """Configurations suggested at a time."""

    minutes: float | None = None
    """No new batch is started after this wall-clock time [min]."""

    asynchronous: bool = False
    """Whether a worker gets the next configuration as soon as it is free, instead of waiting for a batch."""

    confirm_front: int = 0
    """Evaluations at the end that repeat configurations which may be on the front."""

    @property
    def exploring(self) -> int:
        """Evaluations of new configurations."""
        return self.evaluations - self.confirm_front


@dataclass(frozen=True, slots=True, kw_only=True)
class AcquisitionSpec:
    """Section ``acquisition``: the acquisition function and what is wrapped around it."""

    function: ComponentSpec
    scalarization: ComponentSpec
    weights: ComponentSpec
    prior_weighting: ComponentSpec | None
    """None if priors shall not enter the acquisition."""

    feasibility_weighting: ComponentSpec | None = None
    """None if infeasible evaluations shall not enter the acquisition."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RacingSpec:
    """When the replicates of a configuration are stopped."""

    alpha: float = 0.05
    """Probability at most that a configuration is stopped that no evaluated one dominates, in (0, 1)."""

    minimum: int = 3
    """Replicates before the first look, >= 2."""

    step: int = 2
    """Replicates between two looks, >= 1."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EvaluatorSpec:
    """Section ``evaluator``: the black box and how often and how long it is called."""

    component: ComponentSpec | None
    """None if there is none: the run is driven by ask and tell, or by a function passed from Python."""

    batch: bool = False
    """Whether a Python function, the scenario's or one that is passed, takes a whole batch in one call."""

    replicates: int = 1
    """Calls per configuration, each with its own seed; objectives are averaged."""

    racing: RacingSpec | None = None
    """When fewer calls are made of a configuration that is clearly dominated; None: never."""

    timeout_seconds: float | None = None
    """A call that runs longer is killed with everything it started [s]."""

    workers: int = 1
    """Calls at the same time; does not change the results."""

    max_consecutive_failures: int | None = None
    """The run stops (exit status 4) after so many configurations in a row without a usable result; None: after 5, or up
    to 20 where their parameters explain it."""

    @property
    def is_client(self) -> bool:
        """Whether a client at the other end of stdin and stdout evaluates."""
        return self.component is not None and self.component.type == "client_server"


@dataclass(frozen=True, slots=True, kw_only=True)
class OutputSpec:
    """Section ``output``: where results go."""

    directory: str
    """Run folder; relative to the working directory."""

    samples_file: str | None = None
    """CSV of all evaluations in HyperMapper's format, beside the run folder; relative to the working directory."""

    pareto_file: str | None = None
    """The same of the Pareto front."""

    parameter_importance: bool = False
    """Whether to report at the end how much each parameter matters."""

    posterior_best: bool = False
    """Whether to report at the end what is best by the surrogate."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """A whole experiment."""

    application_name: str
    parameters: tuple[ParameterSpec, ...]
    objectives: tuple[Objective, ...]
    design: DesignSpec
    budget: BudgetSpec
    optimizer: ComponentSpec
    surrogate: ComponentSpec
    acquisition: AcquisitionSpec
    maximizer: ComponentSpec
    evaluator: EvaluatorSpec
    output: OutputSpec
    feasible_output: FeasibleOutput | None = None
    """None if there is no column for it; a result may still say that its configuration is not feasible."""

    joint_priors: tuple[ComponentSpec, ...] = ()
    objective_priors: tuple[ObjectivePriors, ...] = ()
    """Of the objectives that have any."""

    constraints: tuple[str, ...] = ()
    """Conditions over the parameters that every configuration meets, as the user wrote them."""

    earlier_evaluations: str | None = None
    """CSV file or run folder whose rows come before the run's own."""

    seed: int = 0
    description: str = ""
    canonical: Mapping[str, Any] = field(default_factory=dict)
    """The effective scenario as JSON: inheritance and overrides applied, every default filled in."""

    directory: Path = field(default_factory=Path, compare=False)
    """Folder of the scenario file."""

    layers: tuple[Layer, ...] = field(default=(), compare=False, repr=False)
    """The files and overrides it was put together from, the most basic first."""

    notes: tuple[str, ...] = field(default=(), compare=False, repr=False)
    """What loading has changed that the user did not spell out, a sentence each."""

    @property
    def has_priors(self) -> bool:
        """Whether the user says anything about where the optimum lies."""
        return bool(self.joint_priors or self.objective_priors) or any(p.has_belief for p in self.parameters)

    @property
    def prior_columns(self) -> tuple[str, ...]:
        """The columns of the history that say more of the priors than their weight."""
        weighting = self.acquisition.prior_weighting
        if self.optimizer.type != "bayesian" or weighting is None or not self.has_priors:
            return ()
        is_shown = {"prior_trust": bool(weighting.options["safeguard"]), "prior_of": bool(self.objective_priors)}
        return tuple(column for column, shown in is_shown.items() if shown)

    def origin_of(self, path: str) -> str:
        """Return the name of the file, or the ``--set``, that wrote the value at a path; empty if there is none."""
        return origin_of(path, self.layers)

    def located(self, error: ScenarioError) -> ScenarioError:
        """Return an error with the file, or ``--set``, that wrote the value at its path, and its place there."""
        return located(error, self.layers)

    def folders_of(self, path: str) -> tuple[Path, ...]:
        """Return where files named at a path are looked for: beside the file that says it, then beside this one."""
        return folders_of(path, self.layers, self.directory)

    def command_folder(self) -> Path:
        """Return where the evaluator's command runs: the first of its folders that holds a file it names."""
        folders = self.folders_of("$.evaluator.command")
        command = self.evaluator.component.options.get("command", ()) if self.evaluator.component else ()
        words = [word for argument in command for word in argument.split() if not Path(word).is_absolute()]
        holding = (folder for folder in folders if any((folder / word).is_file() for word in words))
        return next(holding, folders[0])
