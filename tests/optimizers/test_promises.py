"""What the model promised, and whether it came true."""

from __future__ import annotations

import math

import pytest

from hypermap_lite.evaluation.outcome import CONFIRM, MODEL, RANDOM
from hypermap_lite.optimizers.promises import Promise, are_kept, promises_of
from tests.optimizers.test_boundary import GAIN, LOSS, START, history

SECOND = ("design", 0.4, (1.1, 0.9), {})


def test_promises_are_the_models_own_once_there_is_a_model() -> None:
    known = history(
        START,
        (MODEL, 0.1, LOSS, {}),  # one evaluation is no model: what was promised is feasibility
        (MODEL, 0.2, None, {}),
        (MODEL, 0.3, LOSS, {"prior_weight": 2.0}),
        (RANDOM, 0.4, GAIN, {}),
        (CONFIRM, 0.4, GAIN, {}),
        (MODEL, 0.5, GAIN, {"acquisition_value": None}),
        (MODEL, 0.6, GAIN, {"prior_weight": 0.0}),
    )
    value = math.log(0.1)
    assert promises_of(known) == [Promise(2, 2, False, value), Promise(7, 6, True, value)]


@pytest.mark.parametrize(
    ("values", "promised", "expected"),
    [(GAIN, 0.1, True), (GAIN, 1000.0, False), (LOSS, 1e-9, False), (None, 1e-9, False)],
)
def test_a_promise_is_kept_by_what_it_adds_to_the_front(
    values: tuple[float, float] | None, promised: float, expected: bool
) -> None:
    known = history(START, SECOND, (MODEL, 0.5, values, {"acquisition_value": math.log(promised)}))
    assert are_kept(promises_of(known), known.objectives, known.Y(), known.Y()) == [expected]


def test_what_counts_are_the_means_of_now() -> None:
    known = history(START, SECOND, (MODEL, 0.5, GAIN, {}))
    lucky = known.Y()
    lucky[2] = LOSS
    assert are_kept(promises_of(known), known.objectives, known.Y(), known.Y()) == [True]
    assert are_kept(promises_of(known), known.objectives, known.Y(), lucky) == [False]
