"""Keep what is small of the studies of the paper, for the pages and the regression tests.

    python benchmarks/reference.py

Copies from `outputs/studies/` to `outputs/reference/`: of each study its tables, and of each variant the run with the
first seed (scenario, history and front); the figures that the page shows go to `docs/images/`. What was kept of a study
that is not there now stays. The studies must be finished:

    python -m hypermap_lite study example_scenarios/robot/studies/peg_insertion.json

and so on for the other files there. Writes `README.md` with the tables, commands, versions and the time it took.
"""

from __future__ import annotations

import csv
import json
import shutil
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from reporting import machine, markdown_table

ROOT = Path(__file__).parent.parent
STUDIES = ROOT / "example_scenarios" / "robot" / "studies"
SOURCE, TARGET, IMAGES = ROOT / "outputs" / "studies", ROOT / "outputs" / "reference", ROOT / "docs" / "images"
TABLES = ("study.json", "summary.csv", "averages.csv", "comparison.csv", "union_front.csv")
RUN_FILES = ("scenario.json", "history.csv", "pareto.csv")
PAGE = ROOT / "docs" / "experiments.md"
PICTURES = ("hypervolume", "attainment")
SECONDS_PER_HOUR = 3600.0


def keep(name: str) -> None:
    """Copy what is kept of one study."""
    source, target = SOURCE / name, TARGET / name
    if target.exists():
        shutil.rmtree(target)
    target.mkdir(parents=True)
    for table in TABLES:
        shutil.copyfile(source / table, target / table)
    for variant in sorted((source / "runs").iterdir()):
        first = min(variant.iterdir())
        kept = target / "runs" / variant.name / first.name
        kept.mkdir(parents=True)
        for file in RUN_FILES:
            shutil.copyfile(first / file, kept / file)
    page = PAGE.read_text(encoding="utf-8")
    for picture in PICTURES:
        shown = IMAGES / f"study_{name}_{picture}.png"
        if shown.name in page:
            shutil.copyfile(source / f"{picture}.png", shown)


def comparison(name: str) -> list[dict[str, str]]:
    """Return the rows of a kept study's comparison."""
    with (TARGET / name / "comparison.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def interval(row: dict[str, str], stem: str, form: str) -> str:
    """Return an estimate and its interval as text."""
    ends = [row[f"{stem}{end}"] for end in ("", "_low", "_high")]
    if not ends[0]:
        return ""
    value, low, high = ("never" if end == "inf" else f"{float(end):{form}}" for end in ends)
    return f"{value} ({low} to {high})"


def mean_and_error(row: dict[str, str], column: str, form: str) -> str:
    return f"{float(row[column]):{form}} ± {float(row[f'{column}_se']):.2g}"


def core_hours(rows: Sequence[dict[str, str]]) -> float:
    return sum(float(row["seconds_per_run"]) * int(row["runs"]) for row in rows) / SECONDS_PER_HOUR


def section(name: str, rows: Sequence[dict[str, str]]) -> list[str]:
    """Return the lines about one study."""
    study = json.loads((TARGET / name / "study.json").read_text(encoding="utf-8"))
    header = ["variant", "runs", "final hypervolume", "share", "ratio to no prior (95 %)"]
    header += ["evaluations to its final mean (95 %)", *(f"{how} {metric}" for metric, how in study["metrics"].items())]
    lines = [
        [
            row["label"],
            row["runs"],
            mean_and_error(row, "final_hypervolume", ".4g"),
            f"{float(row['final_share']):.3f}",
            interval(row, "ratio", ".2f"),
            interval(row, "evaluations_to_baseline", ".0f"),
            *(mean_and_error(row, f"{metric}_{how}", ".4g") for metric, how in study["metrics"].items()),
        ]
        for row in rows
    ]
    command = f"python -m hypermap_lite study example_scenarios/robot/studies/{name}.json"
    planned = json.loads((STUDIES / f"{name}.json").read_text(encoding="utf-8"))["repetitions"]
    command += f" --repetitions {study['repetitions']}" if study["repetitions"] != planned else ""
    cost = f"{rows[0]['evaluations']} evaluations per run; {core_hours(rows):.1f} core-hours in all."
    return [f"## {name}", "", f"    {command}", "", cost, "", *markdown_table(header, lines), ""]


def main() -> None:
    """Copy the studies that are there and write the page of all that are kept."""
    TARGET.mkdir(exist_ok=True)
    names = [file.stem for file in sorted(STUDIES.glob("*.json"))]
    for name in names:
        if (SOURCE / name / "comparison.csv").exists():
            keep(name)
    page = [
        "# Stored results",
        "",
        "Made by `python benchmarks/reference.py` from the studies below; what they say stands",
    ]
    page += ["in [docs/experiments.md](../../docs/experiments.md). The regression tests repeat a part of them.", ""]
    versions = {package: version(package) for package in ("mujoco", "moocore")}
    (TARGET / "versions.json").write_text(json.dumps(versions, indent=2) + "\n", encoding="utf-8")
    page += [f"{machine()} {', '.join(f'{package} {number}' for package, number in versions.items())}.", ""]
    for name in names:
        if (TARGET / name).exists():
            page += section(name, comparison(name))
    (TARGET / "README.md").write_text("\n".join(page).rstrip() + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
