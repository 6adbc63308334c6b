"""See how many rollouts racing would have saved in finished runs, and what it would have got wrong.

    python benchmarks/racing.py --studies outputs/studies

Reads the runs of the studies of the robot tasks, which made all replicates, and plays each again with racing: the same
configurations in the same batches, with as many of their replicates as the race asks for. What a search would have
suggested after other numbers of replicates is not played. An error is a configuration that was stopped, and has all its
replicates on the front of the run.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from reporting import markdown_table

from hypermap_lite.assembly import build_plan, build_space
from hypermap_lite.evaluation.aggregation import summarize
from hypermap_lite.evaluation.outcome import Evaluation, Replicate
from hypermap_lite.evaluation.racing import Race
from hypermap_lite.history.csv_format import parse_rows, read_records
from hypermap_lite.history.rows import EvaluationsFormat, read_history
from hypermap_lite.objectives import reference_point_of, values_of
from hypermap_lite.pareto import hypervolume, non_dominated
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.model import RacingSpec, Scenario

PAGE = Path(__file__).parent / "results" / "racing.md"
STUDIES = ("peg_insertion", "object_pushing", "obstacle_avoidance")
VARIANTS = ("no_prior", "operator_prior", "misleading_prior", "random_search")
SPECS = (
    RacingSpec(),
    RacingSpec(step=1),
    RacingSpec(minimum=2, step=1),
    RacingSpec(minimum=4, step=4),
    RacingSpec(alpha=0.2),
)


def calls_of(folder: Path, scenario: Scenario) -> dict[int, list[Replicate]]:
    """Return the calls of each trial, in order."""
    form = EvaluationsFormat(build_space(scenario), scenario.objectives, feasible_output=scenario.feasible_output)
    path = folder / "evaluations.csv"
    records = read_records(path)
    form.metrics = form.metrics_in(records[0])
    calls: dict[int, list[Replicate]] = {}
    for call in parse_rows(path, records, form.parse):
        calls.setdefault(call.trial, []).append(call)
    return calls


def play(
    rows: Sequence[Evaluation], calls: dict[int, list[Replicate]], scenario: Scenario, spec: RacingSpec
) -> list[Evaluation]:
    """Return the rows as racing would have made them."""
    plan, played = build_plan(scenario), []
    while len(played) < len(rows):
        race = Race.against(played, scenario.objectives, spec, scenario.evaluator.replicates)
        batch = rows[len(played) : plan.end_of_batch(len(played))]
        for row in batch:
            own, n = calls[row.trial], 0
            while (needed := race.required(row.suggestion, own[:n])) > n:
                n = needed
            played.append(summarize(row.suggestion, own[:n]))
    return played


def outcome_of(folder: Path, spec: RacingSpec) -> tuple[float, int, int, float]:
    """Return share of the rollouts saved, configurations stopped, errors, and ratio of the final hypervolumes."""
    scenario = load_scenario(folder / "scenario.json")
    rows = read_history(folder, build_space(scenario), scenario.objectives, scenario.feasible_output)
    played = play(rows, calls_of(folder, scenario), scenario, spec)
    stopped = np.array([row.replicates < full.replicates for row, full in zip(played, rows, strict=True)])
    fronts, volumes = [], []
    corner = reference_point_of(scenario.objectives)
    assert corner is not None
    for version in (rows, played):
        Y = np.array([values_of(scenario.objectives, r.values) if r.is_completed else corner * np.nan for r in version])
        fronts.append(non_dominated(Y))
        volumes.append(hypervolume(Y, corner))
    saved = 1 - sum(row.replicates for row in played) / sum(row.replicates for row in rows)
    ratio = volumes[1] / volumes[0] if volumes[0] > 0 else float("nan")
    return saved, int(stopped.sum()), int((stopped & fronts[0]).sum()), ratio


def table_rows(studies: Path) -> Iterator[list[str]]:
    """Yield a row per study, variant and rule."""
    for study in STUDIES:
        for variant in VARIANTS:
            folders = sorted((studies / study / "runs" / variant).glob("[0-9]*"))
            for spec in SPECS if variant == "no_prior" else SPECS[:1]:
                saved, stopped, errors, ratios = map(
                    np.array, zip(*(outcome_of(f, spec) for f in folders), strict=True)
                )
                rule = f"{spec.minimum}, {spec.step}, {spec.alpha:g}"
                yield [
                    *(study.replace("_", " "), variant.replace("_", " "), rule),
                    f"{100 * saved.mean():.0f} % ({100 * saved.min():.0f} to {100 * saved.max():.0f})",
                    f"{errors.sum()} of {stopped.sum()}",
                    f"{np.nanmean(ratios):.4f} ({np.nanmin(ratios):.4f} to {np.nanmax(ratios):.4f})",
                ]


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--studies", type=Path, default=Path("outputs/studies"))
    rows = list(table_rows(parser.parse_args().studies))
    header = ["task", "variant", "minimum, step, alpha", "rollouts saved", "errors of the stopped", "final hypervolume"]
    lines = [
        "# Rollouts saved by racing",
        "",
        "    python benchmarks/racing.py --studies outputs/studies",
        "",
        "Runs of 50, 50 and 60 configurations with 7 rollouts each, played again: means and range.",
        "Errors: stopped, though on the front by all seven rollouts. Hypervolume: over that with all rollouts.",
        "",
        *markdown_table(header, rows),
    ]
    PAGE.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
