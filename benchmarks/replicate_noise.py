"""See what a Gaussian process gains from the noise that replicates tell of.

    python benchmarks/replicate_noise.py --seeds 20

Two functions of four parameters: a bowl in a plateau of failure, whose results scatter most at the cliff and hardly on
the plateau, and a smooth one whose noise grows tenfold along an axis. Of half of the configurations the place
is random, the others lie near the optimum. Models see the means of r replicates; they are asked for the noise-free
function at the data, and at 400 other points, half of them near the optimum.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt
from reporting import ResultTable, machine

from hypermap_lite.history.replicate_noise import shrunk_variances
from hypermap_lite.surrogates import marginal_likelihood
from hypermap_lite.surrogates.gaussian_process import GaussianProcess

FloatArray = npt.NDArray[np.float64]
RESULTS = Path(__file__).parent / "results"
COLUMNS = (
    "function",
    "n",
    "replicates",
    "seed",
    "model",
    "rmse_at_data",
    "lpd_at_data",
    "rmse_elsewhere",
    "lpd_elsewhere",
)
KEY = COLUMNS[:5]
CASES = ((20, 3), (40, 3), (40, 7))
SMALLEST_STD = 0.02
CENTRE = 0.4


def plateau(X: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return mean and standard deviation of a bowl within a plateau of failure."""
    r = np.sqrt(((X - CENTRE) ** 2 * np.array([1, 2, 0.5, 1])).sum(axis=1))
    inside = 1 / (1 + np.exp((r - 0.5) / 0.03))
    bowl = -10 * np.exp(-((r / 0.35) ** 2)) * (1 + 0.3 * np.sin(6 * X[:, 0])) - 4
    return inside * bowl, 4 * np.sqrt(inside * (1 - inside)) + 0.6 * inside + 0.02


def smooth(X: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return mean and standard deviation of a smooth function."""
    return -5 * np.exp(-((X - CENTRE) ** 2).sum(axis=1) / 0.3), np.exp(2.25 * X[:, 1] - 2.2)


FUNCTIONS: Mapping[str, Callable[[FloatArray], tuple[FloatArray, FloatArray]]] = {"plateau": plateau, "smooth": smooth}


def models(own: FloatArray, truth: FloatArray, replicates: int) -> Iterator[tuple[str, FloatArray | None, float]]:
    """Yield name, variances of the means, shape (n, 1), and width of the prior on their factor."""
    freedom = np.full(own.shape, replicates - 1.0)
    yield "one learned noise", None, 0.3
    yield "pooled variance, factor 1.0", np.full(own.shape, own.mean() / replicates), 1.0
    for prior in (1.0, 4.0, 10.0):
        shrunk = shrunk_variances(own, freedom, prior)
        assert shrunk is not None
        for width in (0.01, 0.3, 1.0) if prior == 4 else (0.3,):
            yield f"shrunk by {prior:g}, factor {width:g}", shrunk / replicates, width
    yield "true variances, factor 0.01", truth / replicates, 0.01


def points(rng: np.random.Generator, n: int) -> FloatArray:
    """Return n points, half of them near the optimum."""
    near = np.clip(CENTRE + 0.18 * rng.standard_normal((n - n // 2, 4)), 0, 1)
    return np.vstack([rng.random((n // 2, 4)), near])


def measure(function: str, n: int, replicates: int, seed: int) -> Iterator[Mapping[str, object]]:
    """Yield a row per model."""
    rng, f = np.random.default_rng(seed), FUNCTIONS[function]
    X, Z = points(rng, n), points(np.random.default_rng(999), 400)
    mean, std = f(X)
    samples = mean[:, None] + std[:, None] * rng.standard_normal((n, replicates))
    own = samples.var(axis=1, ddof=1)[:, None]
    for name, variances, width in models(own, std[:, None] ** 2, replicates):
        marginal_likelihood.KNOWN_NOISE_SIGMA = width
        posterior = GaussianProcess().fit(
            X, samples.mean(axis=1)[:, None], is_ordered=np.ones(4, bool), rng=rng, noise_variance=variances
        )
        row: dict[str, object] = dict(zip(KEY, (function, n, replicates, seed, name), strict=True))
        for place, (A, truth) in {"at_data": (X, mean), "elsewhere": (Z, f(Z)[0])}.items():
            prediction = posterior.predict(A)
            error = prediction.mean[:, 0] - truth
            scale = np.maximum(prediction.std[:, 0], SMALLEST_STD)
            row[f"rmse_{place}"] = float(np.sqrt((error**2).mean()))
            row[f"lpd_{place}"] = float((-0.5 * (error / scale) ** 2 - np.log(scale)).mean())
        yield {column: row[column] for column in COLUMNS}


def main() -> None:
    """Measure what is missing, and write the page."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=20)
    seeds = parser.parse_args().seeds
    table = ResultTable(RESULTS / "replicate_noise.csv", COLUMNS, KEY)
    for function in FUNCTIONS:
        for n, replicates in CASES:
            for seed in range(seeds):
                for row in measure(function, n, replicates, seed):
                    table.fill({name: row[name] for name in KEY}, lambda *_, row=row: row)
    names = list(dict.fromkeys(row["model"] for row in table.rows))
    rows = []
    for function in FUNCTIONS:
        for n, replicates in CASES:
            for name in names:
                case = (function, str(n), str(replicates), name)
                chosen = [
                    r for r in table.rows if (r["function"], str(r["n"]), str(r["replicates"]), r["model"]) == case
                ]
                numbers = [np.median([float(r[column]) for r in chosen]) for column in COLUMNS[5:]]
                rows.append([function, str(n), str(replicates), name, *(f"{number:.3g}" for number in numbers)])
    table.write_page(
        RESULTS / "replicate_noise.md",
        title="The noise that replicates tell of",
        command=f"python benchmarks/replicate_noise.py --seeds {seeds}",
        text=f"{machine()}\n\nMedians over {seeds} seeds: error of the mean, and log density of the truth (a constant "
        "left out), at the data and at 400 other points.",
        header=["function", "n", "replicates", "model", "rmse at data", "lpd", "rmse elsewhere", "lpd"],
        rows=rows,
    )


if __name__ == "__main__":
    main()
