"""The program that makes one run of a study, in a process of its own.

It reports on stdout, a JSON object per line: evaluations done and their number. It ends in order when it is sent
SIGINT, and at once, with all it has saved, when it is sent SIGTERM or when its stdin closes: then the study has died.
Failures at the end of an earlier session are evaluated again, as by ``run --retry-failed``: a run that goes on with a
black box that was mended shall not differ from one that never failed.
"""

from __future__ import annotations

import json
import logging
import os
import signal
import sys
import threading
from types import FrameType
from typing import TextIO

from hypermap_lite.errors import HypermapLiteError
from hypermap_lite.evaluation.observer import RunObserver
from hypermap_lite.evaluation.outcome import Evaluation
from hypermap_lite.evaluation.runner import StopReason
from hypermap_lite.run import run_scenario
from hypermap_lite.scenario import load_scenario

INTERRUPTED = 130
TERMINATED = 143


def main(request: str) -> int:
    """Make the run that a request, ``{"scenario": FILE, "overrides": [...]}`` in JSON, asks for; return the status."""
    is_stopping = threading.Event()

    def interrupt(number: int, frame: FrameType | None) -> None:
        is_stopping.set()

    def terminate(number: int, frame: FrameType | None) -> None:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # another one, as when stdin closes, shall not disturb the end
        raise SystemExit(TERMINATED)

    signal.signal(signal.SIGINT, interrupt)
    signal.signal(signal.SIGTERM, terminate)
    threading.Thread(target=_end_with_the_study, daemon=True).start()
    logging.getLogger("hypermap_lite").addHandler(logging.NullHandler())  # run.log has it; stderr is for the error
    content = json.loads(request)
    try:
        scenario = load_scenario(content["scenario"], overrides=content["overrides"])
        result = run_scenario(
            scenario, observer=_Reporter(sys.stdout), should_stop=is_stopping.is_set, retry_failed=True
        )
    except HypermapLiteError as error:
        sys.stderr.write(str(error))
        return error.exit_code
    return INTERRUPTED if result.stop_reason is StopReason.INTERRUPTED else 0


def _end_with_the_study() -> None:
    """Wait until stdin closes and then end this process in order."""
    while os.read(0, 1024):
        pass
    os.kill(os.getpid(), signal.SIGTERM)


class _Reporter(RunObserver):
    """Writes a line after every evaluation."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._total = 0

    def on_start(self, *, done: int, total: int) -> None:
        """Report where the run stands at the beginning."""
        self._total = total
        self._report(done)

    def on_evaluation(self, evaluation: Evaluation, front: str) -> None:
        """Report a finished evaluation."""
        self._report(evaluation.trial + 1)

    def _report(self, done: int) -> None:
        self._stream.write(json.dumps({"done": done, "total": self._total}) + "\n")
        self._stream.flush()
