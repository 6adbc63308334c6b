"""Tests for seeds.py."""

from itertools import product

from hypermap_lite.evaluation.seeds import replicate_seed


def test_seeds_differ_between_calls_and_fit_31_bits():
    seeds = {replicate_seed(*key) for key in product(range(3), range(30), range(7))}
    assert len(seeds) == 3 * 30 * 7
    assert all(0 <= seed < 2**31 for seed in seeds)


def test_seeds_never_change():
    assert [replicate_seed(0, 0, 0), replicate_seed(0, 1, 6)] == [1570558271, 426494011]
