"""Weights on levels."""

import numpy as np
import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors import WeightsPrior
from hypermap_lite.space import CategoricalParameter, RealParameter

ABC = CategoricalParameter(name="c", values=("a", "b", "c"))


def test_weights_are_normalized() -> None:
    density = WeightsPrior(weights=[2, 0, 6]).on(ABC)
    assert np.exp(density.log_density(ABC.level_codes())) / 3 == pytest.approx([0.25, 0, 0.75])


@pytest.mark.parametrize(
    ("weights", "message"),
    [([1, -1, 1], r"weights\[1\].*-1"), ([0, 0, 0], "all weights are zero"), ([1, "a", 1], "a finite number")],
)
def test_impossible_weights_are_refused(weights: list, message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        WeightsPrior(weights=weights)


def test_there_must_be_one_weight_per_level() -> None:
    with pytest.raises(ScenarioError, match="2 weights for the 3 levels"):
        WeightsPrior(weights=[1, 1]).on(ABC)


def test_a_real_parameter_has_no_levels() -> None:
    with pytest.raises(ScenarioError, match="no levels"):
        WeightsPrior(weights=[1, 1]).on(RealParameter(name="x", low=0, high=1))
