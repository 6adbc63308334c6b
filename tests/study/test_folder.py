"""Tests for folder.py."""

import json

import pytest

from hypermap_lite.cli import main
from hypermap_lite.cli.plot import expand_runs
from hypermap_lite.errors import RunFolderError
from hypermap_lite.study.folder import is_study, labelled_runs
from tests.plotting.run_folders import write_run

Y = [[1.0, 2.0], [2.0, 1.0]]


@pytest.fixture
def study(tmp_path):
    folder = tmp_path / "study"
    for variant, seed, n_rows in (
        ("b", "100", 2),
        ("b", "11", 2),
        ("a_prior", "12", 2),
        ("a_prior", "13", 1),
        ("b", "101", 2),
    ):
        run = write_run(folder / "runs" / variant / seed, Y[:n_rows])
        (run / "pareto.csv").write_bytes((run / "history.csv").read_bytes())
    variants = {"b": {"label": "the other", "evaluations": 2}, "a_prior": {"label": None, "evaluations": 2}}
    content = {"variants": variants, "first_seed": 11, "repetitions": 90}
    (folder / "study.json").write_text(json.dumps(content))
    return folder


def test_finished_runs_are_listed_by_variant_and_seed_under_their_labels(study):
    runs = study / "runs"
    expected = [("the other", runs / "b/11"), ("the other", runs / "b/100"), ("a prior", runs / "a_prior/12")]
    assert labelled_runs(study) == expected


def test_run_folder_is_no_study(study):
    assert is_study(study)
    assert not is_study(study / "runs" / "b" / "11")


def test_pictures_take_a_study_for_its_runs(study):
    run = study / "runs" / "b" / "11"
    folders, labels = expand_runs([str(study), f"mine={run}"], None)
    assert labels == [*[f"study: {label}" for label in ("the other", "the other", "a prior")], "mine"]
    assert folders[-1] == run
    assert expand_runs([str(study)], None)[1] == ["the other", "the other", "a prior"]
    assert expand_runs([str(study)], ["new"])[1] == ["new: the other", "new: the other", "new: a prior"]


def test_picture_of_one_study_goes_into_its_folder(study, capsys):
    assert main(["plot", "pareto", str(study), "-q"]) == 0
    assert capsys.readouterr().out.split() == [str(study / "pareto.png"), str(study / "pareto.pdf")]


def test_study_without_a_finished_run_says_so(study):
    for history in study.glob("runs/*/*/history.csv"):
        history.unlink()
    with pytest.raises(RunFolderError, match="no run of this study is finished yet"):
        labelled_runs(study)


def test_broken_study_file_is_named(study):
    (study / "study.json").write_text("{")
    with pytest.raises(RunFolderError, match=r"study\.json: cannot be read as a study"):
        labelled_runs(study)
