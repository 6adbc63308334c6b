"""Tests for render.py: files are read back; pictures are small."""

import sys

import av
import numpy as np
import pytest
from PIL import Image

from robot_tasks.errors import GraphicsError, MissingPackageError, OptionError, SimulationError, UnknownNameError
from robot_tasks.evaluation import evaluate
from robot_tasks.offscreen import OffScreen, View
from robot_tasks.render import CAPTION_LINES, COLUMNS, GAP, outcome, render_clip, render_strip
from robot_tasks.simulation import Simulation
from robot_tasks.tasks import TASKS
from tests.robot_tasks.conftest import OPERATOR_MEANS

SMALL = View(width=96, height=64)
TASK = "obstacle_avoidance"
SECONDS = TASKS[TASK].duration
every_task = pytest.mark.parametrize("task", TASKS.values(), ids=TASKS)


@pytest.fixture(scope="module")
def _graphics():
    try:
        OffScreen(Simulation.from_scene(TASKS[TASK].scene), SMALL).close()
    except GraphicsError as error:
        pytest.skip(str(error))


needs_graphics = pytest.mark.usefixtures("_graphics")


def read_clip(path):
    """Return the video stream's numbers and its frames, shape (n, height, width, 3)."""
    with av.open(str(path)) as clip:
        stream = clip.streams.video[0]
        frames = np.stack([frame.to_ndarray(format="rgb24") for frame in clip.decode(stream)]).astype(float)
        return stream, float(stream.average_rate), float(clip.duration / av.time_base), frames


@needs_graphics
def test_a_clip_has_the_length_of_the_episode_and_the_size_and_rate_asked_for(tmp_path):
    render_clip(TASK, OPERATOR_MEANS, tmp_path / "clip.mp4", view=SMALL, fps=2)
    stream, fps, seconds, frames = read_clip(tmp_path / "clip.mp4")
    assert (stream.codec_context.name, stream.codec_context.pix_fmt) == ("h264", "yuv420p")
    assert frames.shape == (2 * SECONDS, 64, 96, 3)
    assert (fps, seconds) == (2.0, SECONDS)


@needs_graphics
def test_a_clip_moves_until_the_arm_stands_still_and_holds_the_last_frame(tmp_path):
    numbers = render_clip(TASK, OPERATOR_MEANS, tmp_path / "clip.mp4", view=SMALL, fps=2)
    *_, frames = read_clip(tmp_path / "clip.mp4")
    still = round(2 * numbers["simulated_seconds"])
    assert still < len(frames) - 1
    assert np.abs(frames[6] - frames[0]).mean() > 3.0
    assert np.abs(frames[-1] - frames[still + 1]).mean() < 1.0


@needs_graphics
@pytest.mark.parametrize(("speed", "n_frames"), [(4.0, 6), (0.5, 48)])
def test_speed_changes_the_length_of_a_clip_and_not_its_rate(tmp_path, speed, n_frames):
    render_clip(TASK, OPERATOR_MEANS, tmp_path / "clip.mp4", view=SMALL, fps=2, speed=speed)
    _, fps, seconds, frames = read_clip(tmp_path / "clip.mp4")
    assert (len(frames), fps, seconds) == (n_frames, 2.0, SECONDS / speed)


@needs_graphics
@pytest.mark.parametrize(
    ("frames", "columns", "rows"), [(1, 1, 1), (2, 2, 1), (4, 2, 2), (5, 3, 2), (6, COLUMNS, 2), (7, 3, 3)]
)
def test_a_strip_has_its_frames_in_rows_and_room_for_a_caption(tmp_path, frames, columns, rows):
    render_strip(TASK, OPERATOR_MEANS, tmp_path / "strip.png", view=SMALL, frames=frames)
    with Image.open(tmp_path / "strip.png") as strip:
        assert strip.size == (columns * (96 + GAP) - GAP, rows * (64 + GAP) + CAPTION_LINES * 10)


@needs_graphics
def test_a_strip_shows_the_start_the_end_and_something_between(tmp_path):
    render_strip(TASK, OPERATOR_MEANS, tmp_path / "strip.png", view=SMALL, frames=3)
    with Image.open(tmp_path / "strip.png") as strip:
        pixels = np.asarray(strip, dtype=float)
    start, middle, end = (pixels[20:64, x : x + 96] for x in (0, 96 + GAP, 2 * (96 + GAP)))
    assert np.abs(middle - start).mean() > 3.0
    assert np.abs(end - middle).mean() > 3.0


@needs_graphics
@every_task
def test_every_task_can_be_seen_and_gives_the_numbers_of_an_evaluation(tmp_path, task):
    middle = {parameter.name: (parameter.low + parameter.high) / 2 for parameter in task.parameters}
    numbers = render_strip(task.name, middle, tmp_path / "strip.png", seed=3, view=SMALL, frames=2)
    assert numbers == evaluate(task.name, middle, seed=3)
    with Image.open(tmp_path / "strip.png") as strip:
        assert np.asarray(strip)[20:64].std() > 20.0


@needs_graphics
def test_the_published_code_can_be_rendered(tmp_path):
    numbers = render_strip(TASK, OPERATOR_MEANS, tmp_path / "strip.png", variant="published_code", view=SMALL, frames=1)
    assert numbers == evaluate(TASK, OPERATOR_MEANS, variant="published_code")


@needs_graphics
def test_frames_come_top_row_first():
    with OffScreen(Simulation.from_scene(TASKS[TASK].scene), SMALL) as screen:
        pixels = screen.draw()
    assert pixels.shape == (64, 96, 3)
    red, green, blue = pixels[0].mean(axis=0)  # sky
    assert blue > green > red > 150


@needs_graphics
@every_task
def test_an_unknown_camera_lists_those_of_the_scene(tmp_path, task):
    middle = {parameter.name: (parameter.low + parameter.high) / 2 for parameter in task.parameters}
    with pytest.raises(UnknownNameError, match=r"unknown camera 'top'\. Known: .*front"):
        render_clip(task.name, middle, tmp_path / "clip.mp4", view=View(camera="top"))


@needs_graphics
def test_a_rollout_that_breaks_down_leaves_no_file(tmp_path, monkeypatch):
    monkeypatch.setattr("robot_tasks.contacts.DEEPEST_OVERLAP", 0.0)
    with pytest.raises(SimulationError):
        render_clip(TASK, OPERATOR_MEANS | {"mp3_threshold": 1.5}, tmp_path / "clip.mp4", view=SMALL, fps=1)
    assert list(tmp_path.iterdir()) == []


def test_the_outcome_is_one_line_of_objectives_and_success():
    numbers = {"performance": 2969.04, "safety": -1155.26, "success": 1.0, "time_to_success": 6.86}
    assert outcome(TASKS[TASK], numbers) == "performance 2969.0, safety -1155.3; success after 6.86 s"
    assert outcome(TASKS[TASK], numbers | {"success": 0.0}) == "performance 2969.0, safety -1155.3; no success"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        pytest.param({"fps": 0}, r"fps: got 0\. Give a number of frames per second from 1 to 60\.", id="fps"),
        pytest.param({"speed": 0.0}, r"speed: got 0\. Give a factor from 0\.05 to 50\.", id="speed"),
        pytest.param({"speed": float("nan")}, "speed: got nan", id="speed not a number"),
        pytest.param({"view": View(width=97)}, r"got 97 x 360\. Give even numbers, for a clip", id="odd size"),
    ],
)
def test_options_of_a_clip_are_checked_before_anything_runs(tmp_path, options, message):
    with pytest.raises(OptionError, match=message):
        render_clip("no such task", {}, tmp_path / "clip.mp4", **options)


def test_options_of_a_strip_are_checked_before_anything_runs(tmp_path):
    with pytest.raises(OptionError, match=r"frames: got 0\. Give a number from 1 to 60\."):
        render_strip("no such task", {}, tmp_path / "strip.png", frames=0)


@pytest.mark.parametrize("function", [render_clip, render_strip])
@pytest.mark.parametrize(
    ("name", "message"),
    [("clip.gif", r"Give a file that ends in \.mp4 for a clip or in \.png"), ("no/clip", "a file that ends in")],
)
def test_the_ending_of_a_file_says_what_it_is_to_be(tmp_path, function, name, message):
    with pytest.raises(OptionError, match=message):
        function(TASK, OPERATOR_MEANS, tmp_path / name)


def test_a_file_needs_a_folder(tmp_path):
    with pytest.raises(OptionError, match="Give a file in a folder that exists"):
        render_clip(TASK, OPERATOR_MEANS, tmp_path / "no" / "clip.mp4")


@pytest.mark.parametrize("size", [{"width": 15}, {"height": 2161}])
def test_a_view_has_a_reasonable_size(size):
    with pytest.raises(OptionError, match="Give a number of pixels from 16 to 2160"):
        View(**size)


@pytest.mark.parametrize(("function", "name"), [(render_clip, "clip.mp4"), (render_strip, "strip.png")])
def test_a_missing_package_is_an_error_that_says_how_to_install_it(tmp_path, monkeypatch, function, name):
    for module in ("av", "PIL.Image"):
        monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(MissingPackageError, match=r"pip install 'hypermap-lite\[robot\]'"):
        function(TASK, OPERATOR_MEANS, tmp_path / name)
