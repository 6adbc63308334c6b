"""Tests for base.py."""

import numpy as np

from robot_tasks.rewards import FixedSuccess, RewardTerm


def test_a_term_is_the_weighted_sum_over_all_steps(make_episode):
    term = RewardTerm(name="bonus", reward=FixedSuccess(value=8.0), weight=0.5)
    assert term.total(make_episode(np.zeros((121, 3)), success_time=3.0)) == 480.0
