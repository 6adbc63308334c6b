"""What holds for every prior, whatever parameter it is placed on."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import chi2 as chi2_distribution

from hypermap_lite.priors import (
    PRIORS,
    BetaPrior,
    Density,
    GaussianPrior,
    MixturePrior,
    PiecewisePrior,
    UniformPrior,
    WeightsPrior,
)
from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, Parameter, RealParameter

REAL = RealParameter(name="x", low=-2.0, high=6.0)
LOG = RealParameter(name="x", low=1e-3, high=10.0, log=True)
INTEGER = IntegerParameter(name="x", low=0, high=7)
LOG_INTEGER = IntegerParameter(name="x", low=1, high=64, log=True)
ORDINAL = OrdinalParameter(name="x", values=(1.0, 5.0, 25.0))
CATEGORICAL = CategoricalParameter(name="x", values=("a", "b", "c", "d"))

CASES = [
    pytest.param(GaussianPrior(mean=1, std=0.5), REAL, id="gaussian"),
    pytest.param(GaussianPrior(mean=9, std=1), REAL, id="gaussian-mean-above-the-bounds"),
    pytest.param(GaussianPrior(mean=-50, std=2), REAL, id="gaussian-mean-far-below-the-bounds"),
    pytest.param(GaussianPrior(mean=0.1, std=0.5), LOG, id="gaussian-log"),
    pytest.param(GaussianPrior(mean=2, std=1.5), INTEGER, id="gaussian-integer"),
    pytest.param(GaussianPrior(mean=100, std=1), INTEGER, id="gaussian-integer-far-outside"),
    pytest.param(GaussianPrior(mean=8, std=0.3), LOG_INTEGER, id="gaussian-log-integer"),
    pytest.param(
        MixturePrior(components=[{"mean": 0, "std": 0.3}, {"mean": 5, "std": 1, "weight": 3}]), REAL, id="mixture"
    ),
    pytest.param(
        MixturePrior(components=[{"mean": 0, "std": 1}, {"mean": 6, "std": 1}]), INTEGER, id="mixture-integer"
    ),
    pytest.param(BetaPrior(shape="gaussian"), REAL, id="beta-gaussian"),
    pytest.param(BetaPrior(shape="decay"), REAL, id="beta-decay"),
    pytest.param(BetaPrior(shape="exponential"), INTEGER, id="beta-exponential-integer"),
    pytest.param(BetaPrior(alpha=2, beta=5), ORDINAL, id="beta-ordinal"),
    pytest.param(WeightsPrior(weights=[1, 0, 3]), ORDINAL, id="weights-ordinal"),
    pytest.param(WeightsPrior(weights=[0.1, 0.2, 0.3, 0.4]), CATEGORICAL, id="weights-categorical"),
    pytest.param(PiecewisePrior(knots=[1, 2, 3, 2, 1]), REAL, id="piecewise"),
    pytest.param(PiecewisePrior(knots=[0, 1, 0.2]), LOG, id="piecewise-log"),
    pytest.param(PiecewisePrior(knots=[3, 1]), INTEGER, id="piecewise-integer"),
    pytest.param(UniformPrior(), REAL, id="uniform"),
    pytest.param(UniformPrior(low=0, high=4), REAL, id="uniform-range"),
    pytest.param(UniformPrior(low=0.1), LOG, id="uniform-range-log"),
    pytest.param(UniformPrior(low=2, high=20), INTEGER, id="uniform-range-integer"),
    pytest.param(UniformPrior(low=2, high=5), LOG_INTEGER, id="uniform-range-log-integer"),
    pytest.param(UniformPrior(low=2, high=99), ORDINAL, id="uniform-range-ordinal"),
]


def edges_of(parameter: Parameter) -> np.ndarray:
    return np.linspace(0, 1, 21) if parameter.n_levels is None else parameter.bin_edges()


def masses_by_quadrature(density: Density, edges: np.ndarray) -> np.ndarray:
    def f(u: float) -> float:
        return float(np.exp(density.log_density(np.array([u])))[0])

    return np.array([quad(f, a, b, limit=200)[0] for a, b in pairwise(edges)])


def chi2_quantile(probability: float, degrees_of_freedom: int) -> float:
    return float(chi2_distribution.ppf(probability, degrees_of_freedom))


def test_every_prior_of_the_table_is_among_the_cases() -> None:
    assert {type(case.values[0]) for case in CASES} == set(PRIORS.values())


@pytest.mark.parametrize(("prior", "parameter"), CASES)
def test_density_integrates_to_one(prior: object, parameter: Parameter) -> None:
    assert masses_by_quadrature(prior.on(parameter), edges_of(parameter)).sum() == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize(("prior", "parameter"), CASES)
def test_samples_follow_the_scored_density(prior: object, parameter: Parameter) -> None:
    density = prior.on(parameter)
    edges = edges_of(parameter)
    n = 20_000
    counts = np.histogram(density.sample(n, np.random.default_rng(1)), bins=edges)[0]
    expected = n * masses_by_quadrature(density, edges)
    frequent = expected > 5
    chi2 = (((counts - expected) ** 2)[frequent] / expected[frequent]).sum()
    assert counts[~frequent].sum() <= 30 + 3 * expected[~frequent].sum()
    assert chi2 < chi2_quantile(0.9999, max(frequent.sum() - 1, 1))


@pytest.mark.parametrize(("prior", "parameter"), CASES)
def test_cdf_is_the_integral_of_the_density(prior: object, parameter: Parameter) -> None:
    density = prior.on(parameter)
    edges = edges_of(parameter)
    assert np.allclose(np.diff(density.cdf(edges)), masses_by_quadrature(density, edges), atol=1e-5)


@pytest.mark.parametrize(("prior", "parameter"), CASES)
def test_log_gradient_agrees_with_finite_differences_within_bins(prior: object, parameter: Parameter) -> None:
    density = prior.on(parameter)
    u = np.array([0.0501, 0.313, 0.61, 0.93])
    with np.errstate(invalid="ignore"):  # a level without weight is -inf on both sides
        numeric = (density.log_density(u + 1e-7) - density.log_density(u - 1e-7)) / 2e-7
    assert density.log_gradient(u) == pytest.approx(np.nan_to_num(numeric), rel=1e-4, abs=1e-4)


@pytest.mark.parametrize(("prior", "parameter"), CASES)
def test_mode_is_as_dense_as_any_sample(prior: object, parameter: Parameter) -> None:
    density = prior.on(parameter)
    peak = density.log_density(np.array([density.mode()]))[0]
    drawn = density.sample(2000, np.random.default_rng(0))
    inner = drawn[(drawn > 0.01) & (drawn < 0.99)]  # an unbounded density has no highest point at its edge
    assert np.all(density.log_density(inner) <= peak + 1e-9)


@pytest.mark.parametrize(("prior", "parameter"), CASES)
def test_samples_lie_in_the_unit_interval(prior: object, parameter: Parameter) -> None:
    u = prior.on(parameter).sample(1000, np.random.default_rng(0))
    assert np.all((u >= 0) & (u <= 1))


@pytest.mark.parametrize("log", [False, True])
def test_an_axis_of_many_levels_scores_what_it_samples(log: bool) -> None:
    parameter = IntegerParameter(name="x", low=1, high=10**6, log=log)
    density = (GaussianPrior(mean=1.4, std=0.01) if log else GaussianPrior(mean=500_000, std=0.4)).on(parameter)
    levels, counts = np.unique(parameter.decode(density.sample(5000, np.random.default_rng(0))), return_counts=True)
    codes = parameter.encode(list(levels))
    low, high = parameter.bins_of_levels(levels - 1)
    masses = np.exp(density.log_density(codes)) * (high - low)
    assert masses == pytest.approx(counts / 5000, abs=0.03)
    assert parameter.decode(np.array([density.mode()]))[0] == levels[np.argmax(counts)]


def test_units_play_no_part() -> None:
    metres = GaussianPrior(mean=0.02, std=0.01).on(RealParameter(name="x", low=0.0, high=0.08))
    millimetres = GaussianPrior(mean=20, std=10).on(RealParameter(name="x", low=0.0, high=80.0))
    u = np.linspace(0, 1, 11)
    assert np.allclose(metres.log_density(u), millimetres.log_density(u), rtol=1e-12)
