"""What holds for every scalarization, and known values."""

import numpy as np
import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.objectives import Goal, Objective
from hypermap_lite.scalarization import (
    SCALARIZATIONS,
    BoundingBox,
    Dirichlet,
    Linear,
    ModifiedTchebyshev,
    Normalization,
    Tchebyshev,
)

every_scalarization = pytest.mark.parametrize("name", list(SCALARIZATIONS))
RNG = np.random.default_rng(0)
Y = RNG.random((20, 3))
WEIGHTS = np.array([0.5, 0.3, 0.2])
TWO = (Objective(name="cost"), Objective(name="speed", goal=Goal.MAXIMIZE))
UNIT = Normalization(offset=np.zeros(2), scale=np.ones(2))


@every_scalarization
def test_it_is_monotone_in_each_objective(name: str) -> None:
    scalarize = SCALARIZATIONS[name]()
    for k in range(3):
        assert np.all(scalarize(Y + 0.1 * np.eye(3)[k], WEIGHTS) >= scalarize(Y, WEIGHTS))


@every_scalarization
def test_its_gradient_agrees_with_finite_differences(name: str) -> None:
    scalarize = SCALARIZATIONS[name]()
    numeric = [(scalarize(Y + e, WEIGHTS) - scalarize(Y - e, WEIGHTS)) / 2e-6 for e in 1e-6 * np.eye(3)]
    assert scalarize.gradient(Y, WEIGHTS) == pytest.approx(np.column_stack(numeric), abs=1e-6)


@every_scalarization
def test_it_takes_any_leading_shape(name: str) -> None:
    scalarize = SCALARIZATIONS[name]()
    assert scalarize(Y.reshape(4, 5, 3), WEIGHTS).ravel() == pytest.approx(scalarize(Y, WEIGHTS))


def test_known_values() -> None:
    y, w = np.array([0.2, 0.8]), np.array([0.25, 0.75])
    assert Linear()(y, w) == pytest.approx(0.65)
    assert Tchebyshev(rho=0.1)(y, w) == pytest.approx(0.6 + 0.065)
    assert ModifiedTchebyshev(rho=0.1)(y, w) == pytest.approx(0.2 + 0.1 * (0.15 + 0.2))


def test_the_weights_of_modified_tchebyshev_are_the_direction_in_which_the_front_is_met() -> None:
    first = np.linspace(0, 1, 1001)
    front = np.column_stack([first, 1 - first])
    best = front[np.argmin(ModifiedTchebyshev(rho=0.0)(front, np.array([0.3, 0.7])))]
    assert best == pytest.approx([0.3, 0.7])


def test_a_weight_of_zero_asks_modified_tchebyshev_for_the_best_of_that_objective() -> None:
    front = np.array([[0.0, 1.0], [0.5, 0.5], [1.0, 0.0]])
    values = ModifiedTchebyshev()(front, np.array([0.0, 1.0]))
    assert np.isfinite(values).all()
    assert np.argmin(values) == 0


def test_tchebyshev_reaches_the_middle_of_a_concave_front_and_the_sum_does_not() -> None:
    angle = np.linspace(0, np.pi / 2, 101)
    front = np.column_stack([np.cos(angle), np.sin(angle)])  # concave for minimization
    w = np.array([0.5, 0.5])
    assert np.argmin(Tchebyshev()(front, w)) == 50
    assert np.argmin(Linear()(front, w)) in (0, 100)


def test_normalization_maps_the_front_to_the_unit_box() -> None:
    points = np.array([[0.0, 10.0], [5.0, 4.0], [9.0, 30.0]])
    normalization = Normalization.of_front(points)
    assert normalization(points[:2]).tolist() == [[0, 1], [1, 0]]


def test_what_is_worse_than_the_reference_point_does_not_stretch_the_normalization() -> None:
    points = np.array([[0.0, 900.0], [1.0, 10.0], [5.0, 4.0], [800.0, 0.0]])
    normalization = Normalization.of_front(points, np.array([10.0, 20.0]))
    assert normalization(points[1:3]).tolist() == [[0, 1], [1, 0]]
    nothing_inside = Normalization.of_front(points, np.array([-1.0, -1.0]))
    assert nothing_inside.scale.tolist() == [800, 900]


def test_normalization_of_a_single_best_point_takes_the_range_of_all() -> None:
    normalization = Normalization.of_front(np.array([[0.0, 0.0], [4.0, 2.0]]))
    assert normalization.scale.tolist() == [4, 2]
    assert Normalization.of_front(np.ones((3, 2))).scale.tolist() == [1, 1]


def test_numerical_dust_on_a_front_is_no_trade_off() -> None:
    points = np.array([[1e-9, 0.0], [0.0, 1.0], [10.0, 5.0]])
    assert Normalization.of_front(points).scale == pytest.approx([10.0, 1.0])


def test_dirichlet_weights_are_on_the_simplex() -> None:
    weights = np.array([Dirichlet().sample(TWO, UNIT, np.random.default_rng(i)) for i in range(500)])
    assert weights.sum(axis=1) == pytest.approx(np.ones(500))
    assert np.histogram(weights[:, 0], bins=4, range=(0, 1))[0] == pytest.approx(np.full(4, 125), abs=40)


def test_a_bounding_box_aims_at_its_trade_off() -> None:
    # Low cost wanted: its normalized value is near 0, that of speed (maximized, so negated) near 1.
    box = BoundingBox(limits={"cost": [0.1, 0.1], "speed": [-0.9, -0.9]})
    assert box.sample(TWO, UNIT, np.random.default_rng(0)) == pytest.approx([0.9, 0.1])


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({"cost": [0, 1]}, "no box for 'speed'"),
        ({"cost": [0, 1], "sped": [0, 1]}, "Did you mean 'speed'"),
    ],
)
def test_every_objective_needs_a_box(limits: dict, message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        BoundingBox(limits=limits).check(TWO)


@pytest.mark.parametrize(
    ("member", "options"),
    [
        (Tchebyshev, {"rho": -1}),
        (ModifiedTchebyshev, {"rho": -1}),
        (Dirichlet, {"alpha": 0}),
        (BoundingBox, {"limits": {"cost": [1, 0]}}),
    ],
)
def test_impossible_options_are_refused(member: type, options: dict) -> None:
    with pytest.raises(ScenarioError, match=next(iter(options))):
        member(**options)
