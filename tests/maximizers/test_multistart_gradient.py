"""Gradient ascents from several starts, and what goes on in turn with them."""

import numpy as np
import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.maximizers import MAXIMIZERS
from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, SearchSpace
from tests.maximizers.test_maximizers import REAL, Bowl, problem


class Smooth(Bowl):
    """A bowl that counts how many points it is asked for."""

    n_asked = 0

    def __call__(self, X: np.ndarray) -> np.ndarray:
        self.n_asked += len(X)
        return super().__call__(X)


def test_many_levels_are_climbed_by_gradients_and_ended_by_steps() -> None:
    space = SearchSpace(
        (
            *(IntegerParameter(name=f"n{i}", low=0, high=10**6) for i in range(4)),
            OrdinalParameter(name="o", values=tuple(float(v) for v in range(100))),
            CategoricalParameter(name="c", values=tuple("abcdefgh")),
        )
    )
    target = {"n0": 123_456, "n1": 999_999, "n2": 0, "n3": 500_001, "o": 37.0, "c": "f"}
    bowl = Smooth(space.encode([target])[0])
    found = MAXIMIZERS["multistart_gradient"]().maximize(problem(space, bowl))
    assert found is not None
    assert space.decode(found.x[None]) == [target]
    assert bowl.n_asked < 5_000  # by steps alone 11,000


class Valley(Bowl):
    """A curved ridge, steep across and flat along, whose maximum 1 takes many steps to reach."""

    n_asked = 0

    def __call__(self, X: np.ndarray) -> np.ndarray:
        return 1 - (30 * (X[:, 1] - X[:, 0] ** 2) ** 2 + (X[:, 0] - 0.7) ** 2)

    def with_gradient(self, X: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        self.n_asked += len(X)
        across = 60 * (X[:, 1] - X[:, 0] ** 2)
        return self(X), np.stack([2 * across * X[:, 0] - 2 * (X[:, 0] - 0.7), -across, 0 * X[:, 2]], axis=1)


@pytest.mark.parametrize("starts", [1, 4])
def test_best_start_alone_climbs_to_the_end(starts: int) -> None:
    asked = []
    for tolerance in (0.0, 1e-3):
        valley = Valley(np.zeros(3))
        maximizer = MAXIMIZERS["multistart_gradient"](candidates=64, starts=starts, joint_tolerance=tolerance)
        found = maximizer.maximize(problem(REAL, valley))
        assert found is not None
        assert found.score == pytest.approx(1.0, abs=1e-6)
        asked.append(valley.n_asked)
    assert asked[1] < 0.7 * asked[0] or starts == 1


@pytest.mark.parametrize("tolerance", [-1e-9, 1.0])
def test_impossible_tolerance_is_refused(tolerance: float) -> None:
    with pytest.raises(ScenarioError, match="joint_tolerance"):
        MAXIMIZERS["multistart_gradient"](joint_tolerance=tolerance)


def test_twenty_categories_are_maximized_without_their_combinations() -> None:
    space = SearchSpace(tuple(CategoricalParameter(name=f"c{i}", values=tuple("abcdefghij")) for i in range(20)))
    worth = np.random.default_rng(0).standard_normal((20, 10))

    class Additive(Bowl):
        def __call__(self, X: np.ndarray) -> np.ndarray:
            return worth[np.arange(20), np.minimum((X * 10).astype(int), 9)].sum(axis=1)

    found = MAXIMIZERS["multistart_gradient"]().maximize(problem(space, Additive(np.zeros(20))))
    assert found is not None
    assert found.score == pytest.approx(worth.max(axis=1).sum())
