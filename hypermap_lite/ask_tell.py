"""Driving the optimizer from a loop of one's own: ask for configurations, tell their results."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from hypermap_lite.assembly import build_history, build_optimizer
from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.earlier import earlier_evaluations
from hypermap_lite.evaluation.evaluator import outcome_of
from hypermap_lite.evaluation.outcome import Evaluation, Outcome, State, Suggestion
from hypermap_lite.history.history import History, objectives_of
from hypermap_lite.history.pooling import pooled
from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.scenario.loader import load_scenario


class Optimizer:
    """An optimizer without an evaluator: the caller evaluates, in any order and as many at a time as it likes.

    What `ask` returns depends on the scenario, on what has been told and on what is pending, and on nothing else.
    The budget of the scenario is not enforced; it sets the default strength of the prior.

    Parameters
    ----------
    scenario
        A scenario file, or its content as a mapping. Its evaluator is not used.
    evaluations
        Trials of an earlier run to go on from, in order, as `read_history` returns them; with ``budget.asynchronous``
        as they were told, and numbers that are missing, of what was pending, are asked for again. If there are none,
        those of the scenario's ``earlier_evaluations`` come first.
    overrides
        Changes to the scenario, as in ``surrogate.type=random_forest``.

    Raises
    ------
    ScenarioError
        If the scenario is not valid.

    Examples
    --------
    >>> from hypermap_lite import Optimizer
    >>> optimizer = Optimizer(
    ...     {
    ...         "input_parameters": {"x": {"parameter_type": "real", "values": [0, 4]}},
    ...         "objectives": [{"name": "loss", "goal": "minimize"}],
    ...     }
    ... )
    >>> for _ in range(12):
    ...     for suggestion in optimizer.ask():
    ...         evaluation = optimizer.tell(suggestion, {"loss": (suggestion.configuration["x"] - 1) ** 2})
    >>> [best] = optimizer.pareto_front()
    >>> round(best.configuration["x"], 2)
    1.0
    """

    def __init__(
        self,
        scenario: str | Path | Mapping[str, Any],
        *,
        evaluations: Iterable[Evaluation] = (),
        overrides: Sequence[str] = (),
    ) -> None:
        self.scenario = load_scenario(scenario, overrides=overrides)
        history = build_history(self.scenario)
        history.extend(evaluations)
        if not len(history):
            history.extend(earlier_evaluations(self.scenario, history.space))
        self._optimizer = build_optimizer(self.scenario, history)

    @property
    def history(self) -> History:
        """All trials told so far, up to the first that is pending; all, as told, with ``budget.asynchronous``."""
        return self._optimizer.history

    @property
    def pending(self) -> list[Suggestion]:
        """Suggestions that wait for their result."""
        return self._optimizer.pending

    def ask(self, n: int = 1) -> list[Suggestion]:
        """Return up to n configurations to evaluate; fewer only when a finite space holds no other.

        Pending ones are taken into account, so there is no need to wait for results before asking again.
        """
        return self._optimizer.ask(n)

    def tell(self, suggestion: Suggestion | int, result: object = None, *, error: str = "") -> Evaluation:
        """Record the result of a pending suggestion.

        Parameters
        ----------
        suggestion
            What `ask` returned, or its trial number.
        result
            Objective values by name or in the order of the objectives, or a bare number if there is one objective;
            ``{"feasible": False}``, or what ``feasible_output`` says, if the configuration is not allowed; None if the
            evaluation failed.
        error
            Why it failed.

        Returns
        -------
        Evaluation
            What was recorded: a result that is no finite number, or lacks an objective, is a failed evaluation.

        Raises
        ------
        UsageError
            If the trial is not pending.
        """
        trial = suggestion.trial if isinstance(suggestion, Suggestion) else suggestion
        asked = next((s for s in self.pending if s.trial == trial), None)
        if asked is None:
            known = ", ".join(str(s.trial) for s in self.pending) or "none; call ask() first"
            raise UsageError(f"tell: trial {trial} is not pending (pending: {known})")
        outcome = Outcome(state=State.FAILED, error=error or "no result was told")
        if result is not None:
            names = [o.name for o in self.scenario.objectives]
            outcome = outcome_of(result, names, self.scenario.feasible_output)
        evaluation = Evaluation(
            suggestion=asked, state=outcome.state, values=outcome.values, error=error or outcome.error
        )
        self._optimizer.tell([evaluation])
        return evaluation

    def pareto_front(self) -> list[Evaluation]:
        """Return the non-dominated trials, in order; for one objective the best, with its ties.

        A configuration that was confirmed counts, and stands here, with the mean over all its replicates.
        """
        completed = [e for e in pooled(self.history) if e.is_completed]
        keep = non_dominated(objectives_of(completed, self.history.objectives))
        return [evaluation for evaluation, is_optimal in zip(completed, keep, strict=True) if is_optimal]
