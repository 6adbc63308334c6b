"""Every example scenario runs, with a tiny budget, through the command line."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pandas as pd
import pytest

from hypermap_lite import optimize
from hypermap_lite.cli import main
from hypermap_lite.errors import NoValidEvaluationError
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.lint import lint
from hypermap_lite.study import load_study
from tests.slow import slow_unless

EXAMPLES = Path(__file__).parents[1] / "example_scenarios"
STUDIES = sorted(EXAMPLES.glob("robot/studies/*.json"))
IN_ANOTHER_FORMAT = EXAMPLES.glob("hypermapper/*.json")
SCENARIOS = sorted({*EXAMPLES.rglob("*.json")} - {*STUDIES, *IN_ANOTHER_FORMAT})
LIGHT = [file for file in SCENARIOS if "robot" not in file.parts]
ROBOT = [file for file in SCENARIOS if "robot" in file.parts]

TINY = ["budget.evaluations=5", "budget.batch_size=2", "design_of_experiment.number_of_samples=3"]
"""One batch of the design, one across its end, one by the model."""


def name_of(file: Path) -> str:
    return file.relative_to(EXAMPLES).with_suffix("").as_posix()


def run(file: Path, folder: Path, *changes: str) -> int:
    options = [word for change in (*TINY, *changes) for word in ("--set", change)]
    return main(["--quiet", "run", str(file), "--output-dir", str(folder), "--no-plot", *options])


@pytest.mark.parametrize("file", LIGHT, ids=name_of)
def test_an_example_runs(file: Path, tmp_path: Path) -> None:
    assert run(file, tmp_path / "out") == 0
    with (tmp_path / "out" / "history.csv").open() as history:
        assert [row["state"] for row in csv.DictReader(history)] == ["completed"] * 5


@pytest.mark.parametrize("file", slow_unless(lambda file: file.stem == "operator_prior", ROBOT), ids=name_of)
def test_a_robot_example_runs(file: Path, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    assert run(file, tmp_path / "out", "evaluator.replicates=1") == 0
    with (tmp_path / "out" / "history.csv").open() as history:
        assert [row["state"] for row in csv.DictReader(history)] == ["completed"] * 5


@pytest.mark.parametrize("file", SCENARIOS, ids=name_of)
def test_an_example_loads_from_its_canonical_form(file: Path) -> None:
    scenario = load_scenario(file)
    assert load_scenario(json.loads(json.dumps(scenario.canonical))) == scenario


@pytest.mark.parametrize("file", SCENARIOS, ids=name_of)
def test_an_example_gives_no_warning(file: Path) -> None:
    assert lint(load_scenario(file)) == []


@pytest.mark.parametrize("file", SCENARIOS, ids=name_of)
def test_an_example_is_named_after_its_file_and_stands_in_the_table(file: Path) -> None:
    scenario = load_scenario(file)
    assert scenario.application_name.endswith(file.stem)
    assert scenario.description
    table = (EXAMPLES / "README.md").read_text()
    assert f"[`{name_of(file)}.json`]({name_of(file)}.json)" in table


def test_examples_have_names_of_their_own() -> None:
    names = [load_scenario(file).application_name for file in SCENARIOS]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("file", STUDIES, ids=name_of)
@pytest.mark.parametrize("is_quick", [False, True], ids=["whole", "quick"])
def test_an_example_study_loads_and_compares_examples(file: Path, is_quick: bool) -> None:
    study = load_study(file, is_quick=is_quick)
    assert study.name.removesuffix("_quick") == file.stem
    assert study.description
    assert {variant.scenario.resolve() for variant in study.variants} <= set(SCENARIOS)
    assert [warning for variant in study.variants for warning in lint(variant.effective)] == []


def test_every_robot_task_has_an_example_study() -> None:
    assert {file.parent.name for file in ROBOT} <= {file.stem for file in STUDIES}


@pytest.mark.slow
def test_a_robot_run_has_the_same_rows_with_any_number_of_workers(tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    file = EXAMPLES / "robot" / "peg_insertion" / "operator_prior.json"
    tables = []
    for workers in (1, 2):
        folder = tmp_path / str(workers)
        assert run(file, folder, "evaluator.replicates=2", f"evaluator.workers={workers}") == 0
        table = pd.read_csv(folder / "evaluations.csv")
        tables.append(table.sort_values(["trial", "replicate"], ignore_index=True).drop(columns="seconds"))
    pd.testing.assert_frame_equal(*tables, check_exact=True)


def test_a_rollout_whose_physics_means_nothing_is_a_failed_evaluation_without_a_score(tmp_path, monkeypatch) -> None:
    pytest.importorskip("mujoco")
    monkeypatch.setattr("robot_tasks.contacts.DEEPEST_OVERLAP", 1e-9)  # any contact at all is too much
    import robot_tasks

    file = EXAMPLES / "robot" / "peg_insertion" / "no_prior.json"
    overrides = [*TINY, "evaluator.replicates=1", "evaluator.max_consecutive_failures=9"]
    with pytest.raises(NoValidEvaluationError, match="none of the 5 evaluations gave a usable result"):
        optimize(file, robot_tasks.peg_insertion, overrides=overrides, output_directory=tmp_path / "out")
    history = pd.read_csv(tmp_path / "out" / "history.csv")
    assert history["state"].tolist() == ["failed"] * 5
    assert history[["insertion_reward", "force"]].isna().all(axis=None)
    assert history["error"].str.contains("two bodies overlap by").all()
