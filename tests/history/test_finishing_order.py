"""The order in which the configurations of an asynchronous run finished."""

from pathlib import Path

import pytest

from hypermap_lite.errors import RunFolderError
from hypermap_lite.evaluation.outcome import Evaluation
from hypermap_lite.history.finishing_order import as_learnt, in_finishing_order, read_as_learnt
from hypermap_lite.history.history import History
from tests.history.examples import OBJECTIVES, SPACE, evaluation


def trials_of(evaluations: list[Evaluation]) -> list[int]:
    return [e.trial for e in evaluations]


def test_the_last_call_counts_and_those_without_one_come_first() -> None:
    rows = [evaluation(trial) for trial in (0, 1, 2, 3, 4)]
    assert trials_of(in_finishing_order(rows, [3, 2, 4, 2, 3])) == [0, 1, 4, 2, 3]


@pytest.mark.parametrize(("in_order", "expected"), [(True, [0, 1, 2]), (False, [2, 0, 1])])
def test_a_history_in_order_has_them_in_that_of_the_trials(in_order: bool, expected: list[int]) -> None:
    history = History(SPACE, OBJECTIVES, in_order=in_order)
    assert trials_of(as_learnt(history, [evaluation(trial) for trial in range(3)], [2, 0, 1])) == expected


def test_a_damaged_file_of_calls_is_named(tmp_path: Path) -> None:
    (tmp_path / "evaluations.csv").write_text("trial,replicate\nfirst,0\n")
    with pytest.raises(RunFolderError, match=r"evaluations\.csv: record 2 cannot be read"):
        read_as_learnt(tmp_path, History(SPACE, OBJECTIVES, in_order=False))
