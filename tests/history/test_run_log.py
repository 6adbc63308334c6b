"""Tests for run_log.py."""

import logging
import re

import pytest

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.run_log import run_log


def test_log_lines_carry_utc_time_and_level_and_add_up(tmp_path):
    for text in ("first", "second"):
        with run_log(tmp_path / "run.log"):
            logging.getLogger("hypermap_lite.evaluation.runner").info("%s", text)
    lines = (tmp_path / "run.log").read_text().splitlines()
    assert [line.split(" ", 1)[1] for line in lines] == ["INFO first", "INFO second"]
    assert re.match(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z ", lines[0])


def test_logger_is_left_as_it_was(tmp_path):
    package = logging.getLogger("hypermap_lite")
    before = (package.level, list(package.handlers))
    with run_log(tmp_path / "run.log"):
        assert package.isEnabledFor(logging.INFO)
    assert (package.level, list(package.handlers)) == before


def test_full_disk_does_not_stop_the_run(tmp_path, capsys):
    with run_log(tmp_path / "run.log"):
        (handler,) = [h for h in logging.getLogger("hypermap_lite").handlers if isinstance(h, logging.FileHandler)]
        full = open("/dev/full", "w")  # noqa: SIM115 - closed by the handler
        handler.setStream(full).close()
        logging.getLogger("hypermap_lite").info("story")
    assert capsys.readouterr().err == ""


def test_log_that_cannot_be_opened_is_an_error(tmp_path):
    with pytest.raises(RunFolderError, match="cannot be written: Is a directory"), run_log(tmp_path):
        pass
