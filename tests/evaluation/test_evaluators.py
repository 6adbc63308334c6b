"""What every kind of black box in the table promises."""

import pickle

import pytest

from hypermap_lite.evaluation import EVALUATORS
from hypermap_lite.evaluation.executors import InProcessExecutor, ProcessExecutor
from hypermap_lite.evaluation.outcome import State
from tests.evaluation.examples import request

OPTIONS = {
    "python": {"function": "tests.evaluation.black_boxes:sum_and_difference"},
    "command": {"command": ["sh", "-c", """echo "{\\"f\\": $(({x} + 1)), \\"g\\": $(({x} - 1))}" """]},
}


@pytest.fixture(params=EVALUATORS)
def kind(request):
    return request.param


def make(kind, **more):
    return EVALUATORS[kind](objectives=("f", "g"), **OPTIONS[kind], **more)


@pytest.mark.parametrize("executor", [InProcessExecutor, lambda: ProcessExecutor(1)], ids=["here", "worker"])
def test_answer_is_the_same_here_and_in_a_worker(kind, executor, tmp_path):
    open_executor = executor()
    try:
        (record,) = open_executor.run(make(kind), [request(tmp_path, x=5)])
    finally:
        open_executor.close()
    assert (record.outcome.state, record.outcome.values) == (State.COMPLETED, {"f": 6.0, "g": 4.0})
    assert (record.trial, record.replicate, record.seed, record.configuration) == (0, 0, 11, {"x": 5})


def test_copy_made_by_pickling_is_equal(kind):
    assert pickle.loads(pickle.dumps(make(kind))) == make(kind)


def test_unknown_option_is_refused(kind):
    with pytest.raises(TypeError, match="unexpected keyword argument 'no_such_option'"):
        make(kind, no_such_option=1)
