"""The record of what an asynchronous run has asked for."""

from pathlib import Path
from typing import Any

import pytest

from hypermap_lite.errors import RunFolderError
from hypermap_lite.evaluation.outcome import Suggestion
from hypermap_lite.history.suggestions import Asked, SuggestionLog
from tests.history.examples import SPACE, configuration


def asked(trial: int, **facts: Any) -> Asked:
    suggestion = Suggestion(trial=trial, configuration=configuration(force=trial / 7), phase="model", **facts)
    return Asked(suggestion=suggestion, known=max(trial - 2, 0))


def test_rows_read_back_as_they_were_written(tmp_path: Path) -> None:
    facts = {"prior_weight": 1 / 3, "prior_trust": 0.25, "prior_of": "cost, in all", "acquisition_value": -7.25}
    rows = [asked(0), asked(1, **facts, seconds=0.125)]
    log = SuggestionLog(tmp_path, SPACE)
    assert log.read() == []
    for row in rows:
        log.append(row)
    assert SuggestionLog(tmp_path, SPACE).read() == rows


def test_a_torn_last_row_is_dropped_and_written_over(tmp_path: Path) -> None:
    log = SuggestionLog(tmp_path, SPACE)
    for trial in range(3):
        log.append(asked(trial))
    log.path.write_bytes(log.path.read_bytes()[:-9])
    assert log.read() == [asked(0), asked(1)]
    log.append(asked(2))
    assert log.read() == [asked(0), asked(1), asked(2)]


def test_a_file_without_the_columns_of_priors_is_read_and_gets_them(tmp_path: Path) -> None:
    log = SuggestionLog(tmp_path, SPACE)
    first = asked(0, prior_weight=0.5, acquisition_value=2.0, seconds=0.125)
    log.append(first)
    header, row, _ = log.path.read_text().split("\n")
    assert ",prior_weight,prior_trust,prior_of," in header
    assert ",0.5,,,2.0," in row
    log.path.write_text(
        header.replace("prior_trust,prior_of,", "") + "\n" + row.replace(",0.5,,,2.0,", ",0.5,2.0,") + "\n"
    )
    assert log.read() == [first]
    second = asked(1, prior_trust=0.5, prior_of="cost")
    log.append(second)
    assert log.read() == [first, second]


def test_a_file_of_another_space_is_refused(tmp_path: Path) -> None:
    (tmp_path / "suggestions.csv").write_text("speed,trial\n1.5,0\n")
    with pytest.raises(RunFolderError, match="its columns are not those of this scenario"):
        SuggestionLog(tmp_path, SPACE).read()
