"""HyperMapper's methods, budgets and designs in our form, where more than one key has a part."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.hypermapper import translate
from tests.scenario.hypermapper_scenarios import (
    CATEGORICAL,
    INTEGER,
    MISSING,
    ORDINAL,
    REAL,
    at,
    note_on,
    scenario,
    translated,
    write_rows,
)

DECAY = {"p": {**REAL, "prior": "decay"}, "q": REAL}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("name", ["random_scalarizations", "prior_guided_optimization", "bayesian_optimization"])
def test_three_methods_are_the_same(name: str) -> None:
    assert translated(optimization_method=name) == translated()


@pytest.mark.parametrize(
    ("name", "plain", "believing"),
    [
        ("random sampling", "random_sampling", "prior_sampling"),
        ("standard latin hypercube", "latin_hypercube", "prior_latin_hypercube"),
        ("k latin hypercube", "k_latin_hypercube", "k_latin_hypercube"),
        ("grid_search", "grid", "grid"),
    ],
)
def test_designs_follow_the_priors(name: str, plain: str, believing: str) -> None:
    doe = {"doe_type": name, "number_of_samples": 5}
    assert translated(design_of_experiment=doe)["design_of_experiment"]["type"] == plain
    assert translated(design_of_experiment=doe, input_parameters=DECAY)["design_of_experiment"]["type"] == believing


@pytest.mark.parametrize(
    ("entries", "points"),
    [
        pytest.param({"p": REAL, "q": REAL}, 100, id="without default"),
        pytest.param({"p": {**REAL, "parameter_default": 1}, "q": {**REAL, "parameter_default": 1}}, 101, id="default"),
        pytest.param({"p": {**REAL, "parameter_default": -5}, "q": {**REAL, "parameter_default": 10}}, 100, id="on it"),
        pytest.param({"n": INTEGER, "o": ORDINAL, "c": CATEGORICAL}, 16 * 4 * 3, id="levels"),
    ],
)
def test_a_grid_is_the_whole_budget(entries: dict[str, Any], points: int) -> None:
    document = translated(input_parameters=entries, design_of_experiment={"doe_type": "grid_search"})
    assert document["budget"] == {"evaluations": points}
    assert document["design_of_experiment"] == {"type": "grid", "levels": 10, "number_of_samples": points}


def test_a_grid_beyond_measure_is_refused() -> None:
    with pytest.raises(ScenarioError, match="1000000 points"):
        translated(input_parameters={f"x{i}": REAL for i in range(6)}, design_of_experiment={"doe_type": "grid_search"})


@pytest.mark.parametrize(("samples", "iterations", "total"), [(0, 5, 5), (3, 0, 3), (1, 4, 5)])
def test_a_design_or_the_iterations_may_be_none(samples: int, iterations: int, total: int) -> None:
    document = translated(optimization_iterations=iterations, design_of_experiment={"number_of_samples": samples})
    assert document["budget"]["evaluations"] == total
    assert document["design_of_experiment"]["number_of_samples"] == max(samples, 1)


def test_nothing_to_evaluate_is_an_error() -> None:
    with pytest.raises(ScenarioError, match="nothing to evaluate"):
        translated(optimization_iterations=0, design_of_experiment={"number_of_samples": 0})


@pytest.mark.parametrize(("minutes", "ours"), [(-1, MISSING), (-0.5, MISSING), (30, 30)])
def test_minutes_below_zero_are_no_limit(minutes: float, ours: Any) -> None:
    assert at(translated(time_budget=minutes), "budget.minutes") == ours


def test_no_minutes_at_all_are_an_error() -> None:
    with pytest.raises(ScenarioError, match="no time is left"):
        translated(time_budget=0)


@pytest.mark.parametrize(("rows", "samples", "total"), [(3, 5, 9), (8, 5, 12)])
def test_iterations_come_on_top_of_what_a_run_resumes_from(folder: Path, rows: int, samples: int, total: int) -> None:
    write_rows(folder, "demo_output_samples.csv", rows)
    document = translated(
        resume_optimization=True, optimization_iterations=4, design_of_experiment={"number_of_samples": samples}
    )
    assert document["earlier_evaluations"] == "demo_output_samples.csv"
    assert document["budget"]["evaluations"] == total
    assert document["output"]["directory"] == f"demo_run_after_{rows}"


def test_rows_that_failed_do_not_count_as_what_a_run_resumes_from(folder: Path) -> None:
    (folder / "history.csv").write_text(
        "x1,x2,cost,state\n1,1,2,completed\n2,1,,failed\n3,1,,timeout\n4,1,2,infeasible\n"
    )
    changes = {"resume_optimization": True, "resume_optimization_data": "history.csv", "optimization_iterations": 4}
    document = translated(**changes, design_of_experiment={"number_of_samples": 1})
    assert document["budget"]["evaluations"] == 2 + 4
    assert document["output"]["directory"] == "demo_run_after_2"


def test_a_missing_file_to_resume_from_is_an_error(folder: Path) -> None:
    with pytest.raises(ScenarioError, match=r"resume_optimization_data: there is no file 'old.csv'"):
        translated(resume_optimization=True, resume_optimization_data="old.csv")


def test_batches_raise_the_budget_and_the_strength_of_the_priors() -> None:
    document = translated(evaluations_per_optimization_iteration=4, optimization_iterations=10, input_parameters=DECAY)
    assert document["budget"] == {"evaluations": 50, "batch_size": 4}
    assert at(document, "acquisition.prior_weighting.beta") == pytest.approx(4.0)  # a tenth of 10, for 4 at a time


def test_a_client_gets_batches_anyway() -> None:
    document = translated(evaluations_per_optimization_iteration=4, hypermapper_mode={"mode": "client-server"})
    assert document["evaluator"] == {"type": "client_server"}


def test_batch_size_is_a_batch_only_in_version_3() -> None:
    older, newer = translate(scenario(batch_size=3)), translate(scenario(batch_size=3, GP_model="gpy"))
    assert "batch_size" not in older.document["budget"]
    assert "tournament size" in note_on(older, "batch_size")
    assert newer.document["budget"]["batch_size"] == 3
    assert "as in version 3" in note_on(newer, "batch_size")


def test_version_3_has_its_own_default_method() -> None:
    document = translated(acquisition_function="EI_PIBO", input_parameters=DECAY)
    assert document["surrogate"] == {"type": "gaussian_process"}
    assert at(document, "optimizer.epsilon") is MISSING
    assert at(document, "acquisition.prior_weighting.beta") == 10


def test_evolution_and_local_search_have_budgets_of_their_own() -> None:
    evolution = translated(optimization_method="evolutionary_optimization", evolution_population_size=8)
    assert evolution["budget"] == {"evaluations": 158}
    assert evolution["design_of_experiment"] == {"type": "random_sampling", "number_of_samples": 8}
    search = translated(
        optimization_method="local_search", local_search_random_points=20, local_search_evaluation_limit=60
    )
    assert search["budget"] == {"evaluations": 60}
    assert search["design_of_experiment"]["number_of_samples"] == 40
    assert search["optimizer"] == {"type": "local_search", "random_points": 40, "improvement": "best"}


def test_local_search_has_one_trade_off() -> None:
    search = translated(
        optimization_method="local_search", optimization_objectives=["a", "b"], scalarization_method="linear"
    )
    assert search["acquisition"] == {"scalarization": {"type": "linear"}}


def test_evolution_has_one_objective() -> None:
    with pytest.raises(ScenarioError, match="has one objective"):
        translated(optimization_method="evolutionary_optimization", optimization_objectives=["a", "b"])


def test_keys_of_other_methods_are_said_to_do_nothing() -> None:
    translation = translate(scenario(mutation_rate=3, cma_es_sigma=1.0, noise=False))
    assert "without evolutionary_optimization" in note_on(translation, "mutation_rate")
    assert "without cma_es" in note_on(translation, "cma_es_sigma")
    assert "with random_forest" in note_on(translation, "noise")


def test_cma_es_needs_real_parameters() -> None:
    translation = translate(scenario(acquisition_function_optimizer="cma_es", input_parameters={"n": INTEGER}))
    assert at(translation.document, "maximizer.type") == "local_search"
    assert "real parameters only" in note_on(translation, "acquisition_function_optimizer")


def test_thompson_sampling_samples() -> None:
    translation = translate(scenario(acquisition_function="TS"))
    assert at(translation.document, "acquisition.type") == "thompson_sampling"
    assert "a draw from the model" in note_on(translation, "acquisition_function")


def test_one_tree_and_no_share_of_the_parameters_are_possible() -> None:
    surrogate = translated(models={"model": "random_forest", "number_of_trees": 1, "max_features": 0})["surrogate"]
    assert surrogate["number_of_trees"] == 2
    assert surrogate["max_features"] == pytest.approx(0.5)


@pytest.mark.parametrize("limits", [[0, 1, 2], [1, 2, 3, 4, 5, 6]])
def test_a_box_has_a_pair_per_objective(limits: list[float]) -> None:
    with pytest.raises(ScenarioError, match="2 per objective: 4"):
        translated(optimization_objectives=["a", "b"], weight_sampling="bounding_box", bounding_box_limits=limits)


@pytest.mark.parametrize(
    ("keys", "path", "says"),
    [
        ({"prior_method": "magic"}, "$.prior_method", 'no method "magic"'),
        ({"prior_beta": -3}, "$.prior_beta", "-1 for a tenth"),
    ],
)
def test_a_weighting_that_does_not_exist_is_named(keys: dict[str, Any], path: str, says: str) -> None:
    with pytest.raises(ScenarioError, match=says) as caught:
        translated(input_parameters=DECAY, **keys)
    assert caught.value.path == path


def test_a_large_floor_stays_below_one() -> None:
    document = translated(input_parameters=DECAY, prior_floor=3)
    assert at(document, "acquisition.prior_weighting.floor") == pytest.approx(0.75)
