"""Tests for scenario_record.py."""

import json
import logging

import pytest

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history import scenario_record
from hypermap_lite.history.scenario_record import check_scenario, differing, write_scenario

SCENARIO = {
    "seed": 1,
    "input_parameters": {"x": {"parameter_type": "real", "values": (0, 1.0)}},
    "budget": {"evaluations": 9, "batch_size": 1, "minutes": None},
    "evaluator": {"type": "command", "workers": 1, "timeout_seconds": None},
    "objectives": [{"name": "f", "description": ""}, {"name": "g", "reference_point": 1}],
    "output": {"directory": "outputs/a"},
    "application_name": "demo",
    "description": "",
}


def changed(section, **entries):
    return {**SCENARIO, section: {**SCENARIO[section], **entries}}


def test_scenario_is_written_with_the_versions_in_use(tmp_path):
    write_scenario(tmp_path / "scenario.json", SCENARIO)
    content = json.loads((tmp_path / "scenario.json").read_text())
    assert content["input_parameters"]["x"]["values"] == [0, 1.0]
    assert {"hypermap_lite", "python", "numpy"} <= set(content["versions"])


def test_same_scenario_passes(tmp_path):
    write_scenario(tmp_path / "scenario.json", SCENARIO)
    check_scenario(tmp_path / "scenario.json", json.loads(json.dumps(SCENARIO)))


def test_absent_record_passes(tmp_path):
    check_scenario(tmp_path / "scenario.json", SCENARIO)


@pytest.mark.parametrize(
    "scenario",
    [
        changed("budget", evaluations=50, minutes=3.0),
        changed("evaluator", workers=4, timeout_seconds=2.5, max_consecutive_failures=50),
        changed("output", directory="elsewhere"),
        {**SCENARIO, "description": "Now with a word of explanation."},
        {**SCENARIO, "application_name": "other"},
        {**SCENARIO, "objectives": [{"name": "f", "description": "in mm"}, {"name": "g", "reference_point": 1}]},
        changed("input_parameters", x={**SCENARIO["input_parameters"]["x"], "description": "in N"}),
    ],
    ids=[
        "budget",
        "evaluator",
        "output",
        "description",
        "name",
        "of an objective",
        "of a parameter",
    ],
)
def test_change_that_leaves_the_rows_valid_passes(tmp_path, scenario):
    write_scenario(tmp_path / "scenario.json", SCENARIO)
    check_scenario(tmp_path / "scenario.json", scenario)


def test_finished_run_may_be_measured_from_another_reference_point(tmp_path):
    write_scenario(tmp_path / "scenario.json", SCENARIO)
    other = {**SCENARIO, "objectives": [SCENARIO["objectives"][0], {"name": "g", "reference_point": 7}]}
    check_scenario(tmp_path / "scenario.json", other, is_finished=True)
    with pytest.raises(RunFolderError, match="reference_point: 1 there, 7 now"):
        check_scenario(tmp_path / "scenario.json", other)


def test_every_difference_is_named_with_both_values(tmp_path):
    write_scenario(tmp_path / "scenario.json", SCENARIO)
    other = changed("budget", batch_size=3) | {"seed": 2, "preset": "paper"}
    with pytest.raises(RunFolderError) as caught:
        check_scenario(tmp_path / "scenario.json", other)
    assert str(caught.value).splitlines()[1:4] == [
        "  $.seed: 1 there, 2 now",
        "  $.budget.batch_size: 1 there, 3 now",
        '  $.preset: nothing there, "paper" now',
    ]
    assert "--fresh" in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "n_differences"),
    [("a.csv", "b.csv", 0), (None, "b.csv", 1), ("a.csv", None, 1), (None, None, 0)],
)
def test_file_of_earlier_evaluations_may_move_but_not_come_or_go(old, new, n_differences):
    found = list(differing({"earlier_evaluations": old}, {"earlier_evaluations": new}))
    assert len(found) == n_differences


def test_whole_numbers_are_equal_however_written():
    assert list(differing({"a": 1.0, "b": [2.0, {"c": 3.0}]}, {"a": 1, "b": [2, {"c": 3}]})) == []


def test_other_library_version_is_only_warned_of(tmp_path, monkeypatch, caplog):
    write_scenario(tmp_path / "scenario.json", SCENARIO)
    monkeypatch.setattr(scenario_record, "installed_versions", lambda: {"numpy": "9.9"})
    with caplog.at_level(logging.WARNING):
        check_scenario(tmp_path / "scenario.json", SCENARIO)
    assert "numpy was" in caplog.text


@pytest.mark.parametrize(("content", "message"), [("{", "cannot be read"), ("[]", "is not a scenario")])
def test_damaged_record_is_an_error(tmp_path, content, message):
    (tmp_path / "scenario.json").write_text(content)
    with pytest.raises(RunFolderError, match=message):
        check_scenario(tmp_path / "scenario.json", SCENARIO)


def test_difference_in_a_list_of_objects_is_named_by_its_own_place():
    other = {**SCENARIO, "objectives": [SCENARIO["objectives"][0], {**SCENARIO["objectives"][1], "goal": "maximize"}]}
    ((place, *_),) = differing(SCENARIO, other)
    assert place == "$.objectives[1].goal"


def test_parameter_called_description_is_no_description():
    def prior(mean):
        return {"priors": [{"components": [{"mean": {"description": mean}}]}]}

    ((place, *_),) = differing(prior(1), prior(2))
    assert place == "$.priors[0].components[0].mean.description"


def test_order_of_the_parameters_is_compared():
    x, y = {"values": [0, 1]}, {"values": [0, 2]}
    ((place, old, new),) = differing({"input_parameters": {"x": x, "y": y}}, {"input_parameters": {"y": y, "x": x}})
    assert (place, old, new) == ("$.input_parameters", 'the order ["x", "y"]', '["y", "x"]')


def test_record_without_versions_is_fine(tmp_path, caplog):
    (tmp_path / "scenario.json").write_text(json.dumps({**SCENARIO, "versions": None}))
    check_scenario(tmp_path / "scenario.json", SCENARIO)
    assert caplog.text == ""


def test_an_option_that_older_records_do_not_have_is_no_difference_while_it_is_null():
    before, now = {"prior": {"type": "uniform"}}, {"prior": {"type": "uniform", "low": None, "high": None}}
    assert list(differing(before, now)) == []
    assert list(differing(now, before)) == []
    assert list(differing(before, {"prior": {"type": "uniform", "low": 2}})) == [("$.prior.low", "nothing", "2")]


def test_an_option_that_older_records_do_not_have_is_no_difference_while_it_is_off():
    before, now = {"evaluator": {"type": "python"}}, {"evaluator": {"type": "python", "batch": False}}
    assert list(differing(before, now)) == []
    assert [place for place, *_ in differing(before, {"evaluator": {"type": "python", "batch": True}})] == [
        "$.evaluator.batch"
    ]
    assert [place for place, *_ in differing({"noise": True}, {"noise": False})] == ["$.noise"]


def test_the_file_of_a_prior_may_differ_but_not_its_points(tmp_path):
    def scenario(file, last):
        return {"priors": [{"type": "kde", "file": file, "points": {"x": [*map(float, range(500)), last]}}]}

    write_scenario(tmp_path / "scenario.json", scenario("a.csv", 0.5))
    check_scenario(tmp_path / "scenario.json", scenario("/home/me/a.csv", 0.5))
    with pytest.raises(RunFolderError) as caught:
        check_scenario(tmp_path / "scenario.json", scenario("a.csv", 0.7))
    line = str(caught.value).splitlines()[1]
    assert line.startswith("  $.priors[0].points.x: ... ")
    assert "499, 0.5] ... there" in line
    assert "499, 0.7] ... now" in line
    assert len(line) < 160


def test_an_old_run_of_a_version_without_feasibility_goes_on_with_the_default():
    old = {"acquisition": {"type": "thompson_sampling"}}
    new = {"acquisition": {"type": "thompson_sampling", "feasibility_weighting": {"method": "probability"}}}
    assert list(differing(old, new)) == []
    new["acquisition"]["feasibility_weighting"]["method"] = "none"
    assert [place for place, _, _ in differing(old, new)] == ["$.acquisition.feasibility_weighting.method"]
