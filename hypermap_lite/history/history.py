"""The record of a run in memory: append-only, in the order of the trials, or in that in which they finished."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.outcome import Evaluation
from hypermap_lite.history.pooling import as_one, groups_of, key_of, pooled
from hypermap_lite.history.replicate_noise import shrunk_variances
from hypermap_lite.objectives import Objective, values_of
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import BoolArray, FloatArray, IntArray

LARGEST = 1e150
"""Size at which objective values are cut for the models; the files keep them as they are."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Samples:
    """What is known of n distinct completed configurations by all their replicates."""

    X: FloatArray
    """Codes, shape (n, d), in the order in which each was first evaluated."""

    Y: FloatArray
    """Means over all replicates, to be minimized, shape (n, m)."""

    replicates: IntArray
    """Number of replicates, shape (n,)."""

    variances: FloatArray | None
    """Of single replicates, shrunk towards what is usual, shape (n, m); None where there is one replicate everywhere,
    or the spread of an objective is not known at all."""

    freedom: FloatArray
    """Degrees of freedom of each configuration's own sample variance, shape (n, m)."""

    own_variances: FloatArray
    """These sample variances, shape (n, m); zero without a degree of freedom."""

    @property
    def noise_variance(self) -> FloatArray | None:
        """Variance of each mean, in the objectives' units squared, shape (n, m); None where the noise is not known."""
        return None if self.variances is None else self.variances / self.replicates[:, None]


class History:
    """All finished evaluations of a run, trial 0 first, without gaps.

    Parameters
    ----------
    space, objectives
        What they are of.
    in_order
        Whether they stand in the order of their trials. If not, they stand in that in which they are added: that of an
        asynchronous run, where a later trial does not wait for an earlier one.
    """

    def __init__(self, space: SearchSpace, objectives: Sequence[Objective], *, in_order: bool = True) -> None:
        self.space = space
        self.objectives = tuple(objectives)
        self.in_order = in_order
        self._evaluations: list[Evaluation] = []
        self._kept: dict[str, tuple[int, FloatArray]] = {}

    def append(self, evaluation: Evaluation) -> None:
        """Add the next evaluation.

        Raises
        ------
        UsageError
            If its trial number is not the next one (or, in any order, is there already), or it is not of this space and
            these objectives.
        """
        if self.in_order and evaluation.trial != len(self):
            raise UsageError(f"trial {evaluation.trial} cannot be recorded: the next trial is {len(self)}")
        self.check(evaluation)
        self._evaluations.append(evaluation)

    def check(self, evaluation: Evaluation) -> None:
        """Make sure that an evaluation can be added, now or when those of the trials before it are there.

        Raises
        ------
        UsageError
            If its trial is there already, or it is not of this space and these objectives.
        """
        trial = evaluation.trial
        is_there = trial < len(self) if self.in_order else any(e.trial == trial for e in self._evaluations)
        if is_there:
            raise UsageError(f"trial {trial} cannot be recorded: it is there already")
        if not self.space.contains(evaluation.configuration):
            raise UsageError(f"trial {trial} is not of this search space: {dict(evaluation.configuration)}")
        missing = [o.name for o in self.objectives if o.name not in evaluation.values]
        if evaluation.is_completed and missing:
            raise UsageError(f"trial {trial} has no value of the objective '{missing[0]}'")

    def extend(self, evaluations: Iterable[Evaluation]) -> None:
        """Add several evaluations in order."""
        for evaluation in evaluations:
            self.append(evaluation)

    def __len__(self) -> int:
        return len(self._evaluations)

    def __iter__(self) -> Iterator[Evaluation]:
        return iter(self._evaluations)

    def __getitem__(self, position: int) -> Evaluation:
        return self._evaluations[position]

    @property
    def completed(self) -> list[Evaluation]:
        """Those with objective values, in the history's order."""
        return [e for e in self._evaluations if e.is_completed]

    def X(self) -> FloatArray:  # noqa: N802 - the field's name
        """Return the codes of the completed evaluations, shape (n, d)."""
        return self._once("X", lambda: self.space.encode([e.configuration for e in self.completed]))

    def Y(self) -> FloatArray:  # noqa: N802 - the field's name
        """Return the objectives of the completed evaluations, to be minimized, shape (n, m).

        Values beyond 1e150 in size are cut there: models square them.
        """
        return self._once("Y", lambda: objectives_of(self.completed, self.objectives))

    def samples(self, n_rows: int | None = None) -> Samples:
        """Return the distinct completed configurations with all their replicates pooled.

        What `pooled` counts as completed, with the rows of one configuration as one whatever their phase. So the
        configurations are those that may be confirmed: one of which a row failed counts by its completed rows, and is
        left out only once it was confirmed.

        Parameters
        ----------
        n_rows
            Look at the first so many rows only.
        """
        rows = [row for row in pooled(self._evaluations[:n_rows]) if row.is_completed]
        groups = groups_of(key_of(row.configuration) for row in rows)
        known = [as_one([rows[i] for i in group]) for group in groups]
        names = [o.name for o in self.objectives]
        shape = (len(known), len(names))
        errors = np.array([[e.standard_errors.get(name, math.nan) for name in names] for e in known]).reshape(shape)
        replicates = np.array([e.replicates for e in known], dtype=int)
        is_known = np.isfinite(errors) & (replicates[:, None] > 1)
        own = np.where(is_known, np.minimum(np.where(is_known, errors, 0.0), LARGEST) ** 2 * replicates[:, None], 0.0)
        freedom = np.where(is_known, replicates[:, None] - 1.0, 0.0)
        return Samples(
            X=self.space.encode([e.configuration for e in known]),
            Y=objectives_of(known, self.objectives),
            replicates=replicates,
            variances=shrunk_variances(own, freedom),
            freedom=freedom,
            own_variances=own,
        )

    def ends_of_samples(self) -> list[int]:
        """Return after how many rows there were 1, 2, ... distinct configurations that had completed."""
        ends, seen = [], set()
        for i, row in enumerate(self._evaluations):
            if row.is_completed and (key := key_of(row.configuration)) not in seen:
                seen.add(key)
                ends.append(i + 1)
        return ends

    def feasibility(self, *, learn_failed: bool = False) -> tuple[FloatArray, BoolArray]:
        """Return the codes of the evaluations that tell of feasibility, shape (n, d), and which are feasible, (n,).

        Those that completed or were infeasible; on request those too that failed or ran out of time, as infeasible.
        """
        known = self._evaluations if learn_failed else [e for e in self if e.state.is_feasible is not None]
        X = self.space.encode([e.configuration for e in known])
        return X, np.array([e.is_completed for e in known], dtype=bool)

    def X_all(self) -> FloatArray:  # noqa: N802 - the field's name
        """Return the codes of all evaluations, whatever their state, shape (len(self), d)."""
        return self._once("X_all", lambda: self.space.encode([e.configuration for e in self._evaluations]))

    def _once(self, name: str, make: Callable[[], FloatArray]) -> FloatArray:
        """Return a copy of what is made of the evaluations, which is made anew only once there are more of them."""
        n, made = self._kept.get(name, (-1, np.empty(0)))
        if n != len(self):
            made = make()
            self._kept[name] = len(self), made
        return made.copy()


def objectives_of(evaluations: Sequence[Evaluation], objectives: Sequence[Objective]) -> FloatArray:
    """Return the objectives of evaluations with all of them, to be minimized and cut at 1e150 in size, shape (n, m)."""
    rows = [values_of(objectives, e.values) for e in evaluations]
    return np.clip(np.array(rows).reshape(len(rows), len(objectives)), -LARGEST, LARGEST)
