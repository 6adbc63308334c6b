"""Tests for batch_plan.py."""

import pytest

from hypermap_lite.evaluation.batch_plan import BatchPlan


def cuts(plan, n):
    ends, trial = [], 0
    while trial < n:
        trial = plan.end_of_batch(trial)
        ends.append(trial)
    return ends


def test_batches_are_of_equal_size():
    assert cuts(BatchPlan(size=3), 9) == [3, 6, 9]


@pytest.mark.parametrize(
    ("first", "ends"), [(5, [5, 8, 11]), (2, [2, 5, 8, 11]), (3, [3, 6, 9, 12])], ids=["larger", "smaller", "equal"]
)
def test_first_batch_may_have_a_size_of_its_own(first, ends):
    assert cuts(BatchPlan(size=3, first=first), 10) == ends


def test_end_of_a_batch_is_the_same_from_anywhere_in_it():
    plan = BatchPlan(size=3, first=5)
    assert [plan.end_of_batch(trial) for trial in range(9)] == [5] * 5 + [8] * 3 + [11]


def test_only_whole_batches_count():
    plan = BatchPlan(size=3, first=5)
    assert [plan.n_in_whole_batches(n) for n in range(12)] == [0] * 5 + [5] * 3 + [8] * 3 + [11]
