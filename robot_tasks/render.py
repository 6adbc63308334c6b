"""Clips and strips of rollouts, drawn off the screen: no display and no graphics card needed.

The rollout is that of `robot_tasks.evaluation.evaluate`, watched at every tick; the numbers are the same.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from importlib import import_module
from io import BytesIO
from math import ceil
from pathlib import Path
from types import ModuleType, TracebackType
from typing import Any, Final, Self

import numpy as np

from robot_tasks.episode import Episode
from robot_tasks.errors import MissingPackageError, OptionError
from robot_tasks.evaluation import PAPER, find_task, load, measure
from robot_tasks.offscreen import OffScreen, Pixels, View
from robot_tasks.rollout import rollout
from robot_tasks.simulation import TICK
from robot_tasks.tasks import Task

HIGHEST_FPS: Final = 60
"""Frames per second; the arm is drawn where it was at the nearest tick of 20 ms."""
SPEEDS: Final = (0.05, 50.0)
"""How much faster than life a clip may run, lowest and highest."""
MOST_FRAMES: Final = 60
"""Frames of a strip."""
COLUMNS: Final = 3
"""Frames of a strip beside each other, at most."""
GAP: Final = 4
"""Pixels between the frames of a strip."""
CAPTION_LINES: Final = 2
"""Height of the caption below a strip, in heights of its font."""

_ENCODER: Final = {"preset": "veryfast", "crf": "23"}
"""40 % more work than `ultrafast`, for a fifth of the bytes."""

FRONT: Final = View()


def render_clip(
    task_name: str,
    configuration: Mapping[str, float],
    path: Path,
    *,
    seed: int = 0,
    variant: str = PAPER,
    view: View = FRONT,
    fps: int = 20,
    speed: float = 1.0,
) -> dict[str, float]:
    """Write a clip of one rollout: H.264 in an MP4 file, always of the episode's full length.

    Parameters
    ----------
    task_name, configuration, seed, variant
        As for `evaluate`.
    path
        File to write; ends in ``.mp4``.
    view
        Camera and size. H.264 wants both sides even.
    fps
        Frames per second, up to `HIGHEST_FPS`.
    speed
        How much faster than life the clip runs; below 1 is slow motion.

    Returns
    -------
    dict
        What `evaluate` returns.

    Raises
    ------
    OptionError
        If an option is out of range.
    UnknownNameError
        If there is no such task or camera.
    ParameterError
        If the configuration does not fit the task.
    SimulationError
        If the physics broke down; no file is written.
    GraphicsError
        If there is no OpenGL.
    MissingPackageError
        If PyAV is not installed.
    """
    _check_path(path, ".mp4")
    _check_clip(view, fps, speed)
    take = _Take(task_name, configuration, seed, variant)
    n_frames = max(1, round(take.task.duration / speed * fps))
    times = [frame * speed / fps for frame in range(n_frames)]
    with _Encoder(view, fps) as encoder:
        episode = take.film(view, times, encoder.add)
    path.write_bytes(encoder.content)
    return measure(take.task, episode)


def render_strip(
    task_name: str,
    configuration: Mapping[str, float],
    path: Path,
    *,
    seed: int = 0,
    variant: str = PAPER,
    view: View = FRONT,
    frames: int = 6,
) -> dict[str, float]:
    """Write a picture of one rollout: frames with their times, in rows, and the outcome below.

    Parameters
    ----------
    task_name, configuration, seed, variant
        As for `evaluate`.
    path
        File to write; ends in ``.png``.
    view
        Camera and size of each frame.
    frames
        Number of frames, evenly spaced from the start to the time after which nothing moves.

    Returns
    -------
    dict
        What `evaluate` returns.

    Raises
    ------
    OptionError, UnknownNameError, ParameterError, SimulationError, GraphicsError, MissingPackageError
        As for `render_clip`; here the package is Pillow.
    """
    _check_path(path, ".png")
    if not 1 <= frames <= MOST_FRAMES:
        raise OptionError("frames", frames, f"a number from 1 to {MOST_FRAMES}")
    _package("PIL.Image", "pillow")  # better missed now than after the rollout
    take = _Take(task_name, configuration, seed, variant)
    times = np.linspace(0.0, take.run().simulated_seconds, frames).tolist()
    pictures: list[Pixels] = []
    episode = take.film(view, times, lambda pixels, count: pictures.extend([pixels] * count))
    numbers = measure(take.task, episode)
    _strip(pictures, [f"{time:.1f} s" for time in times], outcome(take.task, numbers)).save(path)
    return numbers


def outcome(task: Task, numbers: Mapping[str, float]) -> str:
    """Tell objectives and success in one line."""
    objectives = ", ".join(f"{name} {numbers[name]:.1f}" for name in task.objectives)
    success = f"success after {numbers['time_to_success']:.2f} s" if numbers["success"] else "no success"
    return f"{objectives}; {success}"


class _Take:
    """A rollout to film, as often as one likes: equal rollouts give the same bits."""

    def __init__(self, task_name: str, configuration: Mapping[str, float], seed: int, variant: str) -> None:
        self.task = find_task(task_name, variant)
        self._parameters = self.task.check(configuration)
        self._variation = self.task.randomization.sample(np.random.default_rng(seed))
        self._simulation = load(self.task)

    def run(self, on_tick: Callable[[float], None] | None = None) -> Episode:
        """Run the rollout."""
        return rollout(self.task, self._parameters, self._variation, self._simulation, on_tick=on_tick)

    def film(self, view: View, times: Sequence[float], keep: Callable[[Pixels, int], None]) -> Episode:
        """Run the rollout and hand over the frame of each time in [s], and for how many times in a row it stands."""
        with OffScreen(self._simulation, view) as screen:
            shutter = _Shutter(screen, times, keep)
            episode = self.run(shutter.tick)
            shutter.hold()
        return episode


class _Shutter:
    """Take a frame at the ticks nearest to given times."""

    def __init__(self, screen: OffScreen, times: Sequence[float], keep: Callable[[Pixels, int], None]) -> None:
        self._screen = screen
        self._times = times
        self._keep = keep
        self._n_kept = 0

    def tick(self, time: float) -> None:
        """Take the frames that are due at a tick."""
        self._take_up_to(bisect_right(self._times, time + 0.5 * TICK))

    def hold(self) -> None:
        """Fill what an early end leaves with the frame of the end."""
        self._take_up_to(len(self._times))

    def _take_up_to(self, n_due: int) -> None:
        if n_due > self._n_kept:
            self._keep(self._screen.draw(), n_due - self._n_kept)
            self._n_kept = n_due


class _Encoder:
    """An MP4 file in memory, so that a rollout that breaks down leaves no half-written file."""

    def __init__(self, view: View, fps: int) -> None:
        self._av = _package("av", "av")
        self._file = BytesIO()
        self._output = self._av.open(self._file, "w", format="mp4")
        self._stream = self._output.add_stream("libx264", rate=fps, options=_ENCODER)
        self._stream.width, self._stream.height, self._stream.pix_fmt = view.width, view.height, "yuv420p"
        self._stream.codec_context.thread_count = 1  # the frames are small: threads would cost more than they bring
        self._time_base = Fraction(1, fps)
        self._n_frames = 0

    @property
    def content(self) -> bytes:
        """The finished file."""
        return self._file.getvalue()

    def add(self, pixels: Pixels, count: int) -> None:
        """Append a frame, several times over if it stands still."""
        frame = self._av.VideoFrame.from_ndarray(pixels, format="rgb24").reformat(format="yuv420p")
        frame.time_base = self._time_base
        for _ in range(count):
            frame.pts = self._n_frames
            self._output.mux(self._stream.encode(frame))
            self._n_frames += 1

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._output.mux(self._stream.encode(None))
        self._output.close()


def _check_path(path: Path, ending: str) -> None:
    if path.suffix.lower() != ending:
        raise OptionError("output", path, "a file that ends in .mp4 for a clip or in .png for a strip of frames")
    if not path.parent.is_dir():
        raise OptionError("output", path, "a file in a folder that exists")


def _check_clip(view: View, fps: int, speed: float) -> None:
    if view.width % 2 or view.height % 2:
        raise OptionError("width and height", f"{view.width} x {view.height}", "even numbers, for a clip")
    if not 1 <= fps <= HIGHEST_FPS:
        raise OptionError("fps", fps, f"a number of frames per second from 1 to {HIGHEST_FPS}")
    slowest, fastest = SPEEDS
    if not slowest <= speed <= fastest:
        raise OptionError("speed", f"{speed:g}", f"a factor from {slowest:g} to {fastest:g}")


def _strip(frames: Sequence[Pixels], labels: Sequence[str], caption: str) -> Any:
    """Arrange labelled frames in rows, with a caption below, as a Pillow image."""
    image, drawing = _package("PIL.Image", "pillow"), _package("PIL.ImageDraw", "pillow")
    height, width, _ = frames[0].shape
    font = _package("PIL.ImageFont", "pillow").load_default(max(10, height // 22))
    n_rows = ceil(len(frames) / COLUMNS)
    n_columns = ceil(len(frames) / n_rows)
    bottom = n_rows * (height + GAP)
    strip = image.new("RGB", (n_columns * (width + GAP) - GAP, bottom + CAPTION_LINES * font.size), "white")
    pen = drawing.Draw(strip)
    for position, (frame, label) in enumerate(zip(frames, labels, strict=True)):
        row, column = divmod(position, n_columns)
        x, y = column * (width + GAP), row * (height + GAP)
        strip.paste(image.fromarray(frame), (x, y))
        pen.text((x + GAP, y + GAP), label, fill="black", stroke_width=1, stroke_fill="white", font=font)
    pen.text((GAP, bottom), caption, fill="black", font=font)
    return strip


def _package(module: str, package: str) -> ModuleType:
    """Import what only pictures need."""
    try:
        return import_module(module)
    except ImportError as error:
        raise MissingPackageError(package) from error
