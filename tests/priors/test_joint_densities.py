"""What holds for every density over several parameters, whatever they are."""

from itertools import permutations

import numpy as np
import pytest
from scipy.stats import chi2

from hypermap_lite.priors import (
    JOINT_PRIORS,
    AsJoint,
    GaussianPrior,
    JointDensity,
    JointMixturePrior,
    KernelDensityPrior,
    ProductPrior,
    WeightsPrior,
)
from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, Parameter, RealParameter
from tests.slow import slow_unless

REAL = RealParameter(name="r", low=-2.0, high=6.0)
LOG = RealParameter(name="l", low=1e-3, high=10.0, log=True)
INTEGER = IntegerParameter(name="i", low=0, high=7)
LOG_INTEGER = IntegerParameter(name="k", low=1, high=32, log=True)
ORDINAL = OrdinalParameter(name="o", values=(1.0, 5.0, 25.0))
CATEGORICAL = CategoricalParameter(name="c", values=("a", "b", "c", "d"))

ROWS = {
    "r": [-1.9, -1.5, 0.5, 3.0, 5.5, 6.0],
    "l": [0.001, 0.002, 0.02, 0.1, 2.0, 9.0],
    "i": [0, 0, 3, 4, 7, 7],
    "k": [1, 2, 2, 8, 20, 32],
    "o": [1.0, 1.0, 5.0, 5.0, 25.0, 25.0],
    "c": ["a", "a", "a", "b", "b", "d"],
}


def kde(*parameters: Parameter, first: int = 6, **options: object) -> KernelDensityPrior:
    return KernelDensityPrior(points={p.name: ROWS[p.name][:first] for p in parameters}, **options)


def mixture(*parameters: Parameter) -> JointMixturePrior:
    means = ({"r": 0.0, "l": 0.01, "i": 2}, {"r": 5.0, "l": 1.0, "i": 6})
    std = {"r": 1.0, "l": 0.4, "i": 1.5}
    names = [p.name for p in parameters]
    return JointMixturePrior(
        components=[{"mean": {n: mean[n] for n in names}, "std": {n: std[n] for n in names}} for mean in means]
    )


class Fixed:
    """A prior that is a density already."""

    def __init__(self, density: JointDensity) -> None:
        self.density = density

    def on(self, axes: object) -> JointDensity:
        return self.density


PRODUCT = ProductPrior(
    3,
    (
        ((2, 0), mixture(REAL, LOG).on([REAL, LOG])),
        ((1,), AsJoint(WeightsPrior(weights=[1, 2, 3, 4]).on(CATEGORICAL))),
    ),
)
WITH_FREE_AXIS = ProductPrior(2, (((1,), AsJoint(GaussianPrior(mean=1, std=1).on(REAL))),))

CASES = [
    pytest.param(mixture(REAL, LOG), (REAL, LOG), id="mixture"),
    pytest.param(mixture(INTEGER, REAL), (INTEGER, REAL), id="mixture-integer"),
    pytest.param(kde(REAL), (REAL,), id="kde-1d"),
    pytest.param(kde(REAL, LOG), (REAL, LOG), id="kde"),
    pytest.param(kde(REAL, LOG, bandwidth_factor=0.05), (REAL, LOG), id="kde-narrow"),
    pytest.param(kde(REAL, LOG, first=1), (REAL, LOG), id="kde-one-point-in-a-corner"),
    pytest.param(kde(REAL, LOG, point_weights=[0, 1, 2, 0, 5, 1]), (REAL, LOG), id="kde-weighted"),
    pytest.param(kde(REAL, LOG, independent=True), (REAL, LOG), id="kde-independent"),
    pytest.param(kde(INTEGER, LOG_INTEGER), (INTEGER, LOG_INTEGER), id="kde-integers"),
    pytest.param(kde(ORDINAL, CATEGORICAL), (ORDINAL, CATEGORICAL), id="kde-levels"),
    pytest.param(kde(ORDINAL, CATEGORICAL, first=1), (ORDINAL, CATEGORICAL), id="kde-one-point-of-levels"),
    pytest.param(kde(REAL, LOG_INTEGER, CATEGORICAL), (REAL, LOG_INTEGER, CATEGORICAL), id="kde-mixed"),
    pytest.param(
        kde(REAL, LOG_INTEGER, CATEGORICAL, independent=True), (REAL, LOG_INTEGER, CATEGORICAL), id="kde-mixed-product"
    ),
    pytest.param(Fixed(PRODUCT), (LOG, CATEGORICAL, REAL), id="product"),
    pytest.param(Fixed(WITH_FREE_AXIS), (LOG, REAL), id="product-with-a-free-axis"),
]


def cells_of(parameter: Parameter) -> tuple[np.ndarray, np.ndarray]:
    """Return middles and widths of cells, so fine that a sum over them is an integral."""
    edges = np.linspace(0, 1, 241) if parameter.n_levels is None else parameter.bin_edges()
    return (edges[:-1] + edges[1:]) / 2, np.diff(edges)


def masses_of(density: JointDensity, parameters: tuple[Parameter, ...]) -> np.ndarray:
    """Return the probability of each cell of the grid of all parameters' cells."""
    points, widths = zip(*map(cells_of, parameters), strict=True)
    U = np.stack(np.meshgrid(*points, indexing="ij"), axis=-1)
    volumes = np.prod(np.stack(np.meshgrid(*widths, indexing="ij"), axis=-1), axis=-1)
    return np.exp(density.log_density(U.reshape(-1, len(points)))).reshape(volumes.shape) * volumes


def test_every_prior_of_the_table_is_among_the_cases() -> None:
    assert {type(case.values[0]) for case in CASES} == {*JOINT_PRIORS.values(), Fixed}


@pytest.mark.parametrize(("prior", "parameters"), CASES)
def test_density_integrates_to_one(prior: object, parameters: tuple[Parameter, ...]) -> None:
    assert masses_of(prior.on(parameters), parameters).sum() == pytest.approx(1.0, abs=2e-3)


@pytest.mark.parametrize(("prior", "parameters"), CASES)
def test_samples_follow_the_scored_density(prior: object, parameters: tuple[Parameter, ...]) -> None:
    density = prior.on(parameters)
    n = 20_000
    U = density.sample(n, np.random.default_rng(1))
    assert U.shape == (n, len(parameters))
    assert np.all((U >= 0) & (U <= 1))
    edges = [np.linspace(0, 1, 7) if p.n_levels is None else p.bin_edges() for p in parameters]
    counts = np.histogramdd(U, bins=edges)[0]
    expected = n * masses_of(density, parameters)
    for j, parameter in enumerate(parameters):
        if parameter.n_levels is None:  # 240 cells into 6
            expected = np.add.reduceat(expected, np.arange(0, 240, 40), axis=j)
    frequent = expected > 5
    statistic = (((counts - expected) ** 2)[frequent] / expected[frequent]).sum()
    assert counts[~frequent].sum() <= 30 + 3 * expected[~frequent].sum()
    assert statistic < chi2.ppf(0.9999, max(frequent.sum() - 1, 1))


@pytest.mark.parametrize(("prior", "parameters"), CASES)
def test_samples_are_spread_evenly_within_bins(prior: object, parameters: tuple[Parameter, ...]) -> None:
    U = prior.on(parameters).sample(20_000, np.random.default_rng(2))
    for j, parameter in enumerate(parameters):
        if parameter.n_levels is not None:
            low, high = parameter.bins_of_levels(parameter.level_index(U[:, j]))
            share = (U[:, j] - low) / (high - low)
            assert np.histogram(share, bins=4, range=(0, 1))[0] / len(U) == pytest.approx(np.full(4, 0.25), abs=0.02)


@pytest.mark.parametrize(("prior", "parameters"), CASES)
def test_log_gradient_agrees_with_finite_differences(prior: object, parameters: tuple[Parameter, ...]) -> None:
    density = prior.on(parameters)
    U = np.random.default_rng(0).uniform(0.01, 0.99, size=(20, len(parameters)))
    gradient = density.log_gradient(U)
    assert gradient.shape == U.shape
    for j, e in enumerate(1e-6 * np.eye(len(parameters))):
        numeric = (density.log_density(U + e) - density.log_density(U - e)) / 2e-6
        assert gradient[:, j] == pytest.approx(numeric, rel=1e-4, abs=1e-4)


@pytest.mark.parametrize(("prior", "parameters"), CASES)
def test_mode_is_nearly_as_dense_as_any_sample(prior: object, parameters: tuple[Parameter, ...]) -> None:
    density = prior.on(parameters)
    mode = density.mode()
    assert mode.shape == (len(parameters),)
    drawn = density.log_density(density.sample(2000, np.random.default_rng(0)))
    assert density.log_density(mode[None])[0] >= drawn.max() - np.log(1.5)


@pytest.mark.parametrize(("prior", "parameters"), slow_unless(lambda prior, parameters: len(parameters) < 3, CASES))
def test_marginals_are_integrals_of_the_joint_density(prior: object, parameters: tuple[Parameter, ...]) -> None:
    density = prior.on(parameters)
    masses = masses_of(density, parameters)
    k = len(parameters)
    for axes in (axes for size in range(1, k + 1) for axes in permutations(range(k), size)):
        marginal = masses_of(density.marginal(axes), tuple(parameters[j] for j in axes))
        expected = masses.sum(axis=tuple(j for j in range(k) if j not in axes))
        expected = expected.transpose(np.argsort(np.argsort(axes)))
        assert marginal.sum() == pytest.approx(1.0, abs=2e-3)
        assert marginal == pytest.approx(expected, rel=5e-3, abs=1e-6)


@pytest.mark.parametrize(("prior", "parameters"), CASES)
def test_marginals_can_be_sampled(prior: object, parameters: tuple[Parameter, ...]) -> None:
    density = prior.on(parameters)
    last = len(parameters) - 1
    whole, part = (
        d.sample(20_000, np.random.default_rng(s)) for s, d in enumerate((density, density.marginal([last])))
    )
    places = np.linspace(0, 1, 21)
    shares = [(sample[:, None] <= places).mean(axis=0) for sample in (whole[:, last], part[:, 0])]
    assert shares[0] == pytest.approx(shares[1], abs=0.02)


def test_a_single_axis_has_itself_for_a_marginal() -> None:
    with pytest.raises(ValueError, match=r"Expected `axes` to be \[0\]. Got \[0, 0\]"):
        AsJoint(GaussianPrior(mean=1, std=1).on(REAL)).marginal([0, 0])
