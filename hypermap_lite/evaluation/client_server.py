"""A black box at the other end of stdin and stdout: a client that started this process and answers its requests."""

from __future__ import annotations

import logging
import time
from collections.abc import Generator, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar, Final

from hypermap_lite.errors import ClientError
from hypermap_lite.evaluation.channel import Channel
from hypermap_lite.evaluation.echoes import differences, find_request
from hypermap_lite.evaluation.evaluator import EvaluationRequest, Evaluator, answer, failure
from hypermap_lite.evaluation.outcome import Outcome, Replicate
from hypermap_lite.evaluation.wire import END, ReplyFormat, fields_of, request_lines
from hypermap_lite.objectives import FeasibleOutput
from hypermap_lite.space.search_space import SearchSpace

logger = logging.getLogger(__name__)

ADVICE: Final = (
    "\n  hint: Everything that was read before is kept; `python -m hypermap_lite SCENARIO` asks for the rest, "
    "`hypermapper SCENARIO` begins anew."
)

GOODBYE_SECONDS: Final = 5.0
"""How long a client may take to read the last line [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ClientServer:
    """Speaks HyperMapper's protocol with the process that started this one [1]_.

    It is only asked by a `ClientExecutor`, which holds the connection.

    References
    ----------
    .. [1] Nardi, Koeplinger, Olukotun. Practical Design Space Exploration. MASCOTS 2019 (HyperMapper).
    """

    objectives: Sequence[str]
    """Names of the objectives."""

    space: SearchSpace
    """What is asked for, and in which order the columns stand."""

    feasible_output: FeasibleOutput | None = None
    """The column of the reply that says what is feasible, if there is one."""

    def __call__(self, request: EvaluationRequest) -> Outcome:
        """Return a failure: without its connection it has nobody to ask."""
        return failure("a client is asked over stdin and stdout only")

    def exchange(
        self, requests: Sequence[EvaluationRequest], channel: Channel, timeout_seconds: float | None = None
    ) -> Iterator[Replicate]:
        """Ask for some configurations in one request, and yield each as soon as its row has been read.

        Raises
        ------
        ClientError
            If the client does not read, closes its output, is late, or answers something else than was asked for.
        """
        deadline = None if timeout_seconds is None else time.monotonic() + timeout_seconds
        try:
            self._ask(requests, channel, deadline)
            yield from self._rows(requests, channel, deadline)
        except TimeoutError:
            late = f"the client's reply was not complete within its time limit of {timeout_seconds:g} s"
            raise ClientError(late + ADVICE) from None
        except ClientError as error:
            raise ClientError(str(error) + ADVICE) from None

    def _ask(self, requests: Sequence[EvaluationRequest], channel: Channel, deadline: float | None) -> None:
        if surplus := channel.line_too_many():
            raise ClientError(f"the client has sent more than it was asked for: {surplus[:80]!r}")
        for line in request_lines(self.space, [request.configuration for request in requests]):
            channel.write_line(line, deadline)

    def _rows(
        self, requests: Sequence[EvaluationRequest], channel: Channel, deadline: float | None
    ) -> Iterator[Replicate]:
        form = ReplyFormat(parameters=self.space.names, objectives=self.objectives, feasible=self.feasible_output)
        before = time.perf_counter()
        header = fields_of(_next_line(channel, deadline, "the header of its reply"))
        form.check_header(header)
        waiting = dict(enumerate(requests))
        for position in range(len(requests)):
            line = _next_line(channel, deadline, f"row {position + 1} of {len(requests)}")
            row = _by_column(header, fields_of(line), line)
            configurations = {i: request.configuration for i, request in waiting.items()}
            found = find_request(self.space, configurations, row, position)
            if found is None:
                asked = requests[position].configuration
                wrong = "; ".join(differences(self.space, asked, row)) or "it was answered before"
                raise ClientError(f"row {position + 1} of the client's reply is not what was asked for: {wrong}")
            outcome = form.outcome(row)
            now = time.perf_counter()
            yield answer(waiting.pop(found), outcome, now - before)
            before = now


def _next_line(channel: Channel, deadline: float | None, what: str) -> str:
    """Return the next line that is not blank."""
    while (line := channel.read_line(deadline)) is not None:
        if line.strip():
            return line
    raise ClientError(f"the client closed its output before {what}")


def _by_column(header: Sequence[str], fields: Sequence[str], line: str) -> dict[str, str]:
    if len(fields) != len(header):
        problem = f"a row of the client's reply has {len(fields)} fields, its header {len(header)}"
        raise ClientError(f"{problem}: {line[:80]!r}")
    return dict(zip(header, fields, strict=True))


class ClientExecutor:
    """Puts each batch to the client as one request.

    Parameters
    ----------
    channel
        Connection to the client.
    timeout_seconds
        How long a whole reply may take [s]; None for as long as it likes.
    """

    is_one_call: ClassVar[bool] = True

    def __init__(self, channel: Channel, timeout_seconds: float | None = None) -> None:
        self._channel = channel
        self._timeout_seconds = timeout_seconds

    def run(self, evaluator: Evaluator, requests: Iterable[EvaluationRequest]) -> Generator[Replicate, None, None]:
        """Yield the record of each request as its row is read.

        Raises
        ------
        ClientError
            If the client breaks the protocol, is late, or is gone.
        """
        assert isinstance(evaluator, ClientServer)
        batch = list(requests)
        if batch:
            yield from evaluator.exchange(batch, self._channel, self._timeout_seconds)

    def say_goodbye(self) -> None:
        """Tell the client that the run has ended; one that is gone already is no error."""
        try:
            self._channel.write_line(END, time.monotonic() + GOODBYE_SECONDS)
        except ClientError as error:
            logger.info("the client did not wait for the end: %s", error)

    def close(self) -> None:
        """Do nothing: whoever made the channel closes it."""
