"""Mixtures over one and several parameters."""

import numpy as np
import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors import JointMixturePrior, MixturePrior
from hypermap_lite.space import IntegerParameter, RealParameter

BRANIN = [RealParameter(name="x1", low=-5, high=10), RealParameter(name="x2", low=0, high=15)]
OPTIMA = [(-np.pi, 12.275), (np.pi, 2.275), (9.42478, 2.475)]
THREE_MODES = JointMixturePrior(
    components=[{"mean": {"x1": a, "x2": b}, "std": {"x1": 0.5, "x2": 0.5}} for a, b in OPTIMA]
)


def grid(n: int) -> np.ndarray:
    u = (np.arange(n) + 0.5) / n
    return np.stack(np.meshgrid(u, u, indexing="ij"), axis=-1).reshape(-1, 2)


def test_joint_density_integrates_to_one() -> None:
    density = THREE_MODES.on(BRANIN)
    assert np.exp(density.log_density(grid(400))).mean() == pytest.approx(1.0, abs=1e-3)


def test_joint_samples_follow_the_scored_density() -> None:
    density = THREE_MODES.on(BRANIN)
    U = density.sample(20_000, np.random.default_rng(0))
    cells = np.floor(U * 5).astype(int)
    counts = np.bincount(cells[:, 0] * 5 + cells[:, 1], minlength=25)
    fine = np.exp(density.log_density(grid(250))).reshape(5, 50, 5, 50).mean(axis=(1, 3)).ravel() / 25
    assert np.allclose(counts / len(U), fine, atol=0.012)


def test_joint_means_stay_together() -> None:
    density = THREE_MODES.on(BRANIN)
    paired = np.array([[(OPTIMA[0][0] + 5) / 15, OPTIMA[0][1] / 15]])
    crossed = np.array([[(OPTIMA[0][0] + 5) / 15, OPTIMA[1][1] / 15]])
    assert density.log_density(paired)[0] - density.log_density(crossed)[0] > 50


def test_the_mode_is_the_heaviest_component() -> None:
    prior = MixturePrior(components=[{"mean": 0, "std": 1}, {"mean": 5, "std": 1, "weight": 4}])
    assert prior.on(BRANIN[0]).mode() == pytest.approx(10 / 15)


def test_integers_get_the_mass_of_their_bins() -> None:
    density = MixturePrior(components=[{"mean": 2, "std": 0.1}]).on(IntegerParameter(name="n", low=0, high=3))
    assert np.exp(density.log_density(np.array([0.125, 0.375, 0.625, 0.875]))) == pytest.approx([0, 0, 4, 0], abs=1e-5)


@pytest.mark.parametrize(
    ("components", "message"),
    [
        pytest.param([], "empty", id="empty"),
        pytest.param([{"mean": {"x1": 0}, "std": {"x1": 0}}], r"components\[0\].std.x1", id="zero-std"),
        pytest.param([{"mean": {"x1": 0}, "std": {"x1": 1}, "weight": -1}], "weight is -1", id="negative-weight"),
        pytest.param([{"mean": {"x1": 0}}], "'std' is missing", id="no-std"),
        pytest.param([{"mean": {"x1": 0}, "std": {"x1": 1}, "wieght": 1}], "Did you mean 'weight'", id="typo"),
        pytest.param([{"mean": {"x1": 0, "x2": 1}, "std": {"x1": 1}}], "names the parameters x1", id="std-lacks-one"),
        pytest.param(
            [{"mean": {"x1": 0}, "std": {"x1": 1}}, {"mean": {"x2": 0}, "std": {"x2": 1}}],
            "names the parameters x2",
            id="components-differ",
        ),
    ],
)
def test_impossible_components_are_refused(components: list, message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        JointMixturePrior(components=components)
