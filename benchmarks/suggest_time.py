"""Measure the time of one suggestion as the history grows, and of starting the program.

    python benchmarks/suggest_time.py [--repeats 7] [--output benchmarks/results]

A suggestion is what `ask` does on a history of n evaluations of a two-objective problem in six dimensions, the fit of
the model included. CPU time of one process with one thread of linear algebra; medians over the repeats, each with
another seed. A profile says what it is spent on.
"""

from __future__ import annotations

import argparse
import cProfile
import math
import pstats
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from reporting import ResultTable, machine, markdown_table

from hypermap_lite import Evaluation, Optimizer, State
from hypermap_lite.evaluation.outcome import DESIGN, MODEL, Suggestion

DIMENSION = 6
DESIGN_POINTS = 12
PROMISE = math.log(1e-2)
"""Log of the growth, in units of the front's range, that each suggestion is said to have promised."""

SIZES = (20, 50, 60, 100, 200)
PROFILED = (60, 200)
METHODS: dict[str, dict[str, Any]] = {
    "default": {},
    "paper preset": {"preset": "paper"},
    "random forest": {"surrogate": {"type": "random_forest"}},
}
THREE = "default, three objectives"
PARTS = {
    "fit of the hyperparameters": (("models.py", "posterior"),),
    "draws of the noise-free values, their fronts": (("noisy_hypervolume_improvement.py", "scorer"),),
    "candidates and their scores": (("base.py", "draw_candidates"), ("base.py", "score_candidates")),
    "gradient ascents": (("multistart_gradient.py", "_ascend"),),
}
"""Files and functions that a suggestion is made of; none calls another."""

START_COMMANDS = ("--help", "check example_scenarios/quick_start/branin.json")
COLUMNS = ("what", "n", "repeat", "seconds")


def dtlz2(x: np.ndarray) -> dict[str, float]:
    """Return the two objectives of DTLZ2 (Deb et al. 2005) with a little noise of the point's own, and a third one."""
    g = float(((x[1:] - 0.5) ** 2).sum())
    noise = np.random.default_rng(int(1e9 * x[0])).standard_normal(2)
    angle = x[0] * np.pi / 2
    return {
        "f1": (1 + g) * np.cos(angle) + 0.02 * noise[0],
        "f2": (1 + g) * np.sin(angle) + 0.02 * noise[1],
        "f3": float(((x - 0.3) ** 2).sum()),
    }


def evaluations(n: int, seed: int) -> list[Evaluation]:
    """Return n evaluations as a run leaves them: a spread-out design, then points around the front, with promises."""
    rng = np.random.default_rng(seed)
    X = rng.random((n, DIMENSION))
    n_model = max(n - DESIGN_POINTS, 0)
    X[DESIGN_POINTS:, 1:] = np.clip(0.5 + 0.15 * rng.standard_normal((n_model, DIMENSION - 1)), 0, 1)
    return [
        Evaluation(
            suggestion=Suggestion(
                trial=i,
                configuration={f"x{j}": float(v) for j, v in enumerate(x)},
                phase=DESIGN if i < DESIGN_POINTS else MODEL,
                acquisition_value=None if i < DESIGN_POINTS else PROMISE,
            ),
            state=State.COMPLETED,
            values=dtlz2(x),
        )
        for i, x in enumerate(X)
    ]


def before_a_suggestion(what: str, n: int, repeat: int) -> Optimizer:
    """Return an optimizer after n evaluations that has made a suggestion one evaluation earlier.

    A run pays for any suggestion what it pays here for the second: what the first one computes besides (the fits that
    later ones start from) a run has kept.
    """
    names = ("f1", "f2", "f3")[: 2 + (what == THREE)]
    scenario = {
        "seed": repeat,
        "input_parameters": {f"x{j}": {"parameter_type": "real", "values": [0, 1]} for j in range(DIMENSION)},
        "objectives": [{"name": name} for name in names],
        "design_of_experiment": {"number_of_samples": DESIGN_POINTS},
        "budget": {"evaluations": n + 10},
        **METHODS.get(what, {}),
    }
    rows = evaluations(n, repeat)
    optimizer = Optimizer(scenario, evaluations=rows[:-1])
    (suggestion,) = optimizer.ask()
    optimizer.tell(suggestion, {name: rows[-1].values[name] for name in names})
    return optimizer


def suggestion_seconds(what: str, n: int, repeat: int) -> dict[str, Any]:
    """Time a suggestion after n evaluations."""
    optimizer = before_a_suggestion(what, n, repeat)
    start = time.process_time()
    optimizer.ask()
    return {"what": what, "n": n, "repeat": repeat, "seconds": time.process_time() - start}


def profile(n: int, repeats: int) -> list[str]:
    """Return the parts of a suggestion by the default after n evaluations, in per cent of its time."""
    profiler = cProfile.Profile()
    for repeat in range(repeats):
        optimizer = before_a_suggestion("default", n, repeat)
        profiler.enable()
        optimizer.ask()
        profiler.disable()
    spent: dict[tuple[str, str], float] = {}
    for (file, _, function), (_, _, _, cumulative, _) in pstats.Stats(profiler).stats.items():  # type: ignore[attr-defined]
        key = (Path(file).name, function)
        spent[key] = max(cumulative, spent.get(key, 0.0))
    whole = spent["ask_tell.py", "ask"]
    shares = [sum(spent[key] for key in keys) / whole for keys in PARTS.values()]
    return [f"{100 * share:.0f} %" for share in (*shares, 1 - sum(shares))]


def start_seconds(what: str, n: int, repeat: int) -> dict[str, Any]:
    """Time a command of the program, wall clock."""
    start = time.perf_counter()
    subprocess.run(
        [sys.executable, "-m", "hypermap_lite", *what.split()],
        capture_output=True,
        check=True,
        cwd=Path(__file__).parent.parent,
    )
    return {"what": what, "n": n, "repeat": repeat, "seconds": time.perf_counter() - start}


def main() -> None:
    """Measure the missing cases and write the result page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    arguments = parser.parse_args()
    path = arguments.output / "suggest_time.csv"
    path.unlink(missing_ok=True)  # times of different days do not mix
    table = ResultTable(path, COLUMNS, key=("what", "n", "repeat"))
    for repeat in range(arguments.repeats):
        for what in METHODS:
            for n in SIZES:
                table.fill({"what": what, "n": n, "repeat": repeat}, suggestion_seconds)
        table.fill({"what": THREE, "n": 60, "repeat": repeat}, suggestion_seconds)
        for what in START_COMMANDS:
            table.fill({"what": what, "n": 0, "repeat": repeat}, start_seconds)
    cases = dict.fromkeys((row["what"], int(row["n"])) for row in table.rows)
    rows = []
    for what, n in cases:
        seconds = [float(r["seconds"]) for r in table.rows if (r["what"], int(r["n"])) == (what, n)]
        rows.append((what, str(n), *(f"{f(seconds):.3f}" for f in (min, statistics.median, max))))
    page = arguments.output / "suggest_time.md"
    table.write_page(
        page,
        title="Time of a suggestion",
        command="python benchmarks/suggest_time.py",
        text=f"{machine()}\nCPU seconds of one suggestion, fit included, after n evaluations (d = 6, two objectives, "
        "one thread); wall-clock\nseconds of the commands that start with no n.",
        header=("what", "n", "min", "median", "max"),
        rows=rows,
    )
    columns = [profile(n, arguments.repeats) for n in PROFILED]
    lines = markdown_table(
        ("part", *(f"n = {n}" for n in PROFILED)), list(zip((*PARTS, "the rest"), *columns, strict=True))
    )
    about = ["", "What the default spends it on, with two objectives, as a profiler sees it:", "", *lines]
    page.write_text(page.read_text(encoding="utf-8") + "\n".join(about) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
