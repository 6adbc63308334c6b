"""Black boxes that take a whole batch in one call: the call, its answer, and who makes it."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

from hypermap_lite.evaluation.evaluator import EvaluationRequest, Evaluator, answer
from hypermap_lite.evaluation.executors import Executor
from hypermap_lite.evaluation.outcome import Outcome, Replicate, State


@dataclass(frozen=True, slots=True, kw_only=True)
class BatchRequest(EvaluationRequest):
    """All calls of a batch as one; what it has in common with a single request is that of the first."""

    requests: tuple[EvaluationRequest, ...]

    @classmethod
    def of(cls, requests: Sequence[EvaluationRequest]) -> BatchRequest:
        """Return the one call for at least one request."""
        first = requests[0]
        return cls(
            trial=first.trial,
            replicate=first.replicate,
            seed=first.seed,
            configuration=first.configuration,
            directory=first.directory,
            requests=tuple(requests),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class BatchOutcome(Outcome):
    """The answer to a `BatchRequest` that could be read: an outcome per request."""

    outcomes: tuple[Outcome, ...] = ()


class BatchExecutor:
    """Makes all calls of a batch as one, wherever another executor makes its calls.

    If that one call fails or runs past the time limit, all configurations of the batch do.
    """

    is_one_call: ClassVar[bool] = True

    def __init__(self, inner: Executor) -> None:
        self.inner = inner

    def run(self, evaluator: Evaluator, requests: Iterable[EvaluationRequest]) -> Generator[Replicate, None, None]:
        """Yield the record of each request, in their order; they share the duration of the call evenly."""
        batch = list(requests)
        if batch:
            for record in self.inner.run(evaluator, [BatchRequest.of(batch)]):
                yield from _split(record, batch)

    def close(self) -> None:
        """Close the other executor."""
        self.inner.close()


def _split(record: Replicate, batch: Sequence[EvaluationRequest]) -> Iterator[Replicate]:
    outcome = record.outcome
    if isinstance(outcome, BatchOutcome):
        outcomes = outcome.outcomes
    else:
        outcomes = (_of_the_whole_batch(outcome, batch),) * len(batch)
    for request, own in zip(batch, outcomes, strict=True):
        yield answer(request, own, record.seconds / len(batch))


def _of_the_whole_batch(outcome: Outcome, batch: Sequence[EvaluationRequest]) -> Outcome:
    if outcome.state is State.COMPLETED or len(batch) == 1:
        return outcome
    trials = f"{batch[0].trial} to {batch[-1].trial}"
    return replace(outcome, error=f"{outcome.error} (the one call for trials {trials})")
