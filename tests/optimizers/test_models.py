"""What the history teaches: the chain of fits."""

from typing import Any

import numpy as np
import pytest

from hypermap_lite.assembly import build_optimizer
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.optimizers.bayesian import BayesianOptimizer
from hypermap_lite.optimizers.models import FIRST_MILESTONE, milestones
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.surrogates.gaussian_process import GaussianProcess, GaussianProcessPosterior
from tests.optimizers.runs import resumed, scenario_of


def test_milestones_grow_by_the_factor() -> None:
    assert list(milestones(20, 1.5)) == [8, 12, 18]
    assert list(milestones(FIRST_MILESTONE, 1.5)) == []


def noisy_after_smooth(n: int) -> list[Evaluation]:
    """Return evaluations whose first few look like a rough function without noise, and the rest like noise."""
    rng = np.random.default_rng(4)
    rows = []
    for trial in range(n):
        a, b = rng.random(2)
        value = float(np.sign(np.sin(9 * a)) + 0.7 * rng.standard_normal() * (trial >= 8))
        suggestion = Suggestion(trial=trial, configuration={"a": a, "b": 10 * b - 5}, phase="design")
        rows.append(Evaluation(suggestion=suggestion, state=State.COMPLETED, values={"y": value}))
    return rows


def fitted(rows: list[Evaluation], **surrogate: Any) -> GaussianProcessPosterior:
    scenario = scenario_of(objectives=[{"name": "y"}], surrogate={"type": "gaussian_process", **surrogate})
    optimizer = resumed(scenario, rows)
    assert isinstance(optimizer, BayesianOptimizer)
    posterior = optimizer.posterior()
    assert isinstance(posterior, GaussianProcessPosterior)
    return posterior


@pytest.mark.parametrize("n", [8, 16, 30])
def test_a_milestones_fit_starts_anew_too(n: int, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[int, bool, bool]] = []
    fit = GaussianProcess.fit

    def watched(self: GaussianProcess, X: Any, Y: Any, *, start: Any = None, anew: bool = False, **rest: Any) -> Any:
        asked.append((len(X), start is not None, anew))
        return fit(self, X, Y, start=start, anew=anew, **rest)

    monkeypatch.setattr(GaussianProcess, "fit", watched)
    fitted(noisy_after_smooth(n))
    steps = [*milestones(n, 1.2)]
    is_milestone = n in milestones(n + 1, 1.2)
    assert asked == [*((k, k > FIRST_MILESTONE, True) for k in steps), (n, bool(steps), is_milestone)]


def test_a_chain_of_fits_comes_as_far_as_fits_that_start_anew_each_time() -> None:
    rows = noisy_after_smooth(44)
    chained, restarted = (fitted(rows, restart=restart).hyperparameters[0] for restart in (False, True))
    assert chained.noise_variance == pytest.approx(restarted.noise_variance, rel=0.05)
    assert chained.lengthscales == pytest.approx(restarted.lengthscales, rel=0.1)


def test_a_fit_does_not_depend_on_when_it_was_asked_for() -> None:
    rows = noisy_after_smooth(30)
    optimizer = build_optimizer(load_scenario(scenario_of(objectives=[{"name": "y"}])))
    assert isinstance(optimizer, BayesianOptimizer)
    for row in rows:
        optimizer.history.append(row)
        if len(optimizer.history) > 5:
            last = optimizer.posterior()
    X = np.random.default_rng(0).random((5, 2))
    assert np.array_equal(last.predict(X).mean, fitted(rows).predict(X).mean)
