"""Tests for prior.py."""

import csv
import json

import numpy as np
import pytest

from hypermap_lite.errors import RunFolderError, ScenarioError, UsageError
from hypermap_lite.plotting.prior import plot_prior
from tests.plotting.run_folders import TWO_PARAMETERS, write_run

PARAMETERS = {
    "first": {"parameter_type": "real", "values": [0, 1]},
    "speed": {"parameter_type": "real", "values": [0, 10], "prior": {"type": "gaussian", "mean": 5, "std": 1}},
    "mode": {
        "parameter_type": "categorical",
        "values": ["soft", "rigid"],
        "prior": {"type": "weights", "weights": [3, 1]},
    },
    "stiffness": {"parameter_type": "real", "values": [0.01, 100], "scale": "log"},
}
POINTS = {"first": [0.2, 0.4, 0.4], "stiffness": [1.0, 10.0, 10.0]}


@pytest.fixture
def scenario(tmp_path):
    """Write a scenario with the given parameters and sections, and return its file."""

    def write(parameters=PARAMETERS, **sections):
        document = {"application_name": "demo", "input_parameters": parameters, "objectives": [{"name": "f"}]}
        file = tmp_path / "scenario_of_mine.json"
        file.write_text(json.dumps(document | sections))
        return file

    return write


def legend_of(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def rows_of(file, what):
    rows = list(csv.reader(file.read_text().splitlines()))
    return [row[1:] for row in rows if row[0] == what]


def test_first_two_parameters_with_a_prior_are_drawn(scenario, tmp_path, figures):
    plot_prior([scenario()], tmp_path / "p.png")
    plane = figures[0].axes[2]
    assert (plane.get_xlabel(), plane.get_ylabel()) == ("speed", "mode")
    assert figures[0].get_suptitle() == "demo"


def test_lone_parameter_with_a_prior_is_drawn_with_the_first_other(scenario, tmp_path, figures):
    parameters = {name: entry for name, entry in PARAMETERS.items() if name != "mode"}
    plot_prior([scenario(parameters)], tmp_path / "p.png")
    plane = figures[0].axes[2]
    assert (plane.get_xlabel(), plane.get_ylabel()) == ("first", "speed")


def test_density_of_independent_priors_is_the_product_of_their_marginals(scenario, tmp_path):
    *_, file = plot_prior([scenario()], tmp_path / "p.png", data=True)
    joint = np.array([float(density) for *_, density in rows_of(file, "joint")]).reshape(2, -1)
    marginals = [(speed, mode, float(density)) for speed, mode, density in rows_of(file, "marginal")]
    of_speed = np.array([density for speed, _, density in marginals if speed])
    of_mode = {mode: density for _, mode, density in marginals if mode}
    assert of_mode == pytest.approx({"soft": 1.5, "rigid": 0.5})  # uniform is 1
    np.testing.assert_allclose(joint, np.outer([1.5, 0.5], of_speed))
    np.testing.assert_allclose(np.trapezoid(of_speed, dx=1 / (len(of_speed) - 1)), 1, rtol=1e-3)


def test_peak_lies_at_the_mean_in_native_units(scenario, tmp_path):
    *_, file = plot_prior([scenario()], tmp_path / "p.png", data=True)
    speed, *_ = max(rows_of(file, "marginal"), key=lambda row: float(row[2]) if row[0] else 0)
    assert float(speed) == pytest.approx(5.0)


def test_ticks_of_a_logarithmic_axis_are_powers_of_ten(scenario, tmp_path, figures):
    plot_prior([scenario()], tmp_path / "p.png", parameters=["stiffness", "speed"])
    plane = figures[0].axes[2]
    assert plane.get_xlabel() == "stiffness (log)"
    assert [label.get_text() for label in plane.get_xticklabels()] == ["0.01", "0.1", "1", "10", "100"]
    np.testing.assert_allclose(plane.get_xticks(), [0, 0.25, 0.5, 0.75, 1])


def test_levels_are_bars_beside_the_plane(scenario, tmp_path, figures):
    plot_prior([scenario()], tmp_path / "p.png")
    above, _, plane, beside, *_ = figures[0].axes
    assert [bar.get_width() for bar in beside.patches] == pytest.approx([1.5, 0.5])
    assert not above.patches
    assert [label.get_text() for label in plane.get_yticklabels()] == ["soft", "rigid"]


def test_points_a_prior_was_learned_from_are_drawn_where_they_lie(scenario, tmp_path, figures):
    mine = scenario(priors=[{"type": "kde", "points": POINTS}])
    *_, file = plot_prior([mine], tmp_path / "p.png", parameters=["first", "stiffness"], data=True)
    assert rows_of(file, "learned from") == [["0.2", "1.0", ""], ["0.4", "10.0", ""], ["0.4", "10.0", ""]]
    assert "learned from (3 points)" in legend_of(figures[0])


def test_points_that_coincide_are_drawn_larger(scenario, tmp_path, figures):
    file = scenario(priors=[{"type": "kde", "points": POINTS}])
    plot_prior([file], tmp_path / "p.png", parameters=["first", "stiffness"])
    (dots,) = [c for c in figures[0].axes[2].collections if len(c.get_offsets()) == 2]
    np.testing.assert_allclose(dots.get_offsets(), [[0.2, 0.5], [0.4, 0.75]])
    assert dots.get_sizes()[0] < dots.get_sizes()[1]


def test_points_of_other_parameters_are_not_drawn(scenario, tmp_path, figures):
    file = scenario(priors=[{"type": "kde", "points": POINTS}])
    plot_prior([file], tmp_path / "p.png", parameters=["first", "speed"])
    assert legend_of(figures[0]) == ["marginal density", "uniform"]


def test_run_shows_the_design_drawn_from_its_prior(tmp_path, figures):
    folder = write_run(tmp_path / "run", [[1.0, 1.0]] * 4, n_design=3, parameters=TWO_PARAMETERS)
    *files, file = plot_prior([folder / "history.csv"], data=True)
    assert files == [folder / "prior.png", folder / "prior.pdf"]
    assert rows_of(file, "design") == [["0.0", "0.001", ""], ["0.1", "0.002", ""], ["0.2", "0.003", ""]]
    assert "initial design, drawn from it" in legend_of(figures[0])


def test_design_that_was_not_drawn_from_the_prior_is_not_shown(tmp_path, figures):
    design = {"type": "sobol", "number_of_samples": 3}
    sections = {"parameters": TWO_PARAMETERS, "design_of_experiment": design}
    plot_prior([write_run(tmp_path / "run", [[1.0, 1.0]] * 4, n_design=3, **sections)])
    assert "initial design, drawn from it" not in legend_of(figures[0])


def test_run_without_any_evaluation_shows_its_prior(tmp_path):
    folder = write_run(tmp_path / "run", [], parameters=TWO_PARAMETERS)
    (folder / "history.csv").unlink()
    assert plot_prior([folder]) == [folder / "prior.png", folder / "prior.pdf"]


def test_scenario_without_a_prior_is_an_error(scenario):
    parameters = {name: {"parameter_type": "real", "values": [0, 1]} for name in "ab"}
    with pytest.raises(UsageError, match=r"scenario_of_mine.json: no parameter has a prior"):
        plot_prior([scenario(parameters)])


def test_scenario_with_one_parameter_is_an_error(scenario):
    with pytest.raises(UsageError, match="needs 2 parameters, this scenario has 1"):
        plot_prior([scenario({"speed": PARAMETERS["speed"]})])


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (["speed"], "draws 2 parameters, and 1 are given: speed"),
        (["speed", "mode", "first"], "and 3 are given"),
        (["speed", "stifness"], "unknown parameter 'stifness'; .* Did you mean 'stiffness'"),
        (["speed", "speed"], "'speed' is given twice"),
    ],
)
def test_other_choices_of_parameters_are_an_error(scenario, names, message):
    with pytest.raises(UsageError, match=message):
        plot_prior([scenario()], parameters=names)


def test_several_runs_are_an_error(scenario):
    with pytest.raises(UsageError, match="draws one prior, and 2 runs or scenarios are given"):
        plot_prior([scenario(), scenario()])


def test_missing_file_is_an_error(tmp_path):
    with pytest.raises(RunFolderError, match=r"nowhere.json: not a run folder \(no such file or folder\)"):
        plot_prior([tmp_path / "nowhere.json"])


def test_folder_without_scenario_is_an_error(tmp_path):
    with pytest.raises(RunFolderError, match=r"no scenario.json in it"):
        plot_prior([tmp_path])


def test_faulty_scenario_is_an_error_that_names_the_place(scenario):
    with pytest.raises(ScenarioError, match="objectives"):
        plot_prior([scenario(objectives=[])])
