"""Tests for the table of kinds."""

import subprocess
import sys

import pytest

from hypermap_lite import plotting
from hypermap_lite.errors import UsageError
from tests.plotting.run_folders import write_run


@pytest.mark.parametrize("kind", plotting.KINDS)
def test_every_kind_draws_without_a_display(kind, tmp_path, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    folder = write_run(tmp_path / "run", [[1.0, 2.0], [2.0, 1.0]], n_design=1)
    files = plotting.plot_function(kind)([folder], tmp_path / "picture", title="t", data=True)
    assert [f.name for f in files] == ["picture.png", "picture.pdf", "picture_data.csv"]
    assert all(f.stat().st_size > 0 for f in files)


def test_unknown_kind_is_an_error_with_the_nearest_name():
    with pytest.raises(UsageError, match=r"unknown kind of picture 'paretto'; known: .*Did you mean 'pareto'"):
        plotting.plot_function("paretto")


def test_missing_matplotlib_is_an_error_that_says_what_to_install(monkeypatch):
    monkeypatch.setitem(plotting.KINDS, "missing", "matplotlib_missing:plot")
    monkeypatch.setattr(plotting.importlib, "import_module", _raise_missing)
    with pytest.raises(UsageError, match=r"pip install 'hypermap-lite\[plot\]'"):
        plotting.plot_function("missing")


def _raise_missing(name):
    raise ModuleNotFoundError("No module named 'matplotlib'", name="matplotlib.axes")


def test_importing_the_table_does_not_import_matplotlib():
    code = "import sys, hypermap_lite.plotting, hypermap_lite.plotting.runs; print('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout == "False\n"
