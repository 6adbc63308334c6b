"""Tests for fixed_success.py."""

import numpy as np
import pytest

from robot_tasks.rewards import FixedSuccess


@pytest.mark.parametrize("success_time", [0.0, 6.9, 11.98])
def test_the_bonus_counts_on_every_step_whenever_the_success_came(make_episode, success_time):
    rewards = FixedSuccess(value=8.0)(make_episode(np.zeros((121, 3)), success_time=success_time))
    assert rewards.tolist() == [8.0] * 120


def test_without_success_there_is_no_bonus(make_episode):
    assert FixedSuccess(value=8.0)(make_episode(np.zeros((121, 3)))).tolist() == [0.0] * 120
