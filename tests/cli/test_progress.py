"""Tests for progress.py."""

import io
import logging

import pytest

from hypermap_lite.cli.progress import BarObserver, progress
from hypermap_lite.evaluation.outcome import Evaluation, Outcome, Replicate, State, Suggestion

logger = logging.getLogger("hypermap_lite.evaluation.runner")


class Terminal(io.StringIO):
    def isatty(self):
        return True


def evaluation(trial):
    suggestion = Suggestion(trial=trial, configuration={"x": 1.0}, phase="model")
    return Evaluation(suggestion=suggestion, state=State.COMPLETED, values={"f": 1.5})


def replicate(trial):
    outcome = Outcome(state=State.COMPLETED, values={"f": 1.5})
    return Replicate(trial=trial, replicate=0, seed=1, configuration={"x": 1.0}, outcome=outcome, seconds=0.1)


@pytest.mark.parametrize(
    ("options", "lines"),
    [
        ({}, ["story", "warning: careful"]),
        ({"is_quiet": True}, ["warning: careful"]),
        ({"is_verbose": True}, ["detail", "story", "warning: careful"]),
    ],
    ids=["plain", "quiet", "verbose"],
)
def test_without_a_terminal_the_log_comes_as_plain_lines(options, lines):
    stream = io.StringIO()
    with progress(stream=stream, **options):
        logger.debug("detail")
        logger.info("story")
        logger.warning("careful")
    assert stream.getvalue().splitlines() == lines


def test_terminal_gets_a_bar_with_warnings_above_it(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "160")
    stream = Terminal()
    with progress(stream=stream) as observer:
        assert isinstance(observer, BarObserver)
        observer.on_start(done=2, total=8)
        observer.on_suggestions([2, 3], 2)
        observer.on_replicate(replicate(2))
        observer.on_evaluation(evaluation(2), "front +1")
        logger.info("story")
        logger.warning("careful [not markup]")
        observer.on_suggestions([4], 1)
    text = stream.getvalue()
    assert "3/8" in text
    assert "trial 4" in text
    assert "front +1 at trial 2: f 1.5" in text
    assert "warning: careful [not markup]" in text
    assert "story" not in text


def test_no_color_is_respected(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("NO_COLOR", "1")
    stream = Terminal()
    with progress(stream=stream) as observer:
        observer.on_start(done=2, total=8)
    assert "\x1b[3" not in stream.getvalue()


@pytest.mark.parametrize("options", [{"is_quiet": True}, {}], ids=["quiet", "dumb"])
def test_no_bar_where_it_is_not_wanted_or_cannot_be_drawn(monkeypatch, options):
    monkeypatch.setenv("TERM", "xterm" if options else "dumb")
    with progress(stream=Terminal(), **options) as observer:
        assert not isinstance(observer, BarObserver)


def test_logger_is_left_as_it_was():
    package = logging.getLogger("hypermap_lite")
    before = (package.level, list(package.handlers))
    with progress(stream=io.StringIO(), is_verbose=True):
        pass
    assert (package.level, list(package.handlers)) == before
