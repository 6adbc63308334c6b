"""Expected hypervolume improvement of two and three objectives."""

import numpy as np
import pytest

from hypermap_lite.acquisition.boxes import Boxes
from hypermap_lite.acquisition.hypervolume_improvement import Growth, HypervolumeImprovement, LogGrowth
from hypermap_lite.pareto.hypervolume import hypervolume
from hypermap_lite.surrogates.base import Conditional, Field
from tests.acquisition.toy_field import toy_field

FRONTS = {
    2: np.array([[0.1, 0.9], [0.3, 0.4], [0.7, 0.2], [0.8, 0.8], [0.3, 1.7]]),
    3: np.array([[0.1, 0.9, 0.5], [0.3, 0.4, 0.4], [0.7, 0.2, 0.6], [0.5, 0.5, 0.1], [0.8, 0.8, 0.8], [0.2, 0.2, 2]]),
}
"""With a dominated point and one beyond the reference point."""

both = pytest.mark.parametrize("m", [2, 3])


def reference(m: int) -> np.ndarray:
    return np.ones(m)


def fixed(mean: np.ndarray, std: np.ndarray) -> Field:
    return lambda X: Conditional(mean=mean[None], std=std[None])


def improvement(field: Field, fronts: np.ndarray) -> HypervolumeImprovement:
    boxes = Boxes.of(fronts, reference(fronts.shape[2]))
    return HypervolumeImprovement(field=field, boxes=boxes, is_differentiable=True)


def growth(point: np.ndarray, front: np.ndarray) -> float:
    corner = reference(front.shape[1])
    return hypervolume(np.vstack([front, point]), corner) - hypervolume(front, corner)


@both
def test_a_certain_point_is_worth_the_growth_of_the_hypervolume(m: int) -> None:
    points = 1.4 * np.random.default_rng(0).random((60, m)) - 0.3
    scores = improvement(fixed(points, np.full((60, m), 1e-7)), FRONTS[m][None])(np.zeros((60, 1)))
    assert np.exp(scores) == pytest.approx([growth(y, FRONTS[m]) for y in points], rel=1e-4, abs=1e-6)


@both
def test_an_uncertain_point_is_worth_the_mean_growth(m: int) -> None:
    mean, std = np.linspace(0.3, 0.5, m)[None], np.linspace(0.3, 0.2, m)[None]
    draws = mean + std * np.random.default_rng(0).standard_normal((20_000, m))
    expected = np.mean([growth(y, FRONTS[m]) if (y < 1).all() else 0.0 for y in draws])
    assert np.exp(improvement(fixed(mean, std), FRONTS[m][None])(np.zeros((1, 1)))[0]) == pytest.approx(
        expected, rel=0.03
    )


@both
def test_the_mean_over_fronts_is_taken(m: int) -> None:
    fronts = np.stack([FRONTS[m], FRONTS[m] + 0.15, FRONTS[m] * 0.8])
    mean, std = np.full((1, m), 0.35), np.full((1, m), 0.1)
    alone = [np.exp(improvement(fixed(mean, std), front[None])(np.zeros((1, 1)))[0]) for front in fronts]
    together = improvement(fixed(mean, std), fronts)(np.zeros((1, 1)))[0]
    assert np.exp(together) == pytest.approx(np.mean(alone))


@both
def test_without_a_front_the_box_below_the_reference_point_counts(m: int) -> None:
    y = np.linspace(0.25, 0.5, m)[None]
    nothing = np.full((1, 2, m), 3.0)
    score = improvement(fixed(y, np.full((1, m), 1e-7)), nothing)(np.zeros((1, 1)))
    assert np.exp(score[0]) == pytest.approx(np.prod(1 - y))


@both
def test_far_behind_the_front_scores_stay_finite_and_fall_with_the_distance(m: int) -> None:
    distance = np.repeat([[1.2], [2.0], [20.0], [200.0], [1e6]], m, axis=1)
    scores = improvement(fixed(distance, np.full((5, m), 1e-3)), FRONTS[m][None])(np.zeros((5, 1)))
    assert np.isfinite(scores).all()
    assert np.all(np.diff(scores) < 0)


@both
def test_the_plain_formula_and_that_of_logarithms_agree(m: int) -> None:
    rng = np.random.default_rng(3)
    fronts, mean, std = rng.random((4, 7, m)), rng.random((4, 9, m)), 0.05 + rng.random((1, 9, m))
    boxes = Boxes.of(fronts, reference(m))
    plain, exact = Growth.of(boxes, mean, std), LogGrowth.of(boxes, mean, std)
    assert np.log(plain.value) == pytest.approx(exact.score, rel=1e-10)
    for ours, theirs in zip(plain.slopes(), exact.slopes(), strict=True):
        assert ours / plain.value[:, None] == pytest.approx(theirs, rel=1e-6, abs=1e-10)


@both
@pytest.mark.parametrize("distance", [0.0, 20.0])
def test_slopes_agree_with_finite_differences(m: int, distance: float) -> None:
    rng = np.random.default_rng(4)
    boxes = Boxes.of(rng.random((3, 6, m)), reference(m))
    mean, std = rng.random((3, 5, m)) + distance, 0.2 + 0.3 * rng.random((3, 5, m))
    by_mean, by_std = LogGrowth.of(boxes, mean, std).slopes()
    for where in [(0, 1, 0), (1, 2, 1), (2, 3, m - 1), (0, 4, m - 1)]:
        step = np.zeros_like(mean)
        step[where] = 1e-6
        ends = [LogGrowth.of(boxes, mean + s * step, std).score[where[1]] for s in (-1, 1)]
        assert by_mean[where] == pytest.approx((ends[1] - ends[0]) / 2e-6, rel=1e-4, abs=1e-7)
        ends = [LogGrowth.of(boxes, mean, std + s * step).score[where[1]] for s in (-1, 1)]
        assert by_std[where] == pytest.approx((ends[1] - ends[0]) / 2e-6, rel=1e-4, abs=1e-7)


@pytest.mark.parametrize("offset", [0.0, 60.0])
def test_gradients_agree_with_finite_differences_near_the_front_and_far_from_it(offset: float) -> None:
    inner = toy_field(3)

    def field(X: np.ndarray) -> Conditional:
        c = inner(X)
        return Conditional(mean=c.mean + offset, std=c.std, pullback=c.pullback)

    scorer = improvement(field, np.stack([FRONTS[2]] * 3))
    X = np.random.default_rng(2).random((6, 2))
    score, gradient = scorer.with_gradient(X)
    assert score == pytest.approx(scorer(X))
    for j, e in enumerate(1e-6 * np.eye(2)):
        numeric = (scorer(X + e) - scorer(X - e)) / 2e-6
        assert gradient[:, j] == pytest.approx(numeric, rel=1e-4, abs=1e-6)


def test_a_few_fronts_tell_roughly_the_same() -> None:
    rng = np.random.default_rng(5)
    inner, offsets = toy_field(1), 0.05 * rng.standard_normal((32, 1, 2))
    fronts = np.stack([FRONTS[2]] * 32) + offsets

    def field(X: np.ndarray) -> Conditional:
        c = inner(X)
        return Conditional(mean=c.mean + offsets, std=c.std)

    boxes = Boxes.of(fronts, reference(2))
    scorer = HypervolumeImprovement(field=field, boxes=boxes, is_differentiable=True, screening=8)
    X = rng.random((200, 2))
    assert scorer.rough is not None
    assert np.corrcoef(scorer.rough(X), scorer(X))[0, 1] > 0.95
    assert not np.array_equal(scorer.rough(X), scorer(X))
    assert HypervolumeImprovement(field=field, boxes=boxes, is_differentiable=True).rough is None
