"""Whether roughness is told from noise: a model without noise beside one with it."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.stats import lognorm, norm

from hypermap_lite import Evaluation, Optimizer
from hypermap_lite.optimizers.models import milestones
from hypermap_lite.scenario import load_scenario
from hypermap_lite.surrogates import GaussianProcess, noise_free
from hypermap_lite.surrogates.fitted import Fitted
from hypermap_lite.surrogates.gaussian_process import GaussianProcessPosterior
from hypermap_lite.surrogates.marginal_likelihood import HyperPrior, MarginalLikelihood, fit_hyperparameters
from hypermap_lite.surrogates.noise_free import NOTICEABLE, likelier_without_noise
from hypermap_lite.surrogates.process import Standardized
from tests.slow import slow_after

BETWEEN = np.linspace(0.02, 0.98, 97)[:, None]


def points(seed: int, n: int = 30) -> np.ndarray:
    """Return points of a line; not a grid, whose points are too far from each other to tell noise from roughness."""
    return np.random.default_rng(100 + seed).random((n, 1))


X = points(13)


def rough(x: np.ndarray) -> np.ndarray:
    """Return the function of Gramacy and Lee (2012) on the unit line: ten waves on a slope."""
    z = 0.5 + 2 * x[:, 0]
    return np.sin(10 * np.pi * z) / (2 * z) + (z - 1) ** 4


def smooth(x: np.ndarray) -> np.ndarray:
    return np.sin(4 * x[:, 0])


def fitted(y: np.ndarray, x: np.ndarray) -> Fitted:
    """Return the fit with noise."""
    output, is_ordered = Standardized.of(y), np.ones(x.shape[1], dtype=bool)
    prior = HyperPrior.over(
        is_ordered, {}, noise_floor=1e-10, noise_tail=5.0, lengthscale_location=-0.5, lengthscale_sigma=0.7
    )
    likelihood = MarginalLikelihood(x, output.values, is_ordered, prior)
    best = fit_hyperparameters(likelihood, [prior.mode()])
    return Fitted(output=output, likelihood=likelihood, hyperparameters=best)


def posterior(y: np.ndarray, x: np.ndarray, **options: bool) -> GaussianProcessPosterior:
    """Return what is known after the last of a chain of fits, as there is in a run."""
    model, start = GaussianProcess(**options), None
    for n in [*milestones(len(x), 1.2), len(x)]:
        found = model.fit(
            x[:n],
            y[:n, None],
            is_ordered=np.ones(x.shape[1], dtype=bool),
            rng=np.random.default_rng(0),
            start=start,
            anew=n < len(x),
        )
        start = found.start
    assert isinstance(found, GaussianProcessPosterior)
    return found


def error(found: GaussianProcessPosterior) -> float:
    return float(np.abs(found.predict(BETWEEN).mean[:, 0] - rough(BETWEEN)).mean())


@pytest.mark.parametrize(("seed", "n"), [(7, 24), (13, 20), (13, 24), (5, 30), (7, 30), (13, 30), (14, 30), (17, 30)])
def test_roughness_is_not_taken_for_noise(seed, n) -> None:
    x = points(seed, n)
    believed, doubted = posterior(rough(x), x), posterior(rough(x), x, doubt_noise=True)
    assert believed.hyperparameters[0].noise_variance > 0.02
    assert doubted.hyperparameters[0].noise_variance < 1e-4
    assert error(doubted) < 0.8 * error(believed)


@pytest.mark.parametrize(("d", "n", "sd"), slow_after(1, [(1, 20, 0.5), (1, 20, 1.0), (1, 30, 0.5), (2, 30, 1.0)]))
def test_noise_stays_noise(d, n, sd) -> None:
    n_noisy = 0
    for seed in range(8):
        rng = np.random.default_rng(7000 + seed)
        x = rng.random((n, d))
        truth = np.sin(4 * x).sum(axis=1)
        y = truth + sd * truth.std() * rng.standard_normal(n)
        believed, doubted = (posterior(y, x, doubt_noise=b).hyperparameters[0].noise_variance for b in (False, True))
        if believed > NOTICEABLE:
            n_noisy += 1
            assert doubted == pytest.approx(believed, rel=0.05)
    assert n_noisy >= 3


def log_density(fit: Fitted) -> float:
    """Return that of outputs and hyperparameters, the noise's own relative to exp(-8), its most likely variance."""
    h, k, d = fit.hyperparameters, fit.process, fit.likelihood.X.shape[1]
    K = h.output_variance * k.kernel(k.X, k.X) + h.noise_variance * np.eye(len(k.X))
    ones = np.ones(len(K))
    y = fit.output.values
    mean = (ones @ np.linalg.solve(K, y)) / (ones @ np.linalg.solve(K, ones))
    of_outputs = -0.5 * ((y - mean) @ np.linalg.solve(K, y - mean) + np.linalg.slogdet(2 * np.pi * K).logabsdet)
    location = -0.5 + 0.5 * math.log(d)
    of_lengthscales = lognorm(0.7, scale=math.exp(location)).logpdf(h.lengthscales).sum()
    of_variance = norm(0, 2).logpdf(math.log(h.output_variance))
    above = math.log(h.noise_variance) + 8
    of_noise = -0.5 * (above / (2 if above > 0 else 5)) ** 2 if fit.likelihood.prior.has_noise else 0.0
    return float(of_outputs + of_lengthscales + of_variance + of_noise)


def test_the_likelier_model_is_taken() -> None:
    margins = []
    for seed in range(24):
        for n in (16, 20, 24, 30):
            fit = fitted(rough(points(seed, n)), points(seed, n))
            if fit.hyperparameters.noise_variance <= NOTICEABLE:
                continue
            free = replace(fit.likelihood, prior=replace(fit.likelihood.prior, has_noise=False))
            other = replace(fit, likelihood=free, hyperparameters=fit_hyperparameters(free, [fit.hyperparameters]))
            margins.append(log_density(other) - log_density(fit))
            found = likelier_without_noise(fit, is_exact=True)
            if abs(margins[-1]) > 0.01:
                assert (found is not None) == (margins[-1] > 0)
            assert found is None or not found.likelihood.prior.has_noise
    # close decisions, and some either way
    assert sum(0 < m < 3 for m in margins) >= 2
    assert sum(-3 < m < 0 for m in margins) >= 2


def test_where_nothing_can_hide_nothing_is_compared() -> None:
    fit = fitted(smooth(X), X)
    assert fit.hyperparameters.noise_variance < NOTICEABLE
    assert likelier_without_noise(fit, is_exact=False) is None


def test_a_few_outputs_keep_their_noise(monkeypatch) -> None:
    fit = fitted(rough(X), X)
    monkeypatch.setattr(noise_free, "FEWEST", len(X) + 1)
    assert likelier_without_noise(fit, is_exact=False) is None
    monkeypatch.setattr(noise_free, "FEWEST", len(X))
    assert likelier_without_noise(fit, is_exact=False) is not None


def test_known_noise_is_not_doubted() -> None:
    options = {"noise_from_replicates": True}
    believed, doubted = posterior(rough(X), X, **options), posterior(rough(X), X, doubt_noise=True, **options)
    assert believed.hyperparameters[0].noise_variance == doubted.hyperparameters[0].noise_variance


# the noise is doubted from the 20th evaluation on
WAVES = {
    "seed": 6,
    "input_parameters": {"x": {"parameter_type": "real", "values": [0, 1]}},
    "objectives": [{"name": "loss"}],
    "budget": {"evaluations": 30},
}
BELIEVED = {**WAVES, "surrogate": {"doubt_noise": False}}


def completed(scenario: Mapping[str, Any], rows: Sequence[Evaluation] = ()) -> list[Evaluation]:
    optimizer = Optimizer(dict(scenario), evaluations=rows)
    for _ in range(30 - len(rows)):
        (suggestion,) = optimizer.ask()
        x = float(suggestion.configuration["x"])
        optimizer.tell(suggestion, {"loss": float(rough(np.array([[x]]))[0])})
    return list(optimizer.history)


def places(rows: Sequence[Evaluation]) -> list[float]:
    return [float(row.configuration["x"]) for row in rows]


def test_a_run_that_goes_on_suggests_what_it_would_have_suggested() -> None:
    whole = completed(WAVES)
    assert places(whole) != places(completed(BELIEVED))
    for k in (17, 19, 23, 26):
        assert places(completed(WAVES, whole[:k])) == places(whole)


@pytest.mark.parametrize(("scenario", "lines"), [(WAVES, 1), (BELIEVED, 0)])
def test_the_log_says_once_that_the_noise_is_doubted(scenario, lines, caplog) -> None:
    caplog.set_level("INFO", logger="hypermap_lite")
    completed(scenario)
    assert caplog.text.count("evaluations: loss is more likely rough than noisy; the model goes without noise") == lines


@pytest.mark.parametrize(("n_objectives", "preset", "doubts"), [(1, {}, True), (2, {}, False), (1, "paper", False)])
def test_one_objective_is_doubted(n_objectives, preset, doubts) -> None:
    scenario = load_scenario(
        {
            "input_parameters": {"x": {"parameter_type": "real", "values": [0, 1]}},
            "objectives": [{"name": f"f{k}"} for k in range(n_objectives)],
            **({"preset": preset} if preset else {}),
        }
    )
    assert scenario.surrogate.options["doubt_noise"] is doubts
