"""Scalarizations with fixed weights."""

import numpy as np
import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.optimizers.fitness import Fitness, check_weights, normalized_weights
from hypermap_lite.scalarization import Linear

Y = np.array([[0.0, 100.0], [10.0, 300.0], [np.inf, np.inf], [-10.0, 200.0]])


def fitness(n_reference: int) -> Fitness:
    return Fitness(scalarization=Linear(), weights=np.array([0.5, 0.5]), n_reference=n_reference)


def test_objectives_are_compared_in_units_of_the_first_evaluations() -> None:
    assert fitness(2)(Y) == pytest.approx([0.0, 1.0, np.inf, -0.25])


def test_later_evaluations_do_not_move_the_earlier_ones() -> None:
    assert fitness(2)(Y)[:3] == pytest.approx(fitness(2)(Y[:3]))


def test_without_usable_first_evaluations_all_usable_ones_set_the_units() -> None:
    assert fitness(1)(Y[[2, 0, 1]]) == pytest.approx([np.inf, 0.0, 1.0])
    assert np.isinf(fitness(1)(Y[[2, 2]])).all()


def test_weights_are_equal_unless_given() -> None:
    assert normalized_weights(None, 4) == pytest.approx(np.full(4, 0.25))


@pytest.mark.parametrize("weights", [[-1, 2], [0, 0], [float("nan"), 1]])
def test_impossible_weights_are_refused(weights: list[float]) -> None:
    with pytest.raises(ScenarioError, match="weight"):
        check_weights(weights)


def test_there_is_a_weight_for_each_objective() -> None:
    with pytest.raises(ScenarioError, match="there are 2 weights for 3 objectives"):
        normalized_weights([1, 2], 3)
