"""Tests for tracking_error.py, against numbers worked out by hand."""

from math import exp

import numpy as np
import pytest

from robot_tasks.rewards import NegativeTrackingBell, RewardTerm, TrackingError

TIPS = np.zeros((4, 3))
REFERENCES = [(9.0, 9.0, 9.0), (0.0, 0.0, 0.0), (0.02, -0.03, 0.06), (0.0, 0.4, -0.3)]  # 0, 0.07 and 0.5 m apart


def test_the_charge_is_the_distance_of_tip_and_reference(make_episode):
    assert TrackingError()(make_episode(TIPS, reference_positions=REFERENCES)) == pytest.approx([0.0, -0.07, -0.5])


def test_times_the_stiffness_it_is_the_force_of_the_spring(make_episode):
    term = RewardTerm(name="force", reward=TrackingError(), weight=700.0)
    references = np.tile((0.0, 0.0, 0.1), (121, 1))
    assert term.total(make_episode(np.zeros((121, 3)), reference_positions=references)) == pytest.approx(120 * -70.0)


def test_the_published_charge_is_a_bell_that_is_largest_without_an_error(make_episode):
    reward = NegativeTrackingBell(width=0.4, offset=0.25)
    rewards = reward(make_episode(TIPS, reference_positions=REFERENCES))
    assert rewards == pytest.approx([-0.4578, -exp(-(0.0049 + 0.25) / 0.32), -exp(-0.5 / 0.32)], abs=5e-5)
