"""Tests for client_server.py, over pipes; the whole program is tested in tests/cli/test_client_server.py."""

import os
import threading

import pytest

from hypermap_lite.errors import ClientError
from hypermap_lite.evaluation.channel import Channel
from hypermap_lite.evaluation.client_server import ClientExecutor, ClientServer
from hypermap_lite.evaluation.outcome import State
from hypermap_lite.objectives import FeasibleOutput
from hypermap_lite.space import IntegerParameter, RealParameter, SearchSpace
from tests.evaluation.examples import request

SPACE = SearchSpace((RealParameter(name="x", low=-2.0, high=2.0), IntegerParameter(name="n", low=0, high=9)))
ASKED = ({"x": 0.1, "n": 1}, {"x": 0.2, "n": 2}, {"x": 0.3, "n": 3})


class Client(threading.Thread):
    """Reads a request of three rows, answers with a fixed text, and closes its output."""

    def __init__(self, reply: str, *, closes: bool = True) -> None:
        super().__init__(daemon=True)
        self._reply = reply
        self._closes = closes
        inbox, self._to = os.pipe()
        self._from, outbox = os.pipe()
        self.channel = Channel(inbox, outbox)
        self.heard = b""
        self.start()

    def run(self) -> None:
        while self.heard.count(b"\n") < 5:
            self.heard += os.read(self._from, 1000)
        os.write(self._to, self._reply.encode())
        if self._closes:
            os.close(self._to)


def exchange(tmp_path, client, *, feasible=None, timeout=None, asked=ASKED):
    evaluator = ClientServer(objectives=("f",), space=SPACE, feasible_output=feasible)
    requests = [request(tmp_path, trial=i, **configuration) for i, configuration in enumerate(asked)]
    return ClientExecutor(client.channel, timeout).run(evaluator, requests)


def test_request_is_to_the_letter(tmp_path):
    client = Client("x,n,f\n0.1,1,5\n0.2,2,6\n0.3,3,7\n")
    records = list(exchange(tmp_path, client))
    assert client.heard == b"Request 3\nx,n\n0.1,1\n0.2,2\n0.3,3\n"
    assert [(r.trial, r.outcome.values, r.configuration) for r in records] == [
        (0, {"f": 5.0}, ASKED[0]),
        (1, {"f": 6.0}, ASKED[1]),
        (2, {"f": 7.0}, ASKED[2]),
    ]


@pytest.mark.parametrize(
    "reply",
    [
        pytest.param("f,n,x\n5,1,0.1\n6,2,0.2\n7,3,0.3\n", id="columns in another order"),
        pytest.param("x,n,note,f\n0.1,1,a,5\n0.2,2,b,6\n0.3,3,,7\n", id="extra column"),
        pytest.param("x,n,f\n0.1000001,1.0,5\n0.2,2,6\n0.3,3,7\n", id="rounded echo"),
        pytest.param("x,n,f\n0.3,3,7\n0.1,1,5\n0.2,2,6\n", id="rows in another order"),
        pytest.param("\nx, n, f\r\n\n0.1, 1, 5\r\n0.2,2,6\n \n0.3,3,7\n", id="blanks and blank lines"),
    ],
)
def test_reply_may_differ_in_form(tmp_path, reply):
    records = {r.trial: r for r in exchange(tmp_path, Client(reply))}
    assert {trial: r.outcome.values["f"] for trial, r in records.items()} == {0: 5.0, 1: 6.0, 2: 7.0}
    assert [records[i].configuration for i in range(3)] == list(ASKED)


HEAD = "x,n,f\n0.1,1,5\n"


@pytest.mark.parametrize(
    ("reply", "says"),
    [
        pytest.param("", "closed its output before the header of its reply", id="nothing"),
        pytest.param("x,n\n", "has no column 'f'", id="missing column"),
        pytest.param(HEAD, "closed its output before row 2 of 3", id="too few rows"),
        pytest.param(HEAD + "0.2,2,6.", "stopped in the middle of a line: '0.2,2,6.'", id="torn row"),
        pytest.param(HEAD + "0.2,2\n", "has 2 fields, its header 3: '0.2,2'", id="too few fields"),
        pytest.param(HEAD + "0.2,2,6,7\n", "has 4 fields, its header 3", id="too many fields"),
        pytest.param(HEAD + "0.2,2,bad\n", "'f' is 'bad', not a number", id="not a number"),
        pytest.param(HEAD + "0.2,4,6\n", "row 2 of the client's reply is not what was asked for: n is 4", id="echo"),
        pytest.param(HEAD + "0.1,1,6\n", "not what was asked for: x is 0.1, asked for 0.2; n is 1", id="same twice"),
    ],
)
def test_wrong_reply_is_an_error_that_says_what_is_wrong(tmp_path, reply, says):
    with pytest.raises(ClientError) as caught:
        list(exchange(tmp_path, Client(reply)))
    assert says in str(caught.value)
    assert "hint: Everything that was read before is kept" in str(caught.value)


def test_rows_before_an_error_are_handed_over_first(tmp_path):
    calls = exchange(tmp_path, Client(HEAD + "0.2,2\n"))
    assert next(calls).outcome.values == {"f": 5.0}
    with pytest.raises(ClientError, match="has 2 fields"):
        next(calls)


def test_row_is_handed_over_while_the_client_works_on_the_next(tmp_path):
    calls = exchange(tmp_path, Client(HEAD, closes=False), timeout=30)
    assert next(calls).outcome.values == {"f": 5.0}
    calls.close()


def test_late_reply_is_an_error(tmp_path):
    calls = exchange(tmp_path, Client(HEAD, closes=False), timeout=0.3)
    next(calls)
    with pytest.raises(ClientError, match=r"was not complete within its time limit of 0\.3 s"):
        next(calls)


def test_more_rows_than_asked_for_are_an_error_at_the_next_request(tmp_path):
    client = Client("x,n,f\n0.1,1,5\n0.2,2,6\n0.3,3,7\n0.4,4,8\n", closes=False)
    list(exchange(tmp_path, client))
    with pytest.raises(ClientError, match=r"has sent more than it was asked for: '0\.4,4,8'"):
        list(exchange(tmp_path, client))


def test_value_that_is_not_finite_is_a_failed_evaluation(tmp_path):
    reply = "x,n,f\n0.1,1,nan\n0.2,2,6\n0.3,3,-inf\n"
    assert [r.outcome.state for r in exchange(tmp_path, Client(reply))] == [
        State.FAILED,
        State.COMPLETED,
        State.FAILED,
    ]


def test_feasibility_is_answered_by_its_texts(tmp_path):
    column = FeasibleOutput(name="ok", true_value="1", false_value="0")
    reply = "x,n,f,ok\n0.1,1,5,1\n0.2,2,6,0\n0.3,3,7,yes\n"
    calls = exchange(tmp_path, Client(reply), feasible=column)
    assert [next(calls).outcome.state for _ in range(2)] == [State.COMPLETED, State.INFEASIBLE]
    with pytest.raises(ClientError, match="'ok' is 'yes', neither '1' nor '0'"):
        next(calls)


def test_end_is_one_line_and_a_client_that_is_gone_no_error():
    inbox, outbox = os.pipe()
    executor = ClientExecutor(Channel(inbox, outbox))
    executor.say_goodbye()
    assert os.read(inbox, 100) == b"End of HyperMapper\n"
    os.close(inbox)
    executor.say_goodbye()
    os.close(outbox)


def test_error_says_which_command_goes_on_and_which_begins_anew(tmp_path):
    with pytest.raises(ClientError) as caught:
        list(exchange(tmp_path, Client("x,n,f\n0.1,1,5\n")))
    hint = "`python -m hypermap_lite SCENARIO` asks for the rest, `hypermapper SCENARIO` begins anew"
    assert hint in str(caught.value)
