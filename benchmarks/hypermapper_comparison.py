"""Run HyperMapper and this package on the same scenarios and compare seconds per suggestion and what was found.

    python benchmarks/hypermapper_comparison.py --hypermapper PYTHON [--seeds 5] [--scenarios NAME,...]

PYTHON is an interpreter with HyperMapper installed, of an environment of its own, for HyperMapper needs old releases:

    python3.11 -m venv ~/hypermapper
    ~/hypermapper/bin/pip install setuptools==79.0.1 wheel cython
    ~/hypermapper/bin/pip install numpy==1.26.4 scipy==1.12.0 pandas==2.1.4 scikit-learn==1.3.2 matplotlib==3.7.5 \
        cma==4.5.0 jsonschema==4.26.0 pyDOE==0.9.3
    ~/hypermapper/bin/pip install --no-build-isolation paramz==0.9.6 GPy==1.13.2
    ~/hypermapper/bin/pip install --no-deps hypermapper==2.2.13

Both get the files of `example_scenarios/hypermapper/` with either model, and run in turn on one core. Seconds are those
of the whole run without its start and without the black box, per suggestion after the initial design. A run that has
its row is not repeated.
"""

from __future__ import annotations

import argparse
import functools
import json
import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from reporting import ResultTable, machine

from hypermap_lite import hypervolume

ROOT = Path(__file__).parent.parent
EXAMPLES = ROOT / "example_scenarios" / "hypermapper"
ONE_RUN = Path(__file__).with_name("hypermapper_one_run.py")
MODELS = ("random_forest", "gaussian_process")
PACKAGES = ("hypermapper", "hypermap_lite")
TIMEOUT = 7200.0
COLUMNS = (
    *("scenario", "model", "package", "seed", "iterations", "evaluations", "quality"),
    *("seconds_per_suggestion", "cpu_seconds_per_suggestion", "error"),
)


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What is known of a problem."""

    best: float
    """The smallest value, or the hypervolume of the whole front."""

    reference_point: tuple[float, float] | None = None


ANSWERS: Mapping[str, Answer] = {
    "branin": Answer(best=0.397887),
    "prior_currin": Answer(best=1.180408),
    "multiobjective_branin": Answer(best=8444.4, reference_point=(308.2, 25.0)),
    "ordinal_multiobjective_branin": Answer(best=8280.29, reference_point=(308.2, 25.0)),
    "chakong_haimes": Answer(best=37_865.0, reference_point=(260.0, 20.0)),
}


def quality(answer: Answer, results: Sequence[Any]) -> float:
    """Return the regret of the best value, or the share of the hypervolume."""
    if answer.reference_point is None:
        return min(results) - answer.best
    valid = [[value for name, value in row.items() if name != "Valid"] for row in results if row.get("Valid", True)]
    reached = hypervolume(np.array(valid), np.array(answer.reference_point)) if valid else 0.0
    return float(reached) / answer.best


def measure(
    scenario: str, model: str, package: str, seed: int, *, pythons: Mapping[str, str], iterations: int | None
) -> dict[str, Any]:
    """Run one case in a process of its own and return its row."""
    document = json.loads((EXAMPLES / f"{scenario}.json").read_text(encoding="utf-8"))
    document |= {"models": {"model": model}, "number_of_cpus": 1}
    if iterations is not None:
        document["optimization_iterations"] = iterations
    case = {"scenario": scenario, "model": model, "package": package, "seed": seed}
    row = dict.fromkeys(COLUMNS, "") | case | {"iterations": document["optimization_iterations"]}
    with tempfile.TemporaryDirectory() as folder:
        facts = run(Path(folder), document, scenario, package, seed, pythons[package])
    if isinstance(facts, str):
        return row | {"error": facts}
    n = len(facts["results"]) - document["design_of_experiment"]["number_of_samples"]
    return row | {
        "evaluations": len(facts["results"]),
        "quality": quality(ANSWERS[scenario], facts["results"]),
        "seconds_per_suggestion": facts["seconds"] / n,
        "cpu_seconds_per_suggestion": facts["cpu_seconds"] / n,
    }


def run(
    folder: Path, document: Mapping[str, Any], scenario: str, package: str, seed: int, python: str
) -> dict[str, Any] | str:
    """Return what a run took and found, or the last it said if it ended without a result."""
    (folder / "scenario.json").write_text(json.dumps(document), encoding="utf-8")
    program, result = EXAMPLES / f"{scenario}.py", folder / "result.json"
    variables = {key: value for key, value in os.environ.items() if key != "HYPERMAPPER_HOME"}
    variables |= {"PWD": str(folder), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    if package == "hypermap_lite":
        variables["PYTHONPATH"] = str(ROOT)
    finished = subprocess.run(
        [python, str(ONE_RUN), package, "scenario.json", str(program), str(seed), str(result)],
        cwd=folder,
        env=variables,
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
    )
    if not result.exists():
        said = (finished.stderr.strip() or finished.stdout.strip()).splitlines()
        return " ".join(said[-2:]) if said else f"exit status {finished.returncode}"
    facts: dict[str, Any] = json.loads(result.read_text(encoding="utf-8"))
    return facts


def summary(rows: Sequence[Mapping[str, Any]]) -> Iterator[tuple[str, ...]]:
    """Yield a row per scenario and model: medians over the seeds."""

    def median(package: str, column: str) -> float:
        values = [float(r[column]) for r in case if r["package"] == package and r[column] != ""]
        return statistics.median(values) if values else float("nan")

    for scenario, model in dict.fromkeys((row["scenario"], row["model"]) for row in rows):
        case = [row for row in rows if (row["scenario"], row["model"]) == (scenario, model)]
        seconds = [median(package, "seconds_per_suggestion") for package in PACKAGES]
        cpu = [median(package, "cpu_seconds_per_suggestion") for package in PACKAGES]
        found = [median(package, "quality") for package in PACKAGES]
        failed = [str(sum(row["package"] == package and row["error"] != "" for row in case)) for package in PACKAGES]
        yield (
            *(scenario, model, str(len({int(row["seed"]) for row in case}))),
            *(f"{value:.3f}" for value in (*seconds, *cpu)),
            f"{cpu[0] / cpu[1]:.1f}",
            "regret" if ANSWERS[scenario].reference_point is None else "share of hypervolume",
            *(f"{value:.4g}" for value in found),
            " / ".join(failed),
        )


def main() -> None:
    """Measure the missing cases and write the result page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hypermapper", metavar="PYTHON", help="an interpreter with HyperMapper installed")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--scenarios", default=",".join(ANSWERS))
    parser.add_argument("--models", default=",".join(MODELS))
    parser.add_argument("--iterations", type=int, help="instead of the scenarios' own, to try the benchmark")
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    arguments = parser.parse_args()
    theirs = arguments.hypermapper
    if theirs is None or subprocess.run([theirs, "-c", "import hypermapper"], capture_output=True).returncode != 0:
        print("Skipped: no Python with HyperMapper. Name one with --hypermapper; --help says how to make one.")
        return
    pythons = {"hypermapper": theirs, "hypermap_lite": sys.executable}
    fill = functools.partial(measure, pythons=pythons, iterations=arguments.iterations)
    table = ResultTable(
        arguments.output / "hypermapper_comparison.csv", COLUMNS, key=("scenario", "model", "package", "seed")
    )
    for seed in range(arguments.seeds):
        for scenario in arguments.scenarios.split(","):
            for model in arguments.models.split(","):
                for package in PACKAGES:
                    table.fill({"scenario": scenario, "model": model, "package": package, "seed": seed}, fill)
    table.write_page(
        arguments.output / "hypermapper_comparison.md",
        title="HyperMapper and this package on the same scenarios",
        command="python benchmarks/hypermapper_comparison.py --hypermapper PYTHON",
        text=f"{machine()}\nMedians over the seeds, of HyperMapper and of this package; seconds per suggestion after "
        "the initial design, on one core,\nwithout the black box; the ratio is that of CPU seconds.",
        header=(
            *("scenario", "model", "seeds", "s, theirs", "s, ours", "CPU s, theirs", "CPU s, ours", "times faster"),
            *("quality", "theirs", "ours", "failed runs"),
        ),
        rows=list(summary(table.rows)),
    )


if __name__ == "__main__":
    main()
