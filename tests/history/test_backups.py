"""Tests for backups.py."""

import pytest

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.backups import keep_copies, set_aside
from hypermap_lite.history.lock import FolderLock
from tests.history.examples import evaluation, folder


def test_old_folder_is_kept_under_another_name(tmp_path):
    for _ in range(2):
        with folder(tmp_path / "run") as run:
            run.append_evaluation(evaluation(0))
        set_aside(tmp_path / "run")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["run.bak-1", "run.bak-2"]
    assert (tmp_path / "run.bak-2" / "history.csv").exists()


def test_nothing_is_set_aside_where_there_is_nothing(tmp_path):
    assert set_aside(tmp_path / "run") is None


def test_folder_in_use_is_not_set_aside(tmp_path):
    with FolderLock(tmp_path / "run"), pytest.raises(RunFolderError, match="another process"):
        set_aside(tmp_path / "run")


def test_folder_that_is_no_run_is_not_renamed(tmp_path):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter.tex").write_text("")
    with pytest.raises(RunFolderError, match=r"not a run folder: it holds chapter\.tex"):
        set_aside(tmp_path / "thesis")
    assert sorted(p.name for p in (tmp_path / "thesis").iterdir()) == ["chapter.tex"]


def test_empty_folder_is_used_as_it_is(tmp_path):
    assert set_aside(tmp_path) is None
    assert tmp_path.exists()


def test_folder_of_a_run_that_never_began_is_renamed(tmp_path):
    with FolderLock(tmp_path / "run"):
        pass
    assert set_aside(tmp_path / "run") == tmp_path / "run.bak-1"


@pytest.mark.parametrize("name", [".", "../run", "../run/"])
def test_working_directory_is_not_renamed(tmp_path, monkeypatch, name):
    with folder(tmp_path / "run"):
        pass
    monkeypatch.chdir(tmp_path / "run")
    with pytest.raises(RunFolderError, match=r"cannot be set aside, since .* is in it"):
        set_aside(name)


def test_needed_folder_is_not_renamed(tmp_path):
    with folder(tmp_path / "run"):
        pass
    with pytest.raises(RunFolderError, match="cannot be set aside"):
        set_aside(tmp_path / "run", needed=[tmp_path / "run" / "scenarios"])


def test_link_is_renamed_and_not_its_target(tmp_path):
    with folder(tmp_path / "disk"):
        pass
    (tmp_path / "run").symlink_to(tmp_path / "disk")
    assert set_aside(tmp_path / "run").is_symlink()
    assert (tmp_path / "disk" / "scenario.json").exists()


def test_copies_share_the_first_number_that_is_free(tmp_path):
    paths = [tmp_path / "a", tmp_path / "b", tmp_path / "absent"]
    for path in paths[:2]:
        path.write_text(path.name)
    (tmp_path / "b.bak-1").write_text("older")
    assert keep_copies(paths) == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a", "a.bak-2", "b", "b.bak-1", "b.bak-2"]
    assert (tmp_path / "b.bak-2").read_text() == "b"
