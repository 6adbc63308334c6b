"""Known values of the kernel density estimate, and what it refuses."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.stats import gaussian_kde, norm

from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors import KernelDensityPrior, ProductPrior
from hypermap_lite.priors.kernel_density import KernelDensity
from hypermap_lite.priors.kernels import SmoothedLevels, TruncatedGaussians
from hypermap_lite.space import CategoricalParameter, IntegerParameter, RealParameter

X = RealParameter(name="x", low=0, high=1)
Y = RealParameter(name="y", low=-10, high=10)
N = IntegerParameter(name="n", low=1, high=4)
C = CategoricalParameter(name="c", values=("a", "b", "c"))


def density_of(values: dict, *axes, **options) -> KernelDensity:
    return KernelDensityPrior(points=values, **options).on(axes)


def test_far_from_the_bounds_one_axis_is_scipys() -> None:
    x = [0.48, 0.49, 0.5, 0.515, 0.53]
    u = np.linspace(0.45, 0.55, 11)
    ours = np.exp(density_of({"x": x}, X).log_density(u[:, None]))
    assert ours == pytest.approx(gaussian_kde(x)(u), rel=1e-9)


def test_weights_are_scipys() -> None:
    x, w = [0.48, 0.49, 0.5, 0.515, 0.53], [1, 2, 0.5, 3, 1]
    u = np.linspace(0.45, 0.55, 11)
    ours = np.exp(density_of({"x": x}, X, point_weights=w).log_density(u[:, None]))
    assert ours == pytest.approx(gaussian_kde(x, weights=w)(u), rel=1e-9)


def test_far_from_the_bounds_uncorrelated_data_on_two_axes_are_scipys() -> None:
    x, y = (side.ravel() for side in np.meshgrid([0.48, 0.5, 0.52], [-0.3, 0.0, 0.3, 0.6]))
    U = np.array([[0.5, 0.5], [0.49, 0.51], [0.53, 0.48]])
    ours = np.exp(density_of({"x": list(x), "y": list(y)}, X, Y).log_density(U))
    assert ours == pytest.approx(gaussian_kde([x, (y + 10) / 20])(U.T), rel=1e-9)


def test_a_factor_scales_the_bandwidths() -> None:
    x = [0.2, 0.5, 0.8]
    plain, wide = (density_of({"x": x}, X, bandwidth_factor=f).kernels[0].bandwidth for f in (1, 2))
    assert plain == pytest.approx(np.std(x, ddof=1) * 3 ** (-1 / 5))
    assert wide == pytest.approx(2 * plain)


def test_independent_axes_have_the_bandwidths_of_one_dimension() -> None:
    values = {"x": [0.2, 0.5, 0.8], "y": [-5.0, 0.0, 7.0]}
    joint, product = (density_of(values, X, Y, independent=flag) for flag in (False, True))
    assert isinstance(product, ProductPrior)
    alone = [product.factors[j][1].kernels[0].bandwidth for j in (0, 1)]
    assert [k.bandwidth for k in joint.kernels] == pytest.approx([h * 3 ** (1 / 5 - 1 / 6) for h in alone])
    U = np.random.default_rng(0).random((5, 2))
    parts = [density_of({name: values[name]}, axis) for name, axis in (("x", X), ("y", Y))]
    expected = sum(part.log_density(U[:, [j]]) for j, part in enumerate(parts))
    assert product.log_density(U) == pytest.approx(expected)


def test_a_joint_density_keeps_together_what_stood_together() -> None:
    values = {"x": [0.1, 0.12, 0.9, 0.88], "y": [-9.0, -8.8, 9.0, 8.7]}
    U = np.array([[0.1, 0.05], [0.1, 0.95]])
    joint, product = (density_of(values, X, Y, bandwidth_factor=0.3, independent=flag) for flag in (False, True))
    assert np.diff(joint.log_density(U))[0] < -5
    assert np.diff(product.log_density(U))[0] == pytest.approx(0, abs=0.5)


def test_kernels_at_a_bound_are_normalized_by_themselves() -> None:
    kernels = TruncatedGaussians(np.array([0.0, 0.5]), 0.1)
    at_centres = np.exp(kernels.log_densities(np.array([0.0, 0.5])))
    assert at_centres[0, 0] == pytest.approx(2 * norm.pdf(0) / 0.1)
    assert at_centres[1, 1] == pytest.approx(norm.pdf(0) / 0.1, rel=1e-5)


def test_integers_have_the_mass_of_their_bins() -> None:
    density = density_of({"n": [1, 2, 2, 4]}, N)
    h = density.kernels[0].bandwidth
    edges = np.linspace(0, 1, 5)
    centres = np.array([0.125, 0.375, 0.375, 0.875])
    cdf = norm.cdf((edges[:, None] - centres) / h)
    expected = (np.diff(cdf, axis=0) / (cdf[-1] - cdf[0])).mean(axis=1)
    masses = np.exp(density.log_density(N.level_codes()[:, None])) / 4
    assert masses == pytest.approx(expected)


def test_levels_have_smoothed_frequencies() -> None:
    density = density_of({"c": ["a", "a", "b", "a"], "x": [0.1, 0.2, 0.3, 0.4]}, C, X).marginal([0])
    s = 4 ** (-2 / 6)
    masses = np.exp(density.log_density(C.level_codes()[:, None])) / 3
    assert masses == pytest.approx([(1 - s) * 3 / 4 + s / 3, (1 - s) / 4 + s / 3, s / 3])
    assert masses.sum() == pytest.approx(1)


def test_a_large_factor_smooths_levels_to_uniform() -> None:
    kernels = density_of({"c": ["a", "a", "b"]}, C, bandwidth_factor=9.0).kernels[0]
    assert isinstance(kernels, SmoothedLevels)
    assert kernels.smoothing == 1.0
    assert kernels.log_densities(np.array([0.9])) == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("values", "options"),
    [
        pytest.param([0.3], {}, id="one-point"),
        pytest.param([0.3, 0.3, 0.3], {}, id="one-point-thrice"),
        pytest.param([0.3, 0.9], {"point_weights": [2, 0]}, id="one-point-that-counts"),
    ],
)
def test_a_single_point_has_a_tenth_of_the_axis_for_a_deviation(values: list, options: dict) -> None:
    density = density_of({"x": values}, X, **options)
    assert density.kernels[0].bandwidth == pytest.approx(0.1)
    assert density.mode() == pytest.approx([0.3])


def test_an_axis_on_which_all_points_agree_is_no_spike() -> None:
    density = density_of({"x": [0.3, 0.3, 0.3], "y": [0.0, 1.0, 2.0]}, X, Y)
    assert density.kernels[0].bandwidth == pytest.approx(0.01)


def test_a_weight_of_two_has_the_place_of_two_points() -> None:
    u = np.linspace(0, 1, 7)[:, None]
    weighted = density_of({"x": [0.2, 0.6]}, X, point_weights=[2, 1])
    h = weighted.kernels[0].bandwidth
    kernels = TruncatedGaussians(np.array([0.2, 0.2, 0.6]), h)
    assert weighted.log_density(u) == pytest.approx(KernelDensity((kernels,), np.full(3, 1 / 3)).log_density(u))


def test_extreme_weights_and_factors_still_give_a_density() -> None:
    for weights in ([1e308, 1e308, 1e308], [1.0, 1e-300, 5e-324], [1e-310, 1e-310, 0.0]):
        density = density_of({"x": [0.1, 0.5, 0.7]}, X, point_weights=weights, bandwidth_factor=1e300)
        assert density.log_density(np.array([[0.0], [1.0]])) == pytest.approx(0.0, abs=1e-5)


@pytest.mark.parametrize("log", [False, True])
def test_an_axis_of_many_levels_scores_what_it_samples(log: bool) -> None:
    axis = IntegerParameter(name="n", low=1, high=10**6, log=log)
    density = density_of({"n": [1, 2, 5, 900_000]}, axis, bandwidth_factor=0.1)
    u = np.sort(density.sample(40_000, np.random.default_rng(0))[:, 0])
    edges = np.array([0.0, 0.02, 0.05, 0.1, 0.3, 0.7, 0.9, 1.0])
    edges = np.append(axis.bins_of_levels(axis.level_index(edges[:-1]))[0], 1.0)
    fine = [np.linspace(a, b, 4001) for a, b in pairwise(edges)]
    expected = [np.exp(density.log_density(((f[:-1] + f[1:]) / 2)[:, None])).mean() * (f[-1] - f[0]) for f in fine]
    assert np.histogram(u, bins=edges)[0] / len(u) == pytest.approx(expected, abs=0.01)


def test_many_points_are_looked_at_in_blocks() -> None:
    rng = np.random.default_rng(0)
    density = density_of({"x": list(rng.random(3000))}, X)
    u = rng.random((1500, 1))
    assert density.log_density(u)[[0, -1]] == pytest.approx(density.log_density(u[[0, -1]]))
    assert density.log_gradient(u)[[0, -1]] == pytest.approx(density.log_gradient(u[[0, -1]]))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        pytest.param({}, "there are no points", id="no-points"),
        pytest.param({"file": "a.csv"}, "load_scenario reads", id="file-not-read"),
        pytest.param({"points": {"x": []}}, r"\$\.points\.x: there are 0 values", id="empty"),
        pytest.param({"points": {"x": [0, 1], "y": [0]}}, r"\$\.points\.y: there are 1 values", id="lengths"),
        pytest.param({"points": {"x": [0]}, "bandwidth_factor": 0}, r"\$\.bandwidth_factor", id="no-bandwidth"),
        pytest.param({"points": {"x": [0]}, "point_weights": [1, 2]}, "2 weights for 1 points", id="weights-too-many"),
        pytest.param({"points": {"x": [0]}, "point_weights": [-1]}, r"point_weights\[0\].*-1", id="weight-negative"),
        pytest.param({"points": {"x": [0]}, "point_weights": [0]}, "all weights are zero", id="weights-zero"),
    ],
)
def test_impossible_options_are_refused(options: dict, message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        KernelDensityPrior(**options)


@pytest.mark.parametrize(
    ("axis", "value", "allowed"), [(X, 1.5, "a number from 0 to 1"), (N, 2.5, "an integer"), (C, "d", "'a', 'b', 'c'")]
)
def test_a_value_that_the_parameter_cannot_take_is_refused(axis, value: object, allowed: str) -> None:
    with pytest.raises(ScenarioError, match=rf"\$\.points\.{axis.name}\[0\].*no value of '{axis.name}'") as caught:
        density_of({axis.name: [value]}, axis)
    assert allowed in caught.value.allowed
