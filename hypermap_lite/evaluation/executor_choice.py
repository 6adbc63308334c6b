"""Where the calls of a black box happen."""

from __future__ import annotations

from hypermap_lite.evaluation.batches import BatchExecutor
from hypermap_lite.evaluation.channel import Channel
from hypermap_lite.evaluation.client_server import ClientExecutor, ClientServer
from hypermap_lite.evaluation.evaluator import Evaluator
from hypermap_lite.evaluation.executors import Executor, InProcessExecutor, ProcessExecutor
from hypermap_lite.evaluation.exhaustive import Exhaustive
from hypermap_lite.evaluation.python_function import PythonFunction
from hypermap_lite.evaluation.worker_process import pickled
from hypermap_lite.scenario.model import EvaluatorSpec


def choose_executor(evaluator: Evaluator, spec: EvaluatorSpec, channel: Channel | None, *, is_given: bool) -> Executor:
    """Choose where calls happen.

    A scenario's own black box always has processes of its own: its crash is not ours, and it dies with us. A function
    that was passed is called right here where that is possible, and a table is looked up here.
    """
    if isinstance(evaluator, ClientServer) and channel is not None:
        return ClientExecutor(channel, spec.timeout_seconds)
    if isinstance(evaluator, Exhaustive):
        return InProcessExecutor()
    is_batch = isinstance(evaluator, PythonFunction) and evaluator.batch
    n_workers = 1 if is_batch else spec.workers
    executor: Executor = InProcessExecutor()
    if not (is_given and n_workers == 1 and spec.timeout_seconds is None):
        pickled(evaluator)  # an error before the first evaluation, not at it
        executor = ProcessExecutor(n_workers, spec.timeout_seconds)
    return BatchExecutor(executor) if is_batch else executor
