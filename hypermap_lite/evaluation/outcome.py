"""What an evaluation brings back, from one call of the black box to one row of the history."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Final

from hypermap_lite.typing import Configuration

EARLIER: Final = "earlier"
"""Phase of an evaluation that was made before the run, by somebody else."""

DESIGN: Final = "design"
"""Phase of a point of the initial design."""

MODEL: Final = "model"
"""Phase of a suggestion that comes from the model."""

RANDOM: Final = "random"
"""Phase of a draw that no search step stands behind."""

NEAR: Final = "near"
"""Phase of a draw next to one of the first feasible points."""

CONFIRM: Final = "confirm"
"""Phase of an evaluation that repeats a configuration to know its objectives better."""


class State(Enum):
    """How an evaluation ended."""

    COMPLETED = "completed"
    """All objectives came back as finite numbers."""

    INFEASIBLE = "infeasible"
    """The black box answered that this configuration is not allowed."""

    FAILED = "failed"
    """It crashed, returned nothing usable, or returned NaN or infinity."""

    TIMEOUT = "timeout"
    """It ran past its time limit and was killed."""

    @property
    def is_feasible(self) -> bool | None:
        """Whether the configuration is allowed; None where that was not found out."""
        return {State.COMPLETED: True, State.INFEASIBLE: False}.get(self)


WORST_FIRST: Final = (State.FAILED, State.TIMEOUT, State.INFEASIBLE)
"""States other than completed; the first one met among the replicates of a configuration is its own."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """The answer of one call of the black box."""

    state: State
    values: Mapping[str, float] = field(default_factory=dict)
    """Objective values by name, as the user directed them; all of them if completed, any or none if infeasible."""

    metrics: Mapping[str, float] = field(default_factory=dict)
    """Extra numbers worth a column."""

    error: str = ""
    """One line that says what went wrong; empty if completed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Replicate:
    """One call of the black box: a row of ``evaluations.csv``."""

    trial: int
    replicate: int
    seed: int
    configuration: Configuration
    outcome: Outcome
    seconds: float
    """Wall-clock duration of the call [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Suggestion:
    """One configuration to evaluate, and why the optimizer chose it."""

    trial: int
    """Running number of the configuration, from 0."""

    configuration: Configuration
    phase: str
    """Which rule chose it: ``earlier``, ``default``, ``design``, ``model``, ``random``, ``near``, ``prior``,
    ``confirm``, or a search."""

    prior_weight: float | None = None
    """Exponent the user prior had in the choice, 0 in a prior-free step; None where there is nothing to weigh."""

    prior_trust: float | None = None
    """What is left of the prior's weight after the checks so far, 1, 0.5, 0.25 or 0; None without checks."""

    prior_of: str = ""
    """Objective whose prior was followed; empty if all share one."""

    acquisition_value: float | None = None
    """Value of the maximized acquisition function; None outside the model phase."""

    seconds: float = 0.0
    """CPU time the choice took [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Evaluation:
    """One configuration with the summary of its replicates: a row of ``history.csv``."""

    suggestion: Suggestion
    state: State
    values: Mapping[str, float] = field(default_factory=dict)
    """Mean of each objective over the replicates, as the user directed it; all if completed, any if infeasible.

    Those of an infeasible configuration are in no front; a model may learn from them.
    """

    standard_errors: Mapping[str, float] = field(default_factory=dict)
    """Standard error of each mean; NaN with fewer than two replicates."""

    replicates: int = 1
    seconds: float = 0.0
    """Summed wall-clock duration of the replicates [s]."""

    timestamp: int = 0
    """Time at which the row was written, in ms since the start of the run."""

    error: str = ""

    @property
    def trial(self) -> int:
        """Running number of the configuration."""
        return self.suggestion.trial

    @property
    def configuration(self) -> Configuration:
        """The point that was evaluated."""
        return self.suggestion.configuration

    @property
    def is_completed(self) -> bool:
        """Whether it has objective values that count."""
        return self.state is State.COMPLETED
