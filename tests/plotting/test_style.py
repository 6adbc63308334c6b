"""Tests for style.py."""

from pathlib import Path

import matplotlib as mpl
import pytest

from hypermap_lite.errors import UsageError
from hypermap_lite.objectives import Goal, Objective
from hypermap_lite.plotting import style
from hypermap_lite.plotting.runs import load_runs
from tests.plotting.run_folders import write_run


@pytest.fixture
def figure():
    with style.house_style():
        yield style.new_figure(4, 3)


def test_style_ends_with_its_block_and_ignores_the_users():
    with mpl.rc_context({"font.size": 30}):
        with style.house_style():
            assert mpl.rcParams["font.size"] == style.SETTINGS["font.size"]
        assert mpl.rcParams["font.size"] == 30


def test_text_is_at_least_ten_points():
    sizes = [value for key, value in style.SETTINGS.items() if key.endswith("size") and "." in key]
    assert min(sizes) >= 10


def test_name_without_ending_becomes_png_and_pdf(figure, tmp_path):
    files = style.save(figure, tmp_path / "new" / "picture.v2")
    assert [f.name for f in files] == ["picture.v2.png", "picture.v2.pdf"]
    assert files[0].read_bytes().startswith(b"\x89PNG")
    assert files[1].read_bytes().startswith(b"%PDF")


def test_ending_chooses_one_format(figure, tmp_path):
    assert [f.name for f in style.save(figure, tmp_path / "picture.pdf")] == ["picture.pdf"]
    assert [f.name for f in tmp_path.iterdir()] == ["picture.pdf"]


def test_equal_pictures_are_equal_files(tmp_path):
    def picture(name):
        with style.house_style():
            figure = style.new_figure(4, 3)
            figure.subplots().plot([1, 2], [3, 4])
            return [f.read_bytes() for f in style.save(figure, tmp_path / name)]

    assert picture("a") == picture("b")


def test_picture_that_cannot_be_written_is_an_error(figure, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(UsageError, match="the picture cannot be written"):
        style.save(figure, tmp_path / "file" / "picture.png")


@pytest.mark.parametrize("name", ["a.svg", "a.csv", "a.JPG"])
def test_other_formats_are_an_error(name):
    with pytest.raises(UsageError, match=r"written as .png or .pdf"):
        style.output_path(name, [], "pareto")


def test_picture_of_one_run_goes_into_its_folder_and_of_several_into_the_working_directory(tmp_path):
    runs = load_runs([write_run(tmp_path / name, [[1, 1]]) for name in "ab"])
    assert style.output_path(None, runs[:1], "pareto") == tmp_path / "a" / "pareto"
    assert style.output_path(None, runs, "pareto") == Path("pareto")
    assert style.output_path("x.png", runs, "pareto") == Path("x.png")


@pytest.mark.parametrize(
    ("given", "names", "shown"),
    [(None, "aa", "a"), (None, "ab", None), ("mine", "ab", "mine"), ("", "aa", None)],
)
def test_title_is_the_given_or_the_common_name(figure, tmp_path, given, names, shown):
    folders = [write_run(tmp_path / str(i), [[1, 1]], name=name) for i, name in enumerate(names)]
    style.set_title(figure, given, load_runs(folders))
    assert (figure.get_suptitle() or None) == shown


@pytest.mark.parametrize("n_entries", [1, 5, 12])
@pytest.mark.parametrize("label", ["a", "a rather long label of an experiment"])
def test_legend_stays_inside_the_picture(n_entries, label):
    with style.house_style():
        figure = style.new_figure(7.2, 5)
        figure.subplots()
        style.add_legend(figure, [style.legend_entry(label, "black", "o") for _ in range(n_entries)])
        figure.canvas.draw()
        box = figure.legends[0].get_window_extent()
    assert box.x0 >= 0
    assert box.x1 <= figure.bbox.width


@pytest.mark.parametrize(
    ("top", "label"), [(5e6, "hypervolume / 10⁶"), (500, "hypervolume"), (2e-5, "hypervolume / 10⁻⁵")]
)
def test_power_of_ten_stands_in_the_label(figure, top, label):
    axes = figure.subplots()
    axes.set_ylim(0, top)
    style.label_with_power(axes, "hypervolume")
    assert axes.get_ylabel() == label


def test_axis_label_points_to_the_better_side():
    assert style.axis_label(Objective(name="f", goal=Goal.MAXIMIZE)).endswith("(larger is better →)")
    assert style.axis_label(Objective(name="f")).endswith("(← smaller is better)")


def test_data_never_overwrites_the_files_of_the_run(tmp_path):
    file = style.save_data(["a", "b"], [[1, 0.1 + 0.2], ["x,y", True]], tmp_path / "pareto.png")
    assert file.name == "pareto_data.csv"
    assert file.read_text() == 'a,b\n1,0.30000000000000004\n"x,y",True\n'


def test_colours_and_markers_repeat_after_the_last():
    assert style.colour(len(style.COLOURS)) == style.colour(0)
    assert style.marker(len(style.MARKERS)) == style.marker(0)
