"""The comparison runs this package, plain sampling and workers in processes of their own, and says what it found."""

import csv
import sys
from pathlib import Path

import numpy as np
import pytest

HOME = str(Path(__file__).parents[2] / "benchmarks")
FAKE_PYTHON = """#!/bin/sh
[ "$1" = -c ] && exit 0
echo "no luck today" >&2
exit 3
"""
SMALL = ("--seeds", "1", "--evaluations", "16")


@pytest.fixture(scope="module")
def benchmark():
    sys.path.insert(0, HOME)
    import sample_efficiency

    yield sample_efficiency
    sys.path.remove(HOME)


def compare(benchmark, folder, *words):
    """Run the command and return the rows it left."""
    benchmark.main([*words, *SMALL, "--output", str(folder)])
    with (folder / "sample_efficiency.csv").open(newline="") as stream:
        return list(csv.DictReader(stream))


def trace_of(row):
    return [float(value) for value in row["trace"].split()]


@pytest.fixture(scope="module")
def compared(benchmark, tmp_path_factory):
    folder = tmp_path_factory.mktemp("results")
    words = ("several", "--problems", "branin_currin", "--methods", "default,Sobol,random")
    rows = compare(benchmark, folder, *words)
    return folder, {row["method"]: row for row in rows}


def test_all_methods_begin_with_the_same_design_and_end_with_the_budget(compared):
    traces = [trace_of(row) for row in compared[1].values()]
    assert [len(trace) for trace in traces] == [16, 16, 16]
    assert traces[0][:6] == traces[1][:6] == traces[2][:6]
    assert traces[0] != traces[1]


def test_integers_lists_and_categories_are_compared_too(benchmark, tmp_path):
    words = ("mixed", "--problems", "hartmann6_mixed,disc_brake,ackley5c", "--methods", "default,Sobol,random")
    rows = compare(benchmark, tmp_path, *words)
    assert [row["error"] for row in rows] == [""] * 9
    for name in ("hartmann6_mixed", "disc_brake", "ackley5c"):
        traces = [trace_of(row) for row in rows if row["problem"] == name]
        design = traces[0][: 10 if name == "disc_brake" else 14]
        assert all(len(trace) == 16 and trace[: len(design)] == design for trace in traces)
        assert len(set(design)) > 1


def test_share_of_the_hypervolume_grows_up_to_one(compared):
    for row in compared[1].values():
        trace = trace_of(row)
        assert trace == sorted(trace)
        assert 0 < float(row["half"]) <= float(row["final"]) <= 1


def test_failures_come_by_chance_and_count_as_what_came_out(benchmark):
    from one_run import BlackBox

    problem = benchmark.PROBLEMS["branin_currin_failing"]
    place = problem.configurations(problem.points(np.full((1, 2), 0.3)))[0]
    boxes = [BlackBox(problem, seed) for seed in range(20)]
    answers = [[tuple(box(place).values) for _ in range(60)] for box in boxes]
    is_failure = np.array([[values == tuple(problem.worst) for values in row] for row in answers])
    truth = tuple(problem.function(problem.points(np.full((1, 2), 0.3)))[0])
    assert {values for row in answers for values in row} == {truth, tuple(problem.worst)}
    assert 0.03 < is_failure.mean() < 0.07
    assert len({tuple(row) for row in is_failure}) == 20
    assert [tuple(values) for values in boxes[0].truths] == answers[0]


def test_model_is_worth_more_than_sampling(compared):
    assert float(compared[1]["default"]["final"]) > float(compared[1]["Sobol"]["final"])


def test_page_has_a_line_per_method_and_the_goal(compared):
    folder, _ = compared
    page = (folder / "sample_efficiency.md").read_text()
    assert [line.split(" | ")[1] for line in page.splitlines() if line.startswith("| branin_currin")] == [
        "default",
        "Sobol",
        "random",
        "*goal*",
    ]
    assert (folder / "sample_efficiency_several.png").exists()


def test_case_with_a_row_is_not_run_again_until_it_is_forgotten(benchmark, compared, tmp_path, capsys):
    folder, rows = compared
    (tmp_path / "sample_efficiency.csv").write_bytes((folder / "sample_efficiency.csv").read_bytes())
    words = ("several", "--problems", "branin_currin", "--methods", "Sobol")
    compare(benchmark, tmp_path, *words)
    assert capsys.readouterr().out.startswith("0 runs to do")
    found = compare(benchmark, tmp_path, *words, "--again", "Sobol")
    assert capsys.readouterr().out.startswith("1 runs to do")
    assert [row["method"] for row in found] == ["default", "random", "Sobol"]
    assert found[-1]["trace"] == rows["Sobol"]["trace"]


def test_peer_without_an_environment_is_skipped_with_the_commands_that_make_it(benchmark, tmp_path, capsys):
    words = ("single", "--methods", "Optuna TPE", "--environments", str(tmp_path / "none"))
    assert compare(benchmark, tmp_path, *words) == []
    said = capsys.readouterr().out
    assert "Optuna TPE is skipped" in said
    assert f"{tmp_path}/none/optuna/bin/python -m pip install -r benchmarks/peers/optuna.txt" in said


def test_failed_run_leaves_its_last_words(benchmark, tmp_path, capsys):
    python = tmp_path / "optuna" / "bin" / "python"
    python.parent.mkdir(parents=True)
    python.write_text(FAKE_PYTHON)
    python.chmod(0o755)
    words = ("single", "--problems", "branin", "--methods", "Optuna TPE", "--environments", str(tmp_path))
    [row] = compare(benchmark, tmp_path, *words)
    assert "branin, Optuna TPE, seed 0: no luck today" in capsys.readouterr().out
    assert (row["error"], row["final"], row["trace"]) == ("no luck today", "", "")


def test_variant_is_a_change_of_the_scenario(benchmark, tmp_path):
    name = "no model"
    words = ("ablation", "--problems", "branin_currin_noisy", "--methods", f"default,{name}")
    rows = compare(benchmark, tmp_path, *words, "--variant", name, "optimizer.type=random_search")
    traces = {row["method"]: trace_of(row) for row in rows}
    assert traces["default"][:6] == traces[name][:6]
    assert traces["default"] != traces[name]


def test_ours_meets_an_unknown_constraint(benchmark, tmp_path):
    [row] = compare(benchmark, tmp_path, "constrained", "--problems", "c2dtlz2", "--methods", "default")
    assert 0 < float(row["feasible_share"]) < 1
