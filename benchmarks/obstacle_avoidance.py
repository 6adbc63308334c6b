"""Compare priors on obstacle avoidance: hypervolume against evaluations, over seeds.

    python benchmarks/obstacle_avoidance.py [--seeds 10] [--preset paper] [--jobs 2]

Runs the scenarios of `example_scenarios/robot/obstacle_avoidance/` through the command line, each seed in a run folder
of its own under `outputs/benchmarks/`, several at a time. A finished run is not run again and a stopped one goes on.
Writes the hypervolume after each evaluation as CSV, the figure, and a page that compares the variants.
"""

from __future__ import annotations

import argparse
import csv
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import numpy.typing as npt
from reporting import machine, markdown_table

from hypermap_lite.objectives import reference_point_of, to_minimization
from hypermap_lite.pareto import hypervolume_trace
from hypermap_lite.plotting import plot_function
from hypermap_lite.plotting.runs import load_run

ROOT = Path(__file__).parent.parent
SCENARIOS = ROOT / "example_scenarios" / "robot" / "obstacle_avoidance"
VARIANTS = {
    "random search": "random_search",
    "no prior": "no_prior",
    "operator prior": "operator_prior",
    "misleading prior": "misleading_prior",
    "prior sampling": "prior_sampling",
}
BASELINE = "no prior"
BOOTSTRAP = 10_000

FloatArray = npt.NDArray[np.float64]


def run(variant: str, seed: int, preset: str, folder: Path) -> None:
    """Run one variant with one seed, or go on with it."""
    scenario = SCENARIOS / f"{VARIANTS[variant]}.json"
    command = [sys.executable, "-m", "hypermap_lite", "run", str(scenario), "--seed", str(seed), "--quiet", "--no-plot"]
    command += ["--output-dir", str(folder)]
    if preset != "default":
        command += ["--set", f"preset={preset}"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def trace(folder: Path) -> FloatArray:
    """Return the hypervolume after each evaluation of a run, shape (n,)."""
    loaded = load_run(folder)
    reference = reference_point_of(loaded.objectives)
    assert reference is not None
    return hypervolume_trace(to_minimization(loaded.objectives, loaded.values), reference)


def first_reaching(mean: FloatArray, target: float) -> str:
    """Return after how many evaluations a mean trace reaches a value."""
    reached = np.flatnonzero(mean >= target)
    return str(int(reached[0]) + 1) if len(reached) else "not reached"


def ratio_interval(a: FloatArray, b: FloatArray) -> tuple[float, float]:
    """Return the 95 % bootstrap interval of the ratio of two means."""
    rng = np.random.default_rng(0)
    draws = [rng.choice(x, size=(BOOTSTRAP, len(x))).mean(axis=1) for x in (a, b)]
    low, high = np.quantile(draws[0] / draws[1], [0.025, 0.975])
    return float(low), float(high)


def comparison(traces: dict[str, FloatArray]) -> Iterator[tuple[str, ...]]:
    """Yield a row per variant, traces of shape (seeds, evaluations)."""
    baseline = traces[BASELINE]
    target = float(baseline.mean(axis=0)[-1])
    for variant, values in traces.items():
        final = values[:, -1]
        low, high = ratio_interval(final, baseline[:, -1])
        yield (
            variant,
            str(len(final)),
            f"{final.mean():.4g} ± {final.std(ddof=1) / np.sqrt(len(final)):.2g}",
            "" if variant == BASELINE else f"{final.mean() / target:.3f} ({low:.3f} to {high:.3f})",
            first_reaching(values.mean(axis=0), target),
        )


def main() -> None:
    """Run what is missing and write CSV, figure and page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--preset", default="default", choices=["default", "paper"])
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    arguments = parser.parse_args()
    stem = "obstacle_avoidance" + ("" if arguments.preset == "default" else f"_{arguments.preset}")
    runs = ROOT / "outputs" / "benchmarks" / stem
    folders = {v: [runs / VARIANTS[v] / str(seed) for seed in range(arguments.seeds)] for v in VARIANTS}
    with ThreadPoolExecutor(arguments.jobs) as pool:
        jobs = [
            pool.submit(run, v, seed, arguments.preset, folders[v][seed])
            for seed in range(arguments.seeds)
            for v in VARIANTS
        ]
        for job in jobs:
            job.result()
    traces = {variant: np.array([trace(f) for f in paths]) for variant, paths in folders.items()}
    with (arguments.output / f"{stem}.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("variant", "seed", "evaluation", "hypervolume"))
        for variant, values in traces.items():
            writer.writerows((variant, s, n + 1, f"{v:.8g}") for s, row in enumerate(values) for n, v in enumerate(row))
    repetitions = [(folder, variant) for variant, paths in folders.items() for folder in paths]
    plot_function("hypervolume")(
        [folder for folder, _ in repetitions],
        arguments.output / f"{stem}.png",
        labels=[label for _, label in repetitions],
    )
    header = ("variant", "seeds", "final hypervolume", "ratio to no prior (95 %)", "evaluations to its final mean")
    page = [
        f"# Priors on obstacle avoidance ({arguments.preset} method)",
        "",
        "    python benchmarks/obstacle_avoidance.py"
        + ("" if arguments.preset == "default" else f" --preset {arguments.preset}"),
        "",
        machine(),
        "60 configurations (12 of them the design, batches of 3) x 7 rollouts; mean ± standard error over the seeds;",
        "the interval of the ratio is a bootstrap over seeds; the last column is when the mean curve of a variant",
        "reaches the final mean of the one without prior.",
        "",
        *markdown_table(header, list(comparison(traces))),
        "",
        f"![hypervolume against evaluations]({stem}.png)",
    ]
    (arguments.output / f"{stem}.md").write_text("\n".join(page) + "\n")


if __name__ == "__main__":
    main()
