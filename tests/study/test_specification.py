"""Tests for specification.py."""

import json

import pytest

from hypermap_lite.cli import main
from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario import load_scenario
from hypermap_lite.study import load_study
from tests.study.studies import TWO, A, loaded, write_study


def with_sets(folder, without):
    """Write a study in which study, variant and quick form set the budget to 2, 3 and 5; leave some of them out."""
    sets = {"study": 2, "variant": 3, "quick": 5}
    study, variant, quick = ({} if place in without else {"budget.evaluations": n} for place, n in sets.items())
    return write_study(folder, variants={"a": {**A, "set": variant}}, set=study, quick={"set": quick})


def test_short_study_gets_all_defaults(tmp_path):
    file = write_study(tmp_path)
    file.write_text(json.dumps({"name": "demo", "variants": {"a": A}}))
    study = load_study(file)
    assert (study.repetitions, study.first_seed, study.baseline.name) == (20, 0, "a")
    assert (study.metrics, study.reference_front, str(study.folder)) == ({}, None, "outputs/studies/demo")
    assert study.canonical["quick"] is None


def test_label_is_the_name_in_words_unless_given(tmp_path):
    study = loaded(tmp_path, variants={"no_prior": A, "b": {**A, "label": "with a prior"}})
    assert [variant.label for variant in study.variants] == ["no prior", "with a prior"]


def test_runs_begin_with_the_first_repetition_of_every_variant(tmp_path):
    study = loaded(tmp_path, first_seed=9)
    assert [str(run) for run in study.runs()] == ["a/09", "b/09", "a/10", "b/10"]
    assert [run.seed for run in study.runs()] == [9, 9, 10, 10]


def test_folders_keep_their_names_when_there_are_more_than_a_hundred_repetitions(tmp_path):
    file = write_study(tmp_path)
    few, many = ([run.folder for run in load_study(file, repetitions=n).runs()] for n in (2, 101))
    assert many[: len(few)] == few
    assert many[-1].name == "100"


@pytest.mark.parametrize(
    ("without", "is_quick", "overrides", "budget"),
    [
        pytest.param((), True, ["budget.evaluations=9"], 9, id="command line over all"),
        pytest.param((), True, [], 5, id="quick form over variant"),
        pytest.param((), False, [], 3, id="variant over study"),
        pytest.param(("quick", "variant"), True, [], 2, id="study over scenario"),
        pytest.param(("study", "quick", "variant"), False, [], 4, id="scenario"),
    ],
)
def test_narrower_changes_win(tmp_path, without, is_quick, overrides, budget):
    study = load_study(with_sets(tmp_path, without), is_quick=is_quick, overrides=overrides)
    assert study.variants[0].effective.budget.evaluations == budget


def test_quick_form_has_a_name_a_folder_and_repetitions_of_its_own(tmp_path):
    study = load_study(write_study(tmp_path, output="there/"), is_quick=True)
    assert (study.name, str(study.folder), study.repetitions) == ("demo_quick", "there_quick", 2)  # of 2, not 3
    assert load_study(write_study(tmp_path, repetitions=9), is_quick=True).repetitions == 3
    file = write_study(tmp_path, output=None, quick={"repetitions": 2})
    assert str(load_study(file, is_quick=True).folder) == "outputs/studies/demo_quick"
    assert load_study(file, is_quick=True, repetitions=7, output="x").canonical["output"] == "x"


def test_null_takes_a_key_back_to_its_default(tmp_path):
    study = loaded(tmp_path, set={"design_of_experiment.number_of_samples": None})
    assert study.variants[0].effective.design.number_of_samples == 6


def test_only_keeps_the_baseline_and_the_order(tmp_path):
    variants = dict.fromkeys("abcd", A)
    study = load_study(write_study(tmp_path, variants=variants, baseline="b"), only=["c", "a"])
    assert [variant.name for variant in study.variants] == ["a", "b", "c"]
    study = load_study(write_study(tmp_path, variants=variants, baseline="b"), only=["d"])
    assert [variant.name for variant in study.variants] == ["b", "d"]


def test_scenarios_are_found_beside_the_study_from_anywhere(tmp_path, monkeypatch):
    file = write_study(tmp_path / "one")
    (tmp_path / "one" / "scenario.json").rename(tmp_path / "moved.json")
    document = json.loads(file.read_text())
    document["variants"] = {"a": {"scenario": "../moved.json"}}
    file.write_text(json.dumps(document))
    monkeypatch.chdir("/")
    assert load_study(file).variants[0].effective.application_name == "demo"


def test_run_is_the_scenario_with_its_seed_and_folder(tmp_path):
    *_, run = loaded(tmp_path, first_seed=4).runs()
    assert run.overrides[-2:] == ("seed=5", f'output.directory="{tmp_path}/out/runs/b/05"')
    assert run.canonical["seed"] == 5
    assert run.canonical["output"]["directory"] == str(run.folder)
    assert run.canonical["acquisition"]["type"] == "thompson_sampling"


def test_run_ends_when_a_small_space_is_exhausted(tmp_path):
    space = {"x": {"parameter_type": "integer", "values": [0, 2]}}
    study = loaded(tmp_path, scenario={"budget": {"evaluations": 9}})
    assert study.variants[0].n_evaluations == 9
    path = tmp_path / "scenario.json"
    path.write_text(json.dumps({**json.loads(path.read_text()), "input_parameters": space}))
    assert load_study(tmp_path / "study.json").variants[0].n_evaluations == 3


BAD = {
    "unknown key": ({"variant": {"a": A}}, ["$.variant: unknown key", "Did you mean 'variants'?"]),
    "unknown key of a variant": ({"variants": {"a": {"scenarios": "x"}}}, ["$.variants.a.scenarios: unknown key"]),
    "no variants": ({"variants": {}}, ["$.variants: {} is empty", "at least one entry"]),
    "bad name": ({"variants": {"a/b": A}}, ["$.variants", '"a/b" is not of the right form', "letters, digits"]),
    "missing file": (
        {"variants": {"a": {"scenario": "scenari.json"}}},
        ['$.variants.a.scenario: there is no file "scenari.json"', "Did you mean 'scenario.json'?"],
    ),
    "unknown baseline": ({"baseline": "aa"}, ["$.baseline: there is no variant 'aa'", "allowed: a, b"]),
    "seed in set": ({"set": {"seed": 3}}, ["$.set.seed: a study sets this", "See first_seed."]),
    "output in a variant": (
        {"variants": {"a": {**A, "set": {"output": {"directory": "x"}}}}},
        ["$.variants.a.set.output: a study sets this", "See the study's output."],
    ),
    "directory in set": ({"set": {"output.directory": "x"}}, ["$.set.output.directory: a study sets this"]),
    "unknown key in set": (
        {"set": {"budget.evaluatons": 3}},
        ["$.set: $.budget.evaluatons: unknown key", "Did you mean 'evaluations'?"],
    ),
    "impossible value in a variant": (
        {"variants": {"a": {**A, "set": {"budget.evaluations": 0}}}},
        ["$.variants.a.set: $.budget.evaluations: 0 is too small", "an integer >= 1"],
    ),
    "other objectives": (
        {"variants": {"a": A, "b": {**A, "set": {"objectives": [{"name": "f"}]}}}},
        ["$.variants.b: its objectives are f (minimize); those of 'a' are f (minimize), g (minimize)"],
    ),
    "other reference point": (
        {"variants": {"a": A, "b": {**A, "set": {"objectives.1.reference_point": 3}}}},
        ["$.variants.b: its objectives are f (minimize), g (minimize, reference point 3); those of 'a' are"],
    ),
    "time limit": ({"set": {"budget.minutes": 2}}, ["$.variants.a: its runs would end after 2 minutes", "null"]),
    "client": (
        {"variants": {"a": {**A, "set": {"evaluator": "client_server"}}}},
        ["$.variants.a: its runs would each need a client of their own", "an evaluator that a study can call"],
    ),
    "same label": (
        {"variants": {"a": {**A, "label": "b"}, "b": A}},
        ["$.variants.b.label: 'a' has the label 'b' too"],
    ),
    "no repetitions": ({"repetitions": 0}, ["$.repetitions: 0 is too small", "an integer >= 1"]),
    "no quick repetitions": ({"quick": {"repetitions": 0}}, ["$.quick.repetitions: 0 is too small"]),
    "unknown sum": ({"metrics": {"noise": "median"}}, ['$.metrics.noise: unknown value "median"', "mean, sum, max"]),
    "name with a slash": ({"name": "a/b"}, ["$.name", "a name without slashes"]),
}
"""Studies that must not run: what is wrong with each, and what the message says."""


@pytest.mark.parametrize(("keys", "says"), BAD.values(), ids=BAD)
def test_mistake_is_named_with_file_and_place(tmp_path, capsys, keys, says):
    file = write_study(tmp_path, **keys)
    assert main(["study", str(file)]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"error: {file}: {says[0].partition(':')[0]}")
    assert [text for text in says if text not in error] == []
    assert len(error.splitlines()) <= 8
    assert not (tmp_path / "out").exists()


def test_mistake_in_a_scenario_is_named_with_the_file_of_the_scenario(tmp_path, capsys):
    file = write_study(tmp_path, scenario={"budget": {"evaluations": 0}})
    assert main(["study", str(file)]) == 2
    assert capsys.readouterr().err.startswith(f"error: {tmp_path}/scenario.json: $.budget.evaluations: 0 is too small")


@pytest.mark.parametrize("override", ["seed=3", "output.directory=x", " seed =3"])
def test_seed_and_folder_cannot_be_set_on_the_command_line_either(tmp_path, override):
    with pytest.raises(ScenarioError, match="a study sets this for each run itself"):
        load_study(write_study(tmp_path), overrides=[override])


def test_mistake_on_the_command_line_is_named_as_such(tmp_path, capsys):
    file = write_study(tmp_path, variants=TWO, set={"budget.evaluations": 3})
    assert main(["study", str(file), "--set", "budget.evaluations=0"]) == 2
    assert capsys.readouterr().err.startswith("error: --set budget.evaluations=0: $.budget.evaluations: 0 is too small")
    assert main(["study", str(file), "--only", "aa"]) == 2
    assert "--only: there is no variant 'aa'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        pytest.param('{"name": "demo",}', "{file}:1:16: broken JSON in line 1, column 16", id="broken JSON"),
        pytest.param("", "{file}: the file is empty", id="empty"),
        pytest.param("[]", "{file}: $: the file holds a list", id="list"),
        pytest.param(None, "{file}: there is no such file\n  hint: Did you mean 'scenario.json'?", id="no file"),
    ],
)
def test_file_that_is_no_study_is_named_once(tmp_path, capsys, text, message):
    write_study(tmp_path)
    file = tmp_path / "scenarios.json"
    if text is not None:
        file.write_text(text)
    assert main(["study", str(file)]) == 2
    assert capsys.readouterr().err.startswith("error: " + message.format(file=file))


def test_runs_of_a_study_do_not_share_a_samples_file(tmp_path):
    study = loaded(tmp_path, set={"output.samples_file": "all.csv"})
    for run in study.runs():
        assert load_scenario(run.variant.scenario, overrides=run.overrides).output.samples_file is None
        assert run.canonical["output"]["samples_file"] is None
