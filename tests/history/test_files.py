"""Tests for files.py."""

import resource
import subprocess
import sys

import pytest

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.files import append_durably, encode, make_folder, truncate, write_atomically


def test_atomic_write_replaces_the_whole_file_and_leaves_nothing_else(tmp_path):
    path = tmp_path / "a.csv"
    write_atomically(path, "long old content\n")
    write_atomically(path, "new\n")
    assert path.read_text() == "new\n"
    assert [p.name for p in tmp_path.iterdir()] == ["a.csv"]


def test_failed_write_keeps_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "a.csv"
    write_atomically(path, "old\n")
    monkeypatch.setattr("os.fsync", lambda descriptor: (_ for _ in ()).throw(OSError(28, "No space left on device")))
    with pytest.raises(RunFolderError, match=r"a.csv: cannot be written: No space left on device(.|\n)*hint: Free"):
        write_atomically(path, "new\n")
    assert path.read_text() == "old\n"
    assert [p.name for p in tmp_path.iterdir()] == ["a.csv"]


def test_appended_text_follows_what_is_there(tmp_path):
    path = tmp_path / "a.csv"
    append_durably(path, "1\n")
    append_durably(path, "2\n")
    assert path.read_text() == "1\n2\n"


def test_full_disk_is_an_error_that_names_the_file(tmp_path):
    limit = 4096
    code = (
        "from pathlib import Path; from hypermap_lite.errors import RunFolderError\n"
        "from hypermap_lite.history.files import append_durably\n"
        f"try: append_durably(Path({str(tmp_path / 'a.csv')!r}), 'x' * {limit + 1})\n"
        "except RunFolderError as error: print(error)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
        capture_output=True,
        text=True,
        check=True,
    )
    assert "a.csv: cannot be written: File too large" in done.stdout
    assert (tmp_path / "a.csv").stat().st_size == limit


def test_folder_below_a_file_is_an_error(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(RunFolderError, match="cannot be written: Not a directory"):
        make_folder(tmp_path / "file" / "run")


def test_folder_is_made_with_its_parents(tmp_path):
    make_folder(tmp_path / "a" / "b")
    make_folder(tmp_path / "a" / "b")
    assert (tmp_path / "a" / "b").is_dir()


def test_truncated_file_keeps_its_beginning(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("1\n2")
    truncate(path, 2)
    assert path.read_text() == "1\n"


def test_half_a_surrogate_pair_is_spelt_out():
    assert encode("ü\ud800") == "ü\\ud800".encode()
