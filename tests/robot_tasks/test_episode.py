"""Tests for episode.py."""

import dataclasses

import numpy as np
import pytest


def test_steps_are_the_intervals_between_samples(make_episode):
    assert make_episode(np.zeros((121, 3))).n_steps == 120


def test_success_means_a_success_time(make_episode):
    assert make_episode(np.zeros((3, 3)), success_time=0.0).is_success
    assert not make_episode(np.zeros((3, 3))).is_success


def test_arrays_of_other_lengths_are_refused(make_episode):
    with pytest.raises(ValueError, match=r"Episode.tip_positions: expected shape \(3, 3\) for 3 times, got \(2, 3\)"):
        dataclasses.replace(make_episode(np.zeros((3, 3))), tip_positions=np.zeros((2, 3)))
