"""Tests for commanded_force.py, against numbers worked out by hand."""

import numpy as np
import pytest

from robot_tasks.rewards import CommandedForce, RewardTerm


def test_the_charge_is_the_sum_of_the_magnitudes_along_the_axes(make_episode):
    forces = [(9.0, 9.0, 9.0), (0.0, 0.0, -7.0), (1.0, -2.0, 3.0), (0.0, 0.0, 0.0)]
    episode = make_episode(np.zeros((4, 3)), commanded_forces=forces)
    assert CommandedForce()(episode).tolist() == [-7.0, -6.0, 0.0]


@pytest.mark.parametrize(("force", "total"), [(-20.0, -36000.0), (-1.0, -1800.0)])
def test_the_whole_range_of_a_search_force_has_the_published_size(make_episode, force, total):
    episode = make_episode(np.zeros((181, 3)), commanded_forces=np.full((181, 3), (0.0, 0.0, force)))
    assert RewardTerm(name="force", reward=CommandedForce(), weight=10.0).total(episode) == total
