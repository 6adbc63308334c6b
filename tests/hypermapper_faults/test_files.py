"""What HyperMapper gets wrong with files, reports and pictures; each claim fails on the faulty behaviour."""

import csv

import numpy as np
import pytest

from hypermap_lite import optimize
from hypermap_lite.cli import main
from hypermap_lite.plotting import plot_function
from hypermap_lite.plotting.hypervolume_gap import gap
from hypermap_lite.plotting.reference import ReferencePoint
from hypermap_lite.plotting.runs import SamplesFile, load_runs

SCENARIO = {
    "application_name": "demo",
    "input_parameters": {
        "tool": {"parameter_type": "categorical", "values": ["a", "b", "c"]},
        "x": {"parameter_type": "real", "values": [0, 1]},
    },
    "objectives": [{"name": "f"}],
    "design_of_experiment": {"number_of_samples": 3, "type": "random_sampling"},
    "budget": {"evaluations": 6},
    "optimizer": "random_search",
}


def black_box(configuration):
    return configuration["x"]


def rows_of(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def sampled(tmp_path, name, header, *lines):
    """Write a CSV file as HyperMapper does, with carriage returns."""
    file = tmp_path / name
    file.write_bytes("\r\n".join((header, *lines, "")).encode())
    return file


def with_files(tmp_path, **changes):
    files = {"directory": str(tmp_path / "run"), "samples_file": str(tmp_path / "demo_output_samples.csv")}
    return {**SCENARIO, "output": files, **changes}


@pytest.mark.parametrize("scale", [1.0, 1000.0])
def test_hypervolume_of_a_gap_has_points_and_reference_on_one_scale(tmp_path, scale):
    """HyperMapper divides the points by their standard deviation and leaves the reference point as it is."""
    a = sampled(tmp_path, "a.csv", "f,g", f"{2 * scale},2", f"{3 * scale},1")
    b = sampled(tmp_path, "b.csv", "f,g", f"{scale},3")
    meaning = {"objectives": [{"name": "f"}, {"name": "g"}]}
    runs = load_runs([SamplesFile(path=path, scenario=meaning) for path in (a, b)])
    reference = ReferencePoint(values=np.array([4 * scale, 4.0]), names=("f", "g"), is_inferred=False)
    assert gap(runs[0], runs, reference)[-1] == pytest.approx(1 / 6)


def test_importance_of_a_categorical_before_a_numeric_parameter_is_not_swapped_with_it(tmp_path):
    """HyperMapper's forest has the one-hot columns last, and sums them in the order of the JSON."""
    reports = {"directory": str(tmp_path / "run"), "parameter_importance": True}
    scenario = {
        **SCENARIO,
        "surrogate": "random_forest",
        "design_of_experiment": {"number_of_samples": 30, "type": "random_sampling"},
        "budget": {"evaluations": 30},
        "output": reports,
    }
    shares = optimize(scenario, black_box).parameter_importance.of("f")
    assert shares["x"] > 0.9


def test_third_objective_keeps_a_point_on_the_front(tmp_path, capsys):
    """HyperMapper's front looks at the first two objectives only."""
    file = sampled(tmp_path, "s_output_samples.csv", "x,f,g,h,Timestamp", "0,1,1,9,0", "1,2,2,0,10", "2,2,2,9,20")
    main(["pareto", str(file), "--objectives", "f,g,h"])
    assert [row["x"] for row in rows_of(tmp_path / "s_output_pareto.csv")] == ["0", "1"]


def test_resume_does_not_restart_the_budget_or_the_design(tmp_path):
    """HyperMapper runs all its iterations on top of the old rows, and counts them from one again."""
    old = sampled(tmp_path, "old.csv", "f,x,tool,Timestamp", *(f"{i / 9},{i / 9},a,{i}.0" for i in range(5)))
    result = optimize(with_files(tmp_path, earlier_evaluations=str(old)), black_box)
    assert [e.suggestion.phase for e in result.evaluations] == ["earlier"] * 5 + ["random"]


def test_timestamps_are_whole_milliseconds_since_the_start_also_after_a_resume_from_dates(tmp_path):
    """HyperMapper writes milliseconds since the start, or since 1970, or floats, depending on mode and resume."""
    old = sampled(tmp_path, "old.csv", "f,x,tool,Timestamp", "0.5,0.5,a,1671000000000.0", "0.1,0.1,b,1671000000900.4")
    optimize(with_files(tmp_path, earlier_evaluations=str(old)), black_box)
    stamps = [row["Timestamp"] for row in rows_of(tmp_path / "demo_output_samples.csv")]
    assert stamps[:2] == ["0", "900"]
    assert all(stamp.isdigit() and 900 <= int(stamp) < 10**7 for stamp in stamps[2:])


def test_second_call_draws_the_second_run(tmp_path):
    """HyperMapper's plot keeps the files of the first call in a default argument."""
    meaning = {"objectives": [{"name": "f"}, {"name": "g"}]}
    draw, drawn = plot_function("pareto"), []
    for name, value in (("first", 1), ("second", 2)):
        file = sampled(tmp_path, f"{name}.csv", "f,g", f"{value},{value}")
        *_, data = draw([SamplesFile(path=file, scenario=meaning)], tmp_path / f"{name}.png", data=True)
        drawn.append([row["f"] for row in rows_of(data)])
    assert drawn == [["1.0"], ["2.0"]]


def test_posterior_best_of_a_few_points_is_found(tmp_path):
    """HyperMapper crashes when there are no more evaluations than starts of its local search."""
    reports = {"directory": str(tmp_path / "run"), "posterior_best": True}
    small = {"design_of_experiment": {"number_of_samples": 2, "type": "random_sampling"}, "budget": {"evaluations": 2}}
    result = optimize({**SCENARIO, **small, "output": reports}, black_box)
    (best,) = result.posterior_best.predictions
    assert best.configuration in [e.configuration for e in result.evaluations]


def test_resume_from_its_own_output_loses_no_row_whenever_it_is_killed(tmp_path, monkeypatch):
    """HyperMapper truncates its output before it writes the old rows again: a crash in between loses them."""
    output = sampled(tmp_path, "demo_output_samples.csv", "tool,x,f,Timestamp", "a,0.5,0.5,0", "b,0.25,0.25,7")
    before = output.read_bytes()
    scenario = with_files(tmp_path, earlier_evaluations=str(output))

    class KilledError(BaseException):
        """Nothing may catch it."""

    def kill(*_):
        raise KilledError

    for place in ("history.exports.write_atomically", "history.exports.append_durably"):
        with monkeypatch.context() as patch:
            patch.setattr(f"hypermap_lite.{place}", kill)
            with pytest.raises(KilledError):
                optimize(scenario, black_box)
        kept = [path for path in tmp_path.glob("demo_output_samples.csv*") if path.read_bytes() == before]
        assert kept, place
    result = optimize(scenario, black_box)
    assert [e.values["f"] for e in result.evaluations[:2]] == [0.5, 0.25]
    assert len(rows_of(output)) == 6


def test_existing_output_is_not_overwritten_by_a_new_run(tmp_path):
    """HyperMapper overwrites its output at the start without asking."""
    output = sampled(tmp_path, "demo_output_samples.csv", "tool,x,f,Timestamp", "a,0.5,0.5,0")
    before = output.read_bytes()
    optimize(with_files(tmp_path), black_box)
    assert (tmp_path / "demo_output_samples.csv.bak-1").read_bytes() == before
