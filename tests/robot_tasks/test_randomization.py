"""Tests for randomization.py."""

from collections import Counter

import numpy as np
import pytest

from robot_tasks.randomization import BodyShift, Randomization

STARTS = {"a": (0.0,) * 7, "b": (0.1,) * 7, "c": (0.2,) * 7}


def test_offsets_are_clipped_at_one_sigma_and_a_third_sits_on_each_axis_bound():
    rng = np.random.default_rng(0)
    offsets = np.array([BodyShift(body="engine", sigma=0.02).sample(rng) for _ in range(4000)])
    assert np.abs(offsets[:, :2]).max() == 0.02
    assert (offsets[:, 2] == 0.0).all()
    assert np.mean(np.abs(offsets[:, 0]) == 0.02) == pytest.approx(0.317, abs=0.03)


def test_start_states_are_equally_likely():
    rng = np.random.default_rng(1)
    counts = Counter(Randomization(starts=STARTS).sample(rng).start for _ in range(3000))
    assert [counts[start] / 3000 for start in STARTS.values()] == pytest.approx([1 / 3] * 3, abs=0.04)


def test_equal_seeds_give_equal_variations():
    randomization = Randomization(starts=STARTS, shifts=(BodyShift(body="engine", sigma=0.02),))
    first, second = (randomization.sample(np.random.default_rng(7)) for _ in range(2))
    assert first == second


def test_applying_a_variation_moves_bodies_from_their_nominal_place_each_time(simulation):
    randomization = Randomization(starts=STARTS, shifts=(BodyShift(body="engine", sigma=0.02),))
    variation = randomization.sample(np.random.default_rng(7))
    nominal = np.array([-0.52, 0.3, 0.751])
    engine = simulation.id_of("body", "engine")
    for _ in range(2):
        variation.apply(simulation)
        assert simulation.data.xpos[engine] == pytest.approx(nominal + variation.shifts["engine"])
    randomization.nominal("b").apply(simulation)
    assert simulation.data.xpos[engine] == pytest.approx(nominal)
    assert simulation.data.qpos == pytest.approx(STARTS["b"])
