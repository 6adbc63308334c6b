"""Predictions of the Gaussian process."""

import numpy as np
import pytest
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import ConstantKernel, Matern, WhiteKernel

from hypermap_lite.space import PermutationParameter
from hypermap_lite.space.permutation import EMBEDDINGS
from hypermap_lite.surrogates import GaussianProcess
from hypermap_lite.surrogates.gaussian_process import GaussianProcessPosterior
from hypermap_lite.surrogates.kernels import MaternHammingKernel
from hypermap_lite.surrogates.marginal_likelihood import Hyperparameters
from hypermap_lite.surrogates.paths import Features
from hypermap_lite.surrogates.process import Process, Standardized
from tests.slow import slow_after

RNG = np.random.default_rng(0)
X = RNG.random((20, 2))
Z = RNG.random((7, 2))
Y = np.column_stack([np.sin(5 * X[:, 0]) + X[:, 1], 100 * (X[:, 1] - 0.3) ** 2 + 40])
Y = Y + np.array([0.05, 1.0]) * RNG.standard_normal(Y.shape)
ORDERED = np.ones(2, dtype=bool)
ALL = np.ones(len(X), dtype=bool)


def fit(X: np.ndarray, Y: np.ndarray, **options: bool) -> GaussianProcessPosterior:
    posterior = GaussianProcess(**options).fit(X, Y, is_ordered=np.ones(X.shape[1], bool), rng=np.random.default_rng(0))
    assert isinstance(posterior, GaussianProcessPosterior)
    return posterior


def test_predictions_equal_scikit_learns_at_equal_hyperparameters() -> None:
    h = Hyperparameters(np.array([0.4, 0.9]), 1.3, 0.02)
    output = Standardized.of(Y[:, 0])
    process = Process.condition(X, output, h, ORDERED)
    kernel = ConstantKernel(1.3) * Matern(h.lengthscales, nu=2.5) + WhiteKernel(0.02)
    oracle = GaussianProcessRegressor(kernel, alpha=0, optimizer=None).fit(X, output.values - process.mean)
    mean, std = oracle.predict(Z, return_std=True)
    prediction = GaussianProcessPosterior(processes=(process,), may_be_best=ALL, lacks_noise=(False,)).predict(Z)
    assert prediction.mean[:, 0] == pytest.approx(output.offset + output.scale * (mean + process.mean), rel=1e-8)
    noise_free = np.sqrt(std**2 - 0.02)
    assert prediction.std[:, 0] == pytest.approx(output.scale * noise_free, rel=1e-6)


def test_objectives_are_modelled_independently() -> None:
    both, second = fit(X, Y), fit(X, Y[:, 1:])
    assert both.predict(Z).mean[:, 1] == pytest.approx(second.predict(Z).mean[:, 0])


def test_shifting_and_scaling_outputs_shifts_and_scales_predictions() -> None:
    a, b = fit(X, Y[:, :1]).predict(Z), fit(X, 1000 * Y[:, :1] - 7).predict(Z)
    assert b.mean == pytest.approx(1000 * a.mean - 7, rel=1e-4)
    assert b.std == pytest.approx(1000 * a.std, rel=1e-3)


def test_fantasies_average_to_the_posterior() -> None:
    posterior = fit(X, Y)
    fantasies = posterior.fantasies(np.empty((0, 2)), 2048, np.random.default_rng(1))
    conditional, prediction = fantasies.field(Z), posterior.predict(Z)
    scale = Y.std(axis=0)
    assert conditional.mean.mean(axis=0) / scale == pytest.approx(prediction.mean / scale, abs=2e-3)
    total = np.sqrt(conditional.mean.var(axis=0) + conditional.std[0] ** 2)
    assert total / scale == pytest.approx(prediction.std / scale, abs=5e-3)


def test_each_fantasy_goes_through_its_own_values() -> None:
    fantasies = fit(X, Y).fantasies(Z[:2], 8, np.random.default_rng(1))
    conditional = fantasies.field(np.vstack([X, Z[:2]]))
    assert conditional.mean / Y.std(axis=0) == pytest.approx(fantasies.values / Y.std(axis=0), abs=1e-3)
    assert (conditional.std / Y.std(axis=0)).max() < 1e-2


def test_pending_points_are_drawn_with_their_uncertainty() -> None:
    posterior = fit(X, Y)
    drawn = posterior.fantasies(Z[:1], 2048, np.random.default_rng(1)).values[:, -1, :]
    assert drawn.std(axis=0) == pytest.approx(posterior.predict(Z[:1]).std[0], rel=0.05)


def test_a_believer_keeps_the_mean_and_loses_the_uncertainty_at_the_pending_point() -> None:
    posterior = fit(X, Y)
    believer = posterior.believe(Z[:1])
    assert believer.predict(Z).mean == pytest.approx(posterior.predict(Z).mean, rel=1e-2)
    assert np.all(believer.predict(Z[:1]).std < posterior.predict(Z[:1]).std)


def test_sample_paths_average_to_the_posterior() -> None:
    posterior = fit(X, Y)
    paths = np.array([posterior.sample_path(np.random.default_rng(i), 256)(Z).mean[0] for i in range(300)])
    prediction, scale = posterior.predict(Z), Y.std(axis=0)
    assert paths.mean(axis=0) / scale == pytest.approx(prediction.mean / scale, abs=0.05)
    assert paths.std(axis=0) / scale == pytest.approx(prediction.std / scale, abs=0.06)


@pytest.mark.parametrize("kind", ["field", "fantasies", "path"])
@pytest.mark.parametrize("categorical", [False, True])
def test_gradients_agree_with_finite_differences(kind: str, categorical: bool) -> None:
    is_ordered = np.array([True, not categorical])
    A, B = X.copy(), Z.copy()
    if categorical:
        A[:, 1], B[:, 1] = np.where(A[:, 1] < 0.5, 0.25, 0.75), np.where(B[:, 1] < 0.5, 0.25, 0.75)
    posterior = GaussianProcess().fit(A, Y, is_ordered=is_ordered, rng=np.random.default_rng(0))
    field = {
        "field": posterior.field,
        "fantasies": posterior.fantasies(B[:2], 4, np.random.default_rng(1)).field,
        "path": posterior.sample_path(np.random.default_rng(1), 64),
    }[kind]
    c = field(B)
    by_mean, by_std = RNG.standard_normal(c.mean.shape), RNG.standard_normal(c.std.shape)
    assert c.pullback is not None
    gradient = c.pullback(by_mean, by_std)
    step = np.array([1e-6, 0.0])
    above, below = field(B + step), field(B - step)
    numeric = ((above.mean - below.mean) * by_mean).sum(axis=(0, 2)) + ((above.std - below.std) * by_std).sum(
        axis=(0, 2)
    )
    assert gradient[:, 0] == pytest.approx(numeric / 2e-6, rel=1e-3, abs=1e-3 * Y.std())
    if categorical:
        assert np.array_equal(gradient[:, 1], np.zeros(len(B)))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("inputs", "outputs"),
    [
        pytest.param(X[:1], Y[:1], id="single"),
        pytest.param(X, np.full((20, 1), 3.0), id="constant"),
        pytest.param(X, np.zeros((20, 1)), id="zero"),
        pytest.param(np.repeat(X[:4], 5, axis=0), Y[:, :1], id="duplicates"),
        pytest.param(np.repeat(X[:1], 20, axis=0), Y[:, :1], id="one-point-many-times"),
        pytest.param(X, Y[:, :1] * 1e300, id="huge"),
        pytest.param(X, Y[:, :1] * 1e-300, id="tiny"),
        pytest.param(X, np.where(np.arange(20) == 3, 1e12, Y[:, 0])[:, None], id="outlier"),
        pytest.param(X * 1e-9 + 0.5, Y[:, :1], id="clustered"),
        pytest.param(RNG.random((20, 30)), Y, id="more-axes-than-points"),
    ],
)
@pytest.mark.parametrize("noise", [True, False])
def test_difficult_data_give_finite_predictions(inputs: np.ndarray, outputs: np.ndarray, noise: bool) -> None:
    posterior = fit(inputs, outputs, noise=noise)
    points = np.random.default_rng(2).random((5, inputs.shape[1]))
    prediction = posterior.predict(points)
    assert np.isfinite(prediction.mean).all()
    assert np.isfinite(prediction.std).all()
    assert np.isfinite(posterior.fantasies(points[:1], 4, np.random.default_rng(0)).field(points).mean).all()
    assert np.isfinite(posterior.sample_path(np.random.default_rng(0), 16)(points).mean).all()


def test_a_covariance_that_cannot_be_factorized_leaves_the_mean_of_the_data(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("process", "gaussian_process"):
        monkeypatch.setattr(f"hypermap_lite.surrogates.{module}.safe_cholesky", lambda *arguments: None)
    h = Hyperparameters(np.array([0.4, 0.9]), 1.3, 0.02)
    process = Process.condition(X, Standardized.of(Y[:, 0]), h, ORDERED)
    posterior = GaussianProcessPosterior(processes=(process,), may_be_best=ALL, lacks_noise=(False,))
    assert posterior.predict(Z).mean[:, 0] == pytest.approx(np.full(7, Y[:, 0].mean()), abs=1e-3)
    assert posterior.predict(Z).std[:, 0] == pytest.approx(np.full(7, np.sqrt(1.3) * Y[:, 0].std()), rel=1e-3)
    assert np.isfinite(posterior.fantasies(Z[:1], 4, np.random.default_rng(0)).field(Z).mean).all()


def test_features_of_categories_average_to_the_kernel() -> None:
    codes = np.array([0.25, 0.75])
    points = np.column_stack([np.full(2, 0.3), codes])
    kernel = MaternHammingKernel(np.array([0.5, 0.7]), np.array([True, False]))
    h = Hyperparameters(np.array([0.5, 0.7]), 1.0, 0.01)
    process = Process.condition(points[:1], Standardized.of(np.zeros(1)), h, kernel.is_ordered)
    draws = np.array([Features.draw(process, 64, np.random.default_rng(i))(points)[0] for i in range(3000)])
    assert draws.T @ draws / 3000 == pytest.approx(kernel(points, points), abs=0.06)


def test_without_noise_the_prediction_goes_through_the_data() -> None:
    prediction = fit(X, Y, noise=False).predict(X)
    assert prediction.mean / Y.std(axis=0) == pytest.approx(Y / Y.std(axis=0), abs=1e-3)


@pytest.mark.parametrize("kernel", slow_after(1, EMBEDDINGS))
def test_features_of_permutations_average_to_the_kernel(kernel: str) -> None:
    parameter = PermutationParameter(name="order", size=4, kernel=kernel)
    points = np.column_stack([np.full(3, 0.3), parameter.encode([(0, 1, 2, 3), (1, 0, 2, 3), (3, 2, 1, 0)])])
    h = Hyperparameters(np.array([0.5, 0.7]), 1.0, 0.01)
    output = Standardized.of(np.zeros(1))
    process = Process.condition(points[:1], output, h, np.array([True, False]), {1: parameter})
    draws = np.array([Features.draw(process, 64, np.random.default_rng(i))(points)[0] for i in range(3000)])
    assert draws.T @ draws / 3000 == pytest.approx(process.kernel(points, points), abs=0.06)


def test_what_is_learned_of_one_order_is_believed_of_orders_alike() -> None:
    parameter = PermutationParameter(name="order", size=6)
    rng = np.random.default_rng(0)
    orders = parameter.snap(rng.random((40, 1))[:, 0])[:, None]

    def cost(codes: np.ndarray) -> np.ndarray:
        return (parameter.positions(codes) * np.arange(6)).sum(axis=1)

    posterior = GaussianProcess().fit(
        orders, cost(orders[:, 0])[:, None], is_ordered=np.zeros(1, bool), rng=rng, permutations={0: parameter}
    )
    new = parameter.snap(rng.random(200))
    predicted = posterior.predict(new[:, None]).mean[:, 0]
    assert np.corrcoef(predicted, cost(new))[0, 1] > 0.95


def test_exact_rows_are_gone_through_and_uncertain_ones_smoothed() -> None:
    A = np.linspace(0, 1, 12)[:, None]
    truth = np.sin(5 * A)
    values = truth + np.where(np.arange(12)[:, None] % 2, 0.5 * np.cos(40 * A), 0.0)
    variance = np.where(np.arange(12)[:, None] % 2, 0.25, 1e-8)
    posterior = GaussianProcess(noise_from_replicates=True).fit(
        A, values, is_ordered=np.ones(1, bool), rng=np.random.default_rng(0), noise_variance=variance
    )
    prediction = posterior.predict(A)
    assert np.abs(prediction.mean - values)[::2].max() < 0.01
    assert np.abs(prediction.mean - truth)[1::2].mean() < 0.5 * np.abs(values - truth)[1::2].mean()
    assert prediction.std[1::2].min() > prediction.std[::2].max()


def test_known_noise_is_in_the_units_of_the_outputs() -> None:
    options = {"is_ordered": np.ones(X.shape[1], bool), "rng": np.random.default_rng(0)}
    variance = np.random.default_rng(3).uniform(0.01, 0.1, (len(X), 1))
    a = GaussianProcess().fit(X, Y[:, :1], noise_variance=variance, **options).predict(Z)
    b = GaussianProcess().fit(X, 1000 * Y[:, :1] - 7, noise_variance=1e6 * variance, **options).predict(Z)
    assert b.mean == pytest.approx(1000 * a.mean - 7, rel=1e-4, abs=1e-2)
    assert b.std == pytest.approx(1000 * a.std, rel=1e-4)


def test_known_noise_goes_into_fantasies_paths_and_believers() -> None:
    variance = np.full((len(X), Y.shape[1]), 0.05)
    variance[0] = 100.0
    posterior = GaussianProcess().fit(
        X, Y, is_ordered=np.ones(X.shape[1], bool), rng=np.random.default_rng(0), noise_variance=variance
    )
    process = posterior.processes[0]
    assert process.noise_variances[0] / process.noise_variances[1] == pytest.approx(2000, rel=1e-6)
    rng = np.random.default_rng(1)
    draws = np.array([posterior.sample_path(rng, 512)(X[:3]).mean[0] for _ in range(200)])
    expected = posterior.predict(X[:3])
    assert draws.mean(axis=0) == pytest.approx(expected.mean, abs=5 * expected.std.max() / np.sqrt(200) + 0.05)
    assert draws.std(axis=0) == pytest.approx(expected.std, rel=0.35)
    believed = posterior.believe(Z[:2])
    assert believed.processes[0].known_noise.shape == (len(X) + 2,)
    assert believed.predict(Z[:2]).mean == pytest.approx(posterior.predict(Z[:2]).mean, abs=1e-6)


@pytest.mark.parametrize("variance", [0.0, 1e300, 1e-300])
def test_any_known_variance_gives_finite_predictions(variance: float) -> None:
    posterior = GaussianProcess().fit(
        X,
        Y,
        is_ordered=np.ones(X.shape[1], bool),
        rng=np.random.default_rng(0),
        noise_variance=np.full(Y.shape, variance),
    )
    assert np.isfinite(posterior.predict(Z).mean).all()


def test_surrogate_without_noise_takes_no_notice_of_it() -> None:
    options = {"is_ordered": np.ones(X.shape[1], bool), "rng": np.random.default_rng(0)}
    model = GaussianProcess(noise=False)
    with_it = model.fit(X, Y, noise_variance=np.ones(Y.shape), **options).predict(Z)
    assert np.array_equal(with_it.mean, model.fit(X, Y, **options).predict(Z).mean)


def left_out(process: Process) -> np.ndarray:
    """Return what is predicted of each output, in standardized units, from all the others."""
    n, h, ordered = len(process.X), process.hyperparameters, process.kernel.is_ordered
    means = []
    for i in range(n):
        rest = np.arange(n) != i
        output = Standardized(process.output.values[rest], 0.0, 1.0)
        known = None if process.known_noise is None else process.known_noise[rest]
        means.append(
            Process.condition(process.X[rest], output, h, ordered, known_noise=known).joint(process.X[i : i + 1])[0][0]
        )
    return np.array(means)


@pytest.mark.parametrize("known", [None, np.linspace(0.5, 2, len(X))])
@pytest.mark.parametrize("counts", [ALL, np.arange(len(X)) % 3 > 0])
def test_share_explained_is_that_of_predictions_without_the_output(
    known: np.ndarray | None, counts: np.ndarray
) -> None:
    h = Hyperparameters(lengthscales=np.array([0.3, 0.7]), output_variance=1.3, noise_variance=0.04)
    process = Process.condition(X, Standardized.of(Y[:, 0]), h, ORDERED, known_noise=known)
    y = process.output.values[counts]
    others = (y.sum() - y) / (len(y) - 1)
    errors = np.square(y - left_out(process)[counts]).sum(), np.square(y - others).sum()
    assert process.explained(counts) == pytest.approx(1 - errors[0] / errors[1])


def test_what_follows_the_inputs_is_explained_and_noise_is_not() -> None:
    noise = np.random.default_rng(2).standard_normal(len(X))
    followed, nothing, same = fit(X, np.column_stack([Y[:, 0], noise, np.ones(len(X))])).explained()
    assert followed > 0.8
    assert nothing <= 0
    assert same == 1


def test_nothing_is_explained_if_the_covariance_cannot_be_factorized(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hypermap_lite.surrogates.process.safe_cholesky", lambda K: None)
    h = Hyperparameters(lengthscales=np.ones(2), output_variance=1.0, noise_variance=0.01)
    process = Process.condition(X, Standardized.of(Y[:, 0]), h, ORDERED)
    assert process.explained(ALL) == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize(
    ("values", "has_tail"),
    [
        (lambda X: np.sin(5 * X[:, 0]) + X[:, 1], False),
        (lambda X: 100 * (X[:, 1] - 0.3) ** 2 + X[:, 0], False),  # large values that say what the function is like
        (lambda X: np.where(X.sum(axis=1) > 1, 1e6, X[:, 0]), True),
        (lambda X: np.where(X.sum(axis=1) > 1, 1e4 * X[:, 1] ** 3, X[:, 0]), True),
        (lambda X: np.exp(12 * X[:, 0] + 3 * X[:, 1]), True),
    ],
)
def test_tails_are_compressed_where_that_makes_all_outputs_likelier(values, has_tail: bool) -> None:
    for seed in range(4):
        X = np.random.default_rng(seed).random((24, 2))
        Y = values(X)[:, None]
        (tail,) = GaussianProcess().tails(X, Y, np.array([-np.inf]), is_ordered=ORDERED)
        assert (tail is not None) == has_tail
        assert GaussianProcess(compress_tails=False).tails(X, Y, np.zeros(1), is_ordered=ORDERED) == (None,)


def test_what_counts_is_not_compressed() -> None:
    X = np.random.default_rng(0).random((24, 2))
    Y = np.column_stack([np.exp(12 * X[:, 0] + 3 * X[:, 1])] * 2)
    tails = GaussianProcess().tails(X, Y, np.array([2e3, 1e9]), is_ordered=ORDERED)
    assert tails[0] is not None
    assert tails[0].limit >= 2e3
    assert tails[1] is None
