"""Tests for summary.py, on run folders written by hand."""

import json
import math

import pytest

from hypermap_lite.errors import RunFolderError, ScenarioError
from hypermap_lite.study import load_study, write_tables
from hypermap_lite.study import summarize as compare
from tests.study.studies import TWO, A, loaded, table, write_runs, write_study


def summarize(study):
    """Compare the runs of a study and write its tables."""
    summary = compare(study)
    write_tables(summary)
    return summary


NAN = [math.nan, math.nan]
CORNER = [{"name": "f", "reference_point": 4}, {"name": "g", "reference_point": 4}]
SCENARIO = {"objectives": CORNER, "budget": {"evaluations": 3}}

FOUND = {
    "a": [[[3, 3], NAN, [2, 3]], [[3, 3], [3, 1], [1, 3]]],
    "b": [[[3, 3], [2, 2], NAN], [[2, 3], [2, 3], [1, 2]]],
}
"""Hypervolumes 1 1 2 and 1 3 5 of a, 1 4 4 and 2 2 6 of b; the front of all is (1, 2) and (3, 1), with 7."""

HEADER = ["trial", "replicate", "seed", "state", "x", "k", "f", "g", "noise", "force", "count", "seconds", "error"]


def calls(*numbers):
    """Return rows of evaluations.csv with the same number in each extra column; None for a failed call."""
    lines = [HEADER]
    for trial, replicate, number in numbers:
        state, cell = ("failed", "") if number is None else ("completed", number)
        lines.append([trial, replicate, 7, state, 0.5, 3, 1.0, 2.0, cell, cell, cell, 0.1, ""])
    return lines


CALLS = {
    "a": calls((2, 0, 5), (0, 1, 3), (0, 0, 1), (1, 0, None), (1, 1, None), (2, 1, None)),
    "b": calls((0, 0, None), (0, 1, None), (1, 0, 2), (1, 1, 6), (2, 0, 1), (2, 1, 3)),
}
"""Two calls per evaluation, not all in order."""

METRICS = {"noise": "mean", "force": "max", "count": "sum"}


@pytest.fixture
def study(tmp_path):
    return loaded(tmp_path, scenario=SCENARIO)


@pytest.fixture
def measured(tmp_path):
    study = loaded(tmp_path, scenario=SCENARIO, metrics=METRICS)
    write_runs(study, calls=CALLS, n_design=1, **FOUND)
    return study


def column(rows, name):
    return [float(row[name] or "nan") for row in rows]


def by_variant(study):
    return {row["variant"]: row for row in table(study.folder / "comparison.csv")}


def test_summary_has_the_course_of_every_run(study):
    write_runs(study, **FOUND)
    summarize(study)
    rows = table(study.folder / "summary.csv")
    keys = [f"{row['variant']} {row['seed']} {row['evaluation']}" for row in rows]
    assert keys == [f"{variant} {seed} {i}" for variant in "ab" for seed in ("00", "01") for i in (1, 2, 3)]
    assert column(rows, "hypervolume") == [1, 1, 2, 1, 3, 5, 1, 4, 4, 2, 2, 6]
    assert column(rows, "hypervolume_share") == [v / 7 for v in column(rows, "hypervolume")]
    assert column(rows, "best_f") == [3, 3, 2, 3, 3, 1, 3, 2, 2, 2, 2, 1]
    assert column(rows, "best_g") == [3, 3, 3, 3, 1, 1, 3, 2, 2, 3, 3, 2]
    assert [row["state"] for row in rows[:3]] == ["completed", "failed", "completed"]


def test_averages_are_over_the_runs_of_a_variant(study):
    write_runs(study, **FOUND)
    summarize(study)
    rows = table(study.folder / "averages.csv")
    assert [(row["variant"], row["evaluation"], row["runs"]) for row in rows] == [
        (v, n, "2") for v in "ab" for n in "123"
    ]
    assert column(rows, "hypervolume") == [1, 2, 3.5, 1.5, 3, 5]
    assert column(rows, "hypervolume_se") == pytest.approx([0, 1, 1.5, 0.5, 1, 1])
    assert column(rows, "hypervolume_share") == pytest.approx([1 / 7, 2 / 7, 0.5, 1.5 / 7, 3 / 7, 5 / 7])
    assert column(rows, "hypervolume_share_se") == pytest.approx([0, 1 / 7, 1.5 / 7, 0.5 / 7, 1 / 7, 1 / 7])


def test_extra_numbers_are_added_up_over_the_calls_in_their_order(measured):
    summarize(measured)
    rows = table(measured.folder / "summary.csv")
    assert column(rows[:3], "noise_mean") == [2, 2, 3]
    assert column(rows[:3], "force_max") == [3, 3, 5]
    assert column(rows[:3], "count_sum") == [4, 4, 9]
    assert [row["noise_mean"] for row in rows[6:9]] == ["", "4.0", "3.0"]
    assert [row["force_max"] for row in rows[6:9]] == ["", "6.0", "6.0"]
    assert [row["count_sum"] for row in rows[6:9]] == ["", "8.0", "12.0"]


def test_comparison_by_hand(measured):
    summarize(measured)
    rows = by_variant(measured)
    baseline = {
        "variant": "a",
        "label": "a",
        "runs": "2",
        "evaluations": "3",
        "without_result": "1",
        "paired": "true",
        "final_hypervolume": "3.5",
        "final_share": "0.5",
        "ratio": "",
        "ratio_low": "",
        "ratio_high": "",
        **{f"evaluations_to_baseline{end}": "3.0" for end in ("", "_low", "_high")},
    }
    assert {key: rows["a"][key] for key in baseline} == baseline
    assert float(rows["a"]["final_hypervolume_se"]) == pytest.approx(1.5)
    b = {key: float(rows["b"][key]) for key in rows["b"] if key not in ("variant", "label", "paired")}
    assert (b["final_hypervolume"], b["final_hypervolume_se"], b["final_share"]) == (5, pytest.approx(1), 5 / 7)
    assert (b["ratio"], b["ratio_low"], b["ratio_high"]) == (5 / 3.5, 6 / 5, 4 / 2)
    assert [b[f"evaluations_to_baseline{end}"] for end in ("", "_low", "_high")] == [3, 2, 3]
    assert (b["noise_mean"], b["noise_mean_se"], b["noise_mean_ratio"]) == (3, 0, 1)
    assert [b[f"force_max{end}"] for end in ("", "_ratio", "_ratio_low", "_ratio_high")] == [6, 1.2, 1.2, 1.2]
    assert [b[f"count_sum{end}"] for end in ("", "_ratio", "_ratio_low")] == [12, 12 / 9, 12 / 9]
    assert b["seconds_per_run"] == pytest.approx(3 * 0.3)


def test_union_front_has_run_and_configuration_of_each_point_once(study):
    again = {**FOUND, "b": [FOUND["b"][1], FOUND["b"][1]]}
    write_runs(study, **again)
    summarize(study)
    rows = table(study.folder / "union_front.csv")
    assert [(row["variant"], row["seed"], row["trial"], row["x"]) for row in rows] == [
        ("b", "00", "2", "0.2"),
        ("a", "01", "1", "0.1"),
    ]
    assert [(row["f"], row["g"]) for row in rows] == [("1.0", "2.0"), ("3.0", "1.0")]


def test_share_of_the_front_of_all_runs_is_one(study):
    best = [[[1, 2], [3, 1], [3, 3]]] * 2
    write_runs(study, **{**FOUND, "b": best})
    summary = summarize(study)
    assert summary.whole_volume == 7
    assert float(by_variant(study)["b"]["final_share"]) == 1.0


def test_maximized_objectives_stay_as_the_user_directed_them(tmp_path):
    goals = [{"name": n, "goal": "maximize", "reference_point": -4} for n in ("f", "g")]
    study = loaded(tmp_path, scenario={**SCENARIO, "objectives": goals})
    write_runs(study, **{v: [[[-f, -g] for f, g in Y] for Y in runs] for v, runs in FOUND.items()})
    summarize(study)
    rows = table(study.folder / "summary.csv")
    assert column(rows[:3], "hypervolume") == [1, 1, 2]
    assert column(rows[:3], "best_f") == [-3, -3, -2]
    assert [row["f"] for row in table(study.folder / "union_front.csv")] == ["-1.0", "-3.0"]


@pytest.mark.parametrize(("goal", "sign"), [("maximize", 1), ("minimize", -1)])
def test_single_objective_is_compared_by_its_best_value(tmp_path, goal, sign):
    study = loaded(tmp_path, scenario={**SCENARIO, "objectives": [{"name": "f", "goal": goal}]})
    a, b = [[math.nan], [sign], [3 * sign]], [[sign], [3 * sign], [sign]]
    write_runs(study, a=[a, a], b=[b, b])
    summary = summarize(study)
    assert summary.reference_point is None
    rows = table(study.folder / "summary.csv")
    assert list(rows[0]) == ["variant", "seed", "evaluation", "state", "best_f"]
    assert [row["best_f"] for row in rows[:3]] == ["", f"{sign}.0", f"{3 * sign}.0"]
    compared = by_variant(study)
    assert not {"ratio", "final_share", "final_hypervolume"} & set(compared["b"])
    assert (compared["b"]["final_best_f"], compared["b"]["final_best_f_se"]) == (f"{3 * sign}.0", "0.0")
    assert [compared[v]["evaluations_to_baseline"] for v in "ab"] == ["3.0", "2.0"]
    assert len(table(study.folder / "union_front.csv")) == 1


def test_runs_that_are_not_finished_are_left_out_and_counted(study):
    write_runs(study, **{**FOUND, "b": [FOUND["b"][0][:2], None]})
    summary = summarize(study)
    assert summary.n_missing == 2
    assert [c.variant.name for c in summary.comparisons] == ["a"]
    write_runs(study, a=[None, None], b=[[NAN, NAN, NAN], FOUND["b"][1]])
    summary = summarize(study)
    assert summary.n_missing == 1
    assert by_variant(study)["b"]["runs"] == "1"


def test_variants_with_runs_of_other_seeds_are_not_paired(study):
    write_runs(study, n_design=1, **{**FOUND, "b": [None, FOUND["b"][1]]})
    summarize(study)
    assert by_variant(study)["b"]["paired"] == "false"


def test_variants_with_other_designs_are_not_paired(study):
    write_runs(study, n_design=1, **FOUND)
    other = study.folder / "runs" / "b" / "01" / "history.csv"
    other.write_text(other.read_text().replace("\n0.0,", "\n9.9,", 1))
    summarize(study)
    assert by_variant(study)["b"]["paired"] == "false"


def test_runs_are_compared_at_the_end_of_the_shortest(tmp_path):
    variants = {"a": A, "b": {**A, "set": {"budget.evaluations": 2}}}
    study = loaded(tmp_path, scenario=SCENARIO, variants=variants)
    write_runs(study, a=FOUND["a"], b=[Y[:2] for Y in FOUND["b"]])
    assert summarize(study).n_evaluations == 2
    assert [by_variant(study)[v]["final_hypervolume"] for v in "ab"] == ["2.0", "3.0"]


def test_run_of_an_exhausted_space_is_finished(tmp_path):
    space = {"x": {"parameter_type": "ordinal", "values": [0, 1, 2]}, "k": None}
    study = loaded(tmp_path, scenario={"objectives": CORNER}, set={"input_parameters": space})
    assert study.baseline.effective.budget.evaluations == 4
    write_runs(study, **FOUND)
    assert summarize(study).n_missing == 0


def test_study_without_a_finished_baseline_is_an_error_that_names_it(study):
    write_runs(study, **{**FOUND, "a": [None, FOUND["a"][0][:1]]})
    with pytest.raises(RunFolderError, match="no run of the baseline 'a' is finished yet"):
        summarize(study)


def test_results_of_another_scenario_are_not_summed_up(tmp_path, study):
    write_runs(study, **FOUND)
    with pytest.raises(RunFolderError, match=r"replicates: 1 there, 3 now"):
        summarize(load_study(tmp_path / "study.json", overrides=["evaluator.replicates=3"]))


def test_missing_extra_number_is_named_with_those_there_are(measured, tmp_path):
    study = loaded(tmp_path, scenario=SCENARIO, metrics={"nois": "mean"})
    with pytest.raises(ScenarioError, match=r"\$.metrics.nois: .*/a/00/evaluations.csv has no column 'nois'\n.*noise"):
        summarize(study)


def test_extra_number_that_is_no_number_is_an_error(measured, tmp_path):
    study = loaded(tmp_path, scenario=SCENARIO, metrics={"state": "sum"})
    with pytest.raises(ScenarioError, match=r"\$.metrics.state: .*evaluations.csv has 'completed'"):
        summarize(study)


def test_shares_are_of_the_reference_front_if_there_is_one(tmp_path):
    (tmp_path / "front.csv").write_text("x,g,f\n0,1,1\n0,9,9\n")
    study = loaded(tmp_path, scenario=SCENARIO, reference_front="front.csv")
    write_runs(study, **FOUND)
    assert summarize(study).whole_volume == 9
    assert float(by_variant(study)["b"]["final_share"]) == 5 / 9


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("f,h\n1,2\n", "has no rows with columns f, g"),
        ("f,g\n", "has no rows with columns f, g"),
        ("f,g\n1,\n", "front.csv has '' in a column of numbers"),
    ],
    ids=["other columns", "no rows", "empty cell"],
)
def test_reference_front_that_is_none_is_an_error(tmp_path, text, message):
    (tmp_path / "front.csv").write_text(text)
    study = loaded(tmp_path, scenario=SCENARIO, reference_front="front.csv")
    write_runs(study, **FOUND)
    with pytest.raises(ScenarioError, match=rf"\$.reference_front: .*{message}"):
        summarize(study)


def test_reference_front_that_is_missing_is_told_at_once(tmp_path):
    with pytest.raises(ScenarioError, match=r'reference_front: there is no file "front.csv"'):
        loaded(tmp_path, reference_front="front.csv")


def test_reference_point_that_is_set_afterwards_counts(tmp_path, study):
    write_runs(study, **FOUND)
    moved = load_study(tmp_path / "study.json", overrides=["objectives.0.reference_point=3"])
    assert summarize(moved).reference_point.values.tolist() == [3, summarize(study).reference_point.values[1]]


def test_evaluations_beyond_those_compared_are_left_out(tmp_path):
    longer = {**TWO, "b": {**TWO["b"], "set": {**TWO["b"].get("set", {}), "budget.evaluations": 4}}}
    study = loaded(tmp_path, scenario=SCENARIO, variants=longer)
    write_runs(study, a=FOUND["a"], b=[[*Y, [0, 0]] for Y in FOUND["b"]])
    summary = summarize(study)
    assert (summary.n_evaluations, summary.whole_volume) == (3, 7)


def test_volumes_of_zero_have_no_share_and_no_ratio(study):
    write_runs(study, **{v: [[[5, 5]] * 3] * 2 for v in "ab"})
    summary = summarize(study)
    assert summary.whole_volume == 0
    row = by_variant(study)["b"]
    assert (row["final_hypervolume"], row["final_share"], row["ratio"]) == ("0.0", "", "")


@pytest.mark.parametrize("name", ["summary.csv", "averages.csv", "comparison.csv", "union_front.csv", "study.json"])
def test_files_are_the_same_when_they_are_written_again(measured, name):
    summarize(measured)
    before = (measured.folder / name).read_bytes()
    (measured.folder / name).unlink()
    summarize(measured)
    assert (measured.folder / name).read_bytes() == before


def test_study_file_in_the_folder_tells_what_was_run(tmp_path):
    file = write_study(tmp_path, scenario=SCENARIO)
    study = load_study(file, only=["a"], overrides=["evaluator.workers=2"], repetitions=2)
    write_runs(study, **FOUND)
    summarize(study)
    record = json.loads((study.folder / "study.json").read_text())
    assert (list(record["variants"]), record["overrides"]) == (["a"], ["evaluator.workers=2"])
    assert (record["repetitions"], record["baseline"]) == (2, "a")
    assert {"hypermap_lite", "numpy", "python"} <= set(record["versions"])
