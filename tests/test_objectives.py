"""Directions and reference points."""

import numpy as np

from hypermap_lite.objectives import Goal, Objective, reference_point_of, stated_or, to_minimization, values_of

COST = Objective(name="cost", reference_point=5.0)
SPEED = Objective(name="speed", goal=Goal.MAXIMIZE, reference_point=1.0)


def test_only_maximized_objectives_change_sign() -> None:
    assert values_of((COST, SPEED), {"cost": 2.0, "speed": 3.0}).tolist() == [2.0, -3.0]
    assert reference_point_of((COST, SPEED)).tolist() == [5.0, -1.0]


def test_minimization_is_its_own_inverse() -> None:
    Y = np.array([[1.0, 2.0], [3.0, 4.0]])
    assert np.array_equal(to_minimization((COST, SPEED), to_minimization((COST, SPEED), Y)), Y)


def test_a_missing_reference_point_leaves_none() -> None:
    assert reference_point_of((COST, Objective(name="speed"))) is None


def test_a_reference_point_is_inferred_only_where_none_is_stated() -> None:
    objectives = (Objective(name="f", goal=Goal.MAXIMIZE, reference_point=2.0), Objective(name="g"))
    assert stated_or(objectives, np.array([7.0, 9.0])).tolist() == [-2.0, 9.0]
