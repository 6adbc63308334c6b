"""Tests for episode.py."""

import dataclasses

import numpy as np
import pytest

from robot_tasks.episode import ForceRecord


def test_steps_are_the_intervals_between_samples(make_episode):
    assert make_episode(np.zeros((121, 3))).n_steps == 120


def test_success_means_a_success_time(make_episode):
    assert make_episode(np.zeros((3, 3)), success_time=0.0).is_success
    assert not make_episode(np.zeros((3, 3))).is_success


def test_arrays_of_other_lengths_are_refused(make_episode):
    with pytest.raises(ValueError, match=r"Episode.tip_positions: expected shape \(3, 3\) for 3 times, got \(2, 3\)"):
        dataclasses.replace(make_episode(np.zeros((3, 3))), tip_positions=np.zeros((2, 3)))


def test_bodies_stand_in_their_places_unless_they_were_shifted(make_episode):
    episode = make_episode(np.zeros((3, 3)), shifts={"block": (0.004, -0.003, 0.0)})
    assert episode.shift_of("block") == (0.004, -0.003, 0.0)
    assert episode.shift_of("engine") == episode.shift_of(None) == (0.0, 0.0, 0.0)


def test_the_tip_seen_from_a_shifted_body_moves_the_other_way(make_episode):
    episode = make_episode([(9.0, 9.0, 9.0), (0.1, 0.2, 0.3)], shifts={"block": (0.1, -0.1, 0.0)})
    assert episode.tips_seen_from("block") == pytest.approx(np.array([(0.0, 0.3, 0.3)]))
    assert episode.tips_seen_from(None).tolist() == [[0.1, 0.2, 0.3]]


def test_only_a_task_with_an_object_has_its_track(make_episode):
    poses = np.zeros((3, 7))
    assert make_episode(np.zeros((3, 3)), object_poses=poses).object_track is poses
    with pytest.raises(AssertionError, match="the task has no object"):
        _ = make_episode(np.zeros((3, 3))).object_track


def test_the_mean_force_is_that_of_the_time_in_contact():
    assert ForceRecord(peak=9.0, impulse=6.0, seconds=2.0).mean == 3.0
    assert ForceRecord().mean == 0.0
