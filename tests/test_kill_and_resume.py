"""A run killed at any moment goes on as if it had not been; see benchmarks/kill_test.py."""

import random

import pytest

from benchmarks.kill_test import CASES, kill_case
from tests.slow import slow_after

QUICK = {"optimizer": "random_search", "budget": {"evaluations": 8, "batch_size": 3}}


@pytest.mark.parametrize("name", slow_after(1, sorted(CASES, reverse=True)))
def test_killed_run_ends_with_the_rows_of_one_that_was_not(tmp_path, name):
    for kill in kill_case({**CASES[name], **QUICK}, 1, tmp_path, random.Random(name)):
        assert (kill.lost, kill.repeated, kill.differing) == (0, 0, 0)


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_twenty_random_kills_lose_nothing(tmp_path, name):
    for kill in kill_case(CASES[name], 20, tmp_path, random.Random(name)):
        assert (kill.lost, kill.repeated, kill.differing) == (0, 0, 0)
