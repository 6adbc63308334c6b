"""The stored results in outputs/reference are still what the code says, and what it does.

Hypervolumes are compared exactly; suggestions where the libraries are those that made the results, to the last digit
where the processor is, too: they depend on how linear algebra rounds. Physics is compared up to `TOLERANCE`.
"""

from __future__ import annotations

import csv
import json
import platform
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hypermap_lite import Optimizer, load_scenario, optimize, read_history
from hypermap_lite.assembly import build_history
from hypermap_lite.evaluation.outcome import Evaluation
from hypermap_lite.history.scenario_record import installed_versions
from hypermap_lite.objectives import reference_point_of, to_minimization
from hypermap_lite.pareto import hypervolume, hypervolume_trace, non_dominated
from hypermap_lite.plotting.runs import Run, load_run
from hypermap_lite.study.statistics import evaluations_to_reach, ratio_of_means
from tests.slow import slow_after, slow_unless

ROOT = Path(__file__).parents[2]
REFERENCE = ROOT / "outputs" / "reference"
STUDIES = sorted(folder.parent for folder in REFERENCE.glob("*/study.json"))
RUNS = sorted(folder.parent for folder in REFERENCE.glob("*/runs/*/*/scenario.json"))
ALL_STUDIES = {file.stem for file in (ROOT / "example_scenarios" / "robot" / "studies").glob("*.json")}

TOLERANCE = 1e-6
"""Of a mean objective of the design, relative to its size."""

ROUNDING = 1e-3
"""Distance in the unit cube by which a suggestion may differ on another processor."""

LIMIT = 10_000_000
"""Bytes that the stored results may take in all."""

N_REPEATED = 4
"""Configurations that are evaluated again."""


def name_of(folder: Path) -> str:
    return folder.relative_to(REFERENCE).as_posix()


def is_by_default_with_a_prior(run: Path) -> bool:
    return run.parents[2].name.endswith("_default") and run.parent.name == "operator_prior"


def rows_of(file: Path) -> list[dict[str, str]]:
    with file.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@cache
def summary_of(study: Path) -> dict[tuple[str, str], list[dict[str, str]]]:
    """Return the rows of a summary by variant and seed."""
    groups: dict[tuple[str, str], list[dict[str, str]]] = {}
    for row in rows_of(study / "summary.csv"):
        groups.setdefault((row["variant"], row["seed"]), []).append(row)
    return groups


def minimized(run: Run) -> tuple[np.ndarray, np.ndarray]:
    corner = reference_point_of(run.objectives)
    assert corner is not None
    return run.Y, corner


def evaluations_of(run: Path) -> list[Evaluation]:
    history = build_history(load_scenario(run / "scenario.json"))
    return read_history(run / "history.csv", history.space, history.objectives)


def versions_of(run: Path) -> dict[str, str]:
    versions: dict[str, str] = json.loads((run / "scenario.json").read_text())["versions"]
    return versions


def require_the_same_libraries(run: Path) -> None:
    stored, now = versions_of(run), installed_versions()
    libraries = [name for name in now if name not in ("python", "hypermap_lite", "processor")]
    changed = [name for name in libraries if stored.get(name) != now[name]]
    if changed or platform.machine() != "x86_64":
        pytest.skip(f"made with other versions of {', '.join(changed) or 'the processor'}")


def test_every_study_has_stored_results_of_a_small_size() -> None:
    assert {folder.name for folder in STUDIES} == ALL_STUDIES
    assert sum(file.stat().st_size for file in REFERENCE.rglob("*") if file.is_file()) < LIMIT


@pytest.mark.parametrize("folder", RUNS, ids=name_of)
def test_hypervolume_of_a_stored_history_is_recomputed_exactly(folder: Path) -> None:
    trace = hypervolume_trace(*minimized(load_run(folder)))
    rows = summary_of(folder.parents[2])[folder.parent.name, folder.name]
    assert trace.tolist() == [float(row["hypervolume"]) for row in rows]


@pytest.mark.parametrize("folder", RUNS, ids=name_of)
def test_stored_front_is_that_of_its_history(folder: Path) -> None:
    run = load_run(folder)
    front = [dict(row) for row, is_front in zip(run.rows, run.is_front, strict=True) if is_front]
    assert rows_of(folder / "pareto.csv") == front


@pytest.mark.parametrize("study", STUDIES, ids=name_of)
def test_union_front_has_share_one_and_no_stored_run_more(study: Path) -> None:
    run = load_run(next(folder for folder in RUNS if study in folder.parents))
    _, corner = minimized(run)
    union = [[float(row[o.name]) for o in run.objectives] for row in rows_of(study / "union_front.csv")]
    Y = to_minimization(run.objectives, np.array(union))
    assert non_dominated(Y).all()
    whole = hypervolume(Y, corner)
    for rows in summary_of(study).values():
        assert float(rows[-1]["hypervolume"]) / whole == float(rows[-1]["hypervolume_share"])
        assert float(rows[-1]["hypervolume_share"]) <= 1.0


@pytest.mark.parametrize("study", STUDIES, ids=name_of)
def test_comparison_follows_from_the_summary_exactly(study: Path) -> None:
    baseline = json.loads((study / "study.json").read_text())["baseline"]
    traces: dict[str, Any] = {}
    for (variant, _), rows in summary_of(study).items():
        traces.setdefault(variant, []).append([float(row["hypervolume"]) for row in rows])
    finals = np.array(traces[baseline])[:, -1]
    for row in rows_of(study / "comparison.csv"):
        values, is_paired = np.array(traces[row["variant"]]), row["paired"] == "true"
        assert int(row["runs"]) == len(values)
        assert float(row["final_hypervolume"]) == values[:, -1].mean()
        reached = evaluations_to_reach(values, finals, is_paired=is_paired)
        assert [float(row[f"evaluations_to_baseline{end}"]) for end in ("", "_low", "_high")] == [
            reached.value,
            reached.low,
            reached.high,
        ]
        if row["variant"] != baseline:
            ratio = ratio_of_means(values[:, -1], finals, is_paired=is_paired)
            assert [float(row[f"ratio{end}"]) for end in ("", "_low", "_high")] == [ratio.value, ratio.low, ratio.high]


@pytest.mark.parametrize("folder", slow_unless(is_by_default_with_a_prior, RUNS), ids=name_of)
def test_optimizer_suggests_again_what_is_stored(folder: Path) -> None:
    require_the_same_libraries(folder)
    stored = evaluations_of(folder)
    scenario = json.loads((folder / "scenario.json").read_text())
    n = scenario["budget"]["batch_size"]
    n_design = scenario["design_of_experiment"]["number_of_samples"]
    is_exact = versions_of(folder).get("processor") == installed_versions()["processor"]
    # the first batch, the first after the design, and the last whole one, each at a multiple of the batch size
    for done in (0, -(-n_design // n) * n, (len(stored) - n) // n * n):
        optimizer = Optimizer(scenario, evaluations=stored[:done])
        expected = [evaluation.configuration for evaluation in stored[done : done + n]]
        found = [suggestion.configuration for suggestion in optimizer.ask(n)]
        if is_exact or done == 0:
            assert found == expected
        else:  # the rest of a batch keeps its distance from the first one, so a last digit may change much
            first = optimizer.history.space.encode([found[0], expected[0]])
            assert first[0] == pytest.approx(first[1], abs=ROUNDING)


@pytest.mark.parametrize("folder", slow_after(1, [run for run in RUNS if run.parent.name == "no_prior"]), ids=name_of)
def test_short_run_repeats_the_stored_one(folder: Path, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    if metadata.version("mujoco") != json.loads((REFERENCE / "versions.json").read_text())["mujoco"]:
        pytest.skip("made with another version of mujoco")
    scenario = folder / "scenario.json"
    result = optimize(scenario, output_directory=tmp_path, overrides=[f"budget.evaluations={N_REPEATED}"])
    for ours, stored in zip(result.evaluations, evaluations_of(folder)[:N_REPEATED], strict=True):
        assert ours.configuration == stored.configuration
        assert dict(ours.values) == pytest.approx(dict(stored.values), rel=TOLERANCE)
