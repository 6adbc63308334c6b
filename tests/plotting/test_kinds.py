"""Tests for the table of kinds."""

import subprocess
import sys

import pytest

from hypermap_lite import plotting
from hypermap_lite.errors import UsageError
from tests.plotting.run_folders import TWO_MAXIMIZED, TWO_PARAMETERS, write_run
from tests.slow import slow_after


def write_run_for(kind, folder, Y):
    """Write a run of two objectives, or of the first one alone if the kind takes no more."""
    options = {"n_design": 1, "parameters": TWO_PARAMETERS}
    if kind == "regret":
        return write_run(folder, [y[:1] for y in Y], objectives=TWO_MAXIMIZED[:1], **options)
    return write_run(folder, Y, **options)


@pytest.mark.parametrize("kind", plotting.KINDS)
def test_every_kind_draws_without_a_display(kind, tmp_path, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    folder = write_run_for(kind, tmp_path / "run", [[1.0, 2.0], [2.0, 1.0]])
    files = plotting.plot_function(kind)([folder], tmp_path / "picture", title="t", data=True)
    assert [f.name for f in files] == ["picture.png", "picture.pdf", "picture_data.csv"]
    assert all(f.stat().st_size > 0 for f in files)


def test_unknown_kind_is_an_error_with_the_nearest_name():
    with pytest.raises(UsageError, match=r"unknown kind of picture 'paretto'; known: .*Did you mean 'pareto'"):
        plotting.plot_function("paretto")


@pytest.mark.parametrize("kind", [kind for kind in plotting.KINDS if kind not in plotting.KINDS_OF_PARAMETERS])
def test_kinds_without_parameters_refuse_a_choice_of_them(kind):
    with pytest.raises(UsageError, match=f"`plot {kind}` shows no parameters to choose from; parameters, prior do"):
        plotting.plot_function(kind, parameters=["x"])


@pytest.mark.parametrize("kind", plotting.KINDS_OF_PARAMETERS)
def test_kinds_of_parameters_take_a_choice_of_them(kind, tmp_path):
    folder = write_run(tmp_path / "run", [[1.0, 2.0]], parameters=TWO_PARAMETERS)
    *_, file = plotting.plot_function(kind, parameters=["k", "x"])([folder], tmp_path / "p.png", data=True)
    header = file.read_text().splitlines()[0].split(",")
    assert header.index("k") + 1 == header.index("x")


@pytest.mark.parametrize("kind", slow_after(2, plotting.KINDS))
def test_every_kind_draws_equal_files_twice(kind, tmp_path):
    folder = write_run_for(kind, tmp_path / "run", [[1.0, 2.0], [2.0, 1.0], [0.0, 0.0]])
    first, second = (plotting.plot_function(kind)([folder], tmp_path / name, data=True) for name in "ab")
    assert [file.read_bytes() for file in first] == [file.read_bytes() for file in second]


def test_second_picture_in_a_process_is_of_the_second_run(tmp_path):
    first = write_run(tmp_path / "a", [[1.0, 2.0]])
    second = write_run(tmp_path / "b", [[5.0, 6.0]])
    draw = plotting.plot_function("pareto")
    texts = [draw([run], tmp_path / f"{run.name}.png", data=True)[-1].read_text() for run in (first, second)]
    assert [text.splitlines()[1].split(",")[0] for text in texts] == ["a", "b"]


def test_option_of_another_kind_is_refused():
    with pytest.raises(UsageError, match="`plot pareto` has no option 'log'; regret, hypervolume_gap do"):
        plotting.plot_function("pareto", options={"log": True})


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
