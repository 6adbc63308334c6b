"""The page of `sample_efficiency.py`: a table per question, with pictures, from the rows of its CSV."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from problems import PROBLEMS
from reporting import machine, markdown_table

GOALS: Mapping[str, tuple[float | None, float]] = {
    "branin": (None, -5),
    "hartmann6": (None, -4.2),
    "hartmann6_noisy": (None, -2.4),
    "ackley5": (None, 0),
    "branin_currin": (0.965, 0.990),
    "branin_currin_noisy": (0.93, 0.975),
    "zdt2": (0.993, 0.999),
    "dtlz2": (0.60, 0.92),
    "chankong_haimes": (0.90, 0.97),
}
"""What the default is to reach after half and all evaluations."""

Row = Mapping[str, Any]

HEADER = ("problem", "method", "seeds", "half", "all", "worst", "CPU s", "wall s", "feasible", "failed")

TEXT = """Log10 of the regret of the best point (smaller is better) or, with several objectives, the share of the
largest hypervolume (larger is better), of the noise-free values of all evaluated points: means ± standard errors over
the seeds, after half and all of 60 evaluations (40 in two dimensions with one objective, 100 from ten parameters on),
and the worst seed. Everybody begins with the same design of 2 (d + 1) Sobol points. Noise is 10 % of the standard
deviation of each objective over the box, by 16,384 Sobol points, and on the emulated tasks the median standard error of
an evaluation. CPU and wall-clock seconds of one suggestion, fit included: medians over the run, then over the seeds;
one thread of linear algebra. Largest hypervolumes of VehicleSafety, Penicillin, BraninCurrin (both) and C2-DTLZ2 are
published approximations, so a share may pass 1 by a little. Of problems called "failing" one evaluation in twenty comes
out as bad as can be, whatever its point, and counts so. Until a point is feasible, the regret is that
of the worst value of the box; one below 1e-12 counts as that, so of the steps, whose minimum is a plateau, one run that
hits it makes the mean. The best mean of a problem is in bold."""


class Asked(Protocol):
    """What a table has to say of itself."""

    title: str
    problems: Sequence[str]
    methods: Sequence[str]


def write_page(tables: Mapping[str, Asked], rows: Sequence[Row], folder: Path) -> None:
    """Write the page and a picture per table that has rows."""
    lines = ["# Sample efficiency", "", "    python benchmarks/sample_efficiency.py TABLE", "", machine(), TEXT]
    compared = {method for name, table in tables.items() if name != "ablation" for method in table.methods}
    for name, table in tables.items():
        found = dict.fromkeys(row["method"] for row in rows if row["problem"] in table.problems)
        others = [m for m in found if m not in table.methods and m not in compared] if name == "ablation" else []
        methods = [m for m in (*table.methods, *others) if m in found]
        if len(methods) <= 1:
            continue
        body = list(body_of(table.problems, methods, rows))
        lines += ["", f"## {table.title}", "", f"![curves](sample_efficiency_{name}.png)", ""]
        lines += markdown_table(HEADER, body)
        draw(rows, table.problems, methods, table.title, folder / f"sample_efficiency_{name}.png")
    (folder / "sample_efficiency.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


def draw(rows: Sequence[Row], problems: Sequence[str], methods: Sequence[str], title: str, file: Path) -> None:
    """Write a picture, if Matplotlib is there."""
    try:
        import curves
    except ImportError:
        print("No pictures: Matplotlib is not installed.")
        return
    curves.draw(rows, problems, methods, title=title, file=file)


def body_of(problems: Sequence[str], methods: Sequence[str], rows: Sequence[Row]) -> Iterator[tuple[str, ...]]:
    """Yield the lines of a table: the methods of each problem, and what was to be reached."""
    for problem in problems:
        is_regret = PROBLEMS[problem].reference_point is None
        cases = {method: [r for r in rows if (r["problem"], r["method"]) == (problem, method)] for method in methods}
        means = {method: mean(case, "final") for method, case in cases.items() if any(r["final"] != "" for r in case)}
        if not means:
            continue
        best = (min if is_regret else max)(means.values())
        for method, case in cases.items():
            if case:
                yield line_of(problem, method, case, is_best=means.get(method) == best)
        if problem in GOALS:
            half, final = GOALS[problem]
            yield (problem, "*goal*", "", "" if half is None else f"{half:g}", f"{final:g}", *[""] * 5)


def line_of(problem: str, method: str, case: Sequence[Row], *, is_best: bool) -> tuple[str, ...]:
    """Return the line of a method."""
    done = [row for row in case if row["final"] != ""]
    is_regret = PROBLEMS[problem].reference_point is None
    finals = [float(row["final"]) for row in done]
    final = with_error(done, "final")
    return (
        *(problem, method, str(len(done)), with_error(done, "half"), f"**{final}**" if is_best else final),
        f"{(max if is_regret else min)(finals):.3g}" if finals else "",
        *(
            f"{statistics.median(float(r[c]) for r in done):.3g}" if done else ""
            for c in ("cpu_seconds", "wall_seconds")
        ),
        f"{mean(done, 'feasible_share'):.2f}" if done and PROBLEMS[problem].is_feasible is not None else "",
        str(len(case) - len(done)) if len(done) < len(case) else "",
    )


def mean(case: Sequence[Row], column: str) -> float:
    """Return the mean of a column over the runs that ended well."""
    return statistics.fmean(float(row[column]) for row in case if row[column] != "")


def with_error(case: Sequence[Row], column: str) -> str:
    """Return the mean of a column and its standard error."""
    values = [float(row[column]) for row in case]
    if not values:
        return ""
    if len(values) == 1:
        return f"{values[0]:.3f}"
    return f"{statistics.fmean(values):.3f} ± {statistics.stdev(values) / math.sqrt(len(values)):.3f}"
