"""What every kind of black box in the table promises."""

import pickle

import pytest

from hypermap_lite.evaluation import EVALUATORS
from hypermap_lite.evaluation.executors import InProcessExecutor, ProcessExecutor
from hypermap_lite.evaluation.outcome import State
from hypermap_lite.space import IntegerParameter, SearchSpace
from tests.evaluation.examples import request

TABLE = "x,f,g,note\n4,1,2,\n5.0,6,4,yes\n"

SPACE = SearchSpace((IntegerParameter(name="x", low=0, high=9),))

OPTIONS = {
    "python": {"function": "tests.evaluation.black_boxes:sum_and_difference"},
    "command": {"command": ["sh", "-c", """echo "{\\"f\\": $(({x} + 1)), \\"g\\": $(({x} - 1))}" """]},
    "client_server": {"space": SPACE},
    "exhaustive": {"file": "table.csv", "space": SPACE},
}

CALLABLE = [kind for kind in EVALUATORS if kind != "client_server"]
"""Those that answer a call by themselves."""


@pytest.fixture(params=EVALUATORS)
def kind(request):
    return request.param


@pytest.fixture(autouse=True)
def table(tmp_path, monkeypatch):
    """Put the table where it is looked for."""
    (tmp_path / "table.csv").write_text(TABLE)
    monkeypatch.chdir(tmp_path)


def make(kind, **more):
    return EVALUATORS[kind](objectives=("f", "g"), **OPTIONS[kind], **more)


@pytest.mark.parametrize("kind", CALLABLE)
@pytest.mark.parametrize("executor", [InProcessExecutor, lambda: ProcessExecutor(1)], ids=["here", "worker"])
def test_answer_is_the_same_here_and_in_a_worker(kind, executor, tmp_path):
    open_executor = executor()
    try:
        (record,) = open_executor.run(make(kind), [request(tmp_path, x=5)])
    finally:
        open_executor.close()
    assert (record.outcome.state, record.outcome.values) == (State.COMPLETED, {"f": 6.0, "g": 4.0})
    assert (record.trial, record.replicate, record.seed, record.configuration) == (0, 0, 11, {"x": 5})


def test_client_is_asked_over_its_channel_only(tmp_path):
    (record,) = InProcessExecutor().run(make("client_server"), [request(tmp_path, x=5)])
    assert (record.outcome.state, record.outcome.error) == (
        State.FAILED,
        "a client is asked over stdin and stdout only",
    )


def test_copy_made_by_pickling_is_equal(kind):
    assert pickle.loads(pickle.dumps(make(kind))) == make(kind)


def test_unknown_option_is_refused(kind):
    with pytest.raises(TypeError, match="unexpected keyword argument 'no_such_option'"):
        make(kind, no_such_option=1)
