"""Clips and strips of rollouts, drawn off the screen: no display and no graphics card needed.

The rollout is that of `robot_tasks.evaluation.evaluate`, watched at every tick; the numbers are the same.
"""

from __future__ import annotations

import os
import sys
from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from importlib import import_module
from io import BytesIO
from math import ceil
from pathlib import Path
from types import ModuleType, TracebackType
from typing import Any, Final, Self, TypeAlias

import mujoco
import numpy as np
from numpy.typing import NDArray

from robot_tasks.episode import Episode
from robot_tasks.errors import GraphicsError, MissingPackageError, OptionError
from robot_tasks.evaluation import PAPER, find_task, load, measure
from robot_tasks.rollout import rollout
from robot_tasks.simulation import TICK, Simulation
from robot_tasks.tasks import Task

Pixels: TypeAlias = NDArray[np.uint8]
"""Red, green and blue of a frame, top row first, shape (height, width, 3)."""

SMALLEST: Final = 16
LARGEST: Final = 2160
"""Width and height of a frame in pixels."""
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
_BACKENDS: Final = ("egl", "osmesa", "glfw", "cgl")
"""MuJoCo's ways to OpenGL."""


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """Whence frames are taken, and how large they are.

    Raises
    ------
    OptionError
        If the size is out of range.
    """

    camera: str = "front"
    """Name of a camera of the scene."""
    width: int = 480
    """Width in pixels."""
    height: int = 360
    """Height in pixels."""

    def __post_init__(self) -> None:
        for option, pixels in (("width", self.width), ("height", self.height)):
            if not SMALLEST <= pixels <= LARGEST:
                raise OptionError(option, pixels, f"a number of pixels from {SMALLEST} to {LARGEST}")


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


class OffScreen:
    """A camera of a simulation that draws into memory. Close it, or use it in a ``with`` block.

    Parameters
    ----------
    simulation
        The simulation to look at. It must not be shared: the size of its frame buffer is set.
    view
        Camera and size.

    Raises
    ------
    UnknownNameError
        If the scene has no such camera; the message lists those it has.
    GraphicsError
        If there is no OpenGL.
    """

    def __init__(self, simulation: Simulation, view: View) -> None:
        model = simulation.model
        self._model, self._data = model, simulation.data
        self._camera = mujoco.MjvCamera()
        self._camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        self._camera.fixedcamid = simulation.id_of("camera", view.camera)
        self._options = mujoco.MjvOption()
        self._scene = mujoco.MjvScene(model, maxgeom=model.ngeom + model.nsite + 100)
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION):
            self._scene.flags[flag] = False
        self._frame = mujoco.MjrRect(0, 0, view.width, view.height)
        self._pixels: Pixels = np.empty((view.height, view.width, 3), dtype=np.uint8)
        model.vis.global_.offwidth, model.vis.global_.offheight = view.width, view.height
        self._gl, self._context = _open_graphics(model)

    def draw(self) -> Pixels:
        """Draw what the camera sees now."""
        self._gl.make_current()
        everything = mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(
            self._model, self._data, self._options, None, self._camera, everything.value, self._scene
        )
        mujoco.mjr_render(self._frame, self._scene, self._context)
        mujoco.mjr_readPixels(self._pixels, None, self._frame, self._context)
        return self._pixels[::-1].copy()  # OpenGL's first row is the lowest

    def close(self) -> None:
        """Give everything back to the driver."""
        self._gl.make_current()
        self._context.free()
        self._gl.free()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()


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


def _open_graphics(model: Any) -> tuple[Any, Any]:
    """Open the first OpenGL that works, and MuJoCo's drawing in it.

    Backends are opened by name, so it does not matter whether ``MUJOCO_GL`` was set when MuJoCo was imported; but
    MuJoCo's library reads it now, to find OpenGL's functions.
    """
    wanted, platform = os.environ.get("MUJOCO_GL"), os.environ.get("PYOPENGL_PLATFORM")
    problems = {}
    for backend in _backends(wanted):
        os.environ["MUJOCO_GL"] = backend
        try:
            return _open_backend(backend, model)
        except Exception as error:  # drivers and their bindings raise anything
            problems[backend] = str(error).partition("\n")[0].partition(". ")[0] or type(error).__name__
            _forget_opengl()
        _restore("PYOPENGL_PLATFORM", platform)
    _restore("MUJOCO_GL", wanted)
    raise GraphicsError(problems)


def _backends(wanted: str | None) -> tuple[str, ...]:
    """Choose what to try: the backend that is wanted, or those that need no window."""
    if wanted and wanted.lower().strip() in _BACKENDS:
        return (wanted.lower().strip(),)
    return ("cgl",) if sys.platform == "darwin" else ("egl", "osmesa")


def _open_backend(backend: str, model: Any) -> tuple[Any, Any]:
    size = model.vis.global_
    gl = import_module(f"mujoco.{backend}").GLContext(size.offwidth, size.offheight)
    try:
        gl.make_current()
        context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
    except Exception:
        gl.free()
        raise
    mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, context)
    return gl, context


def _forget_opengl() -> None:
    """Undo the import of PyOpenGL, which binds itself to one backend for good."""
    mine = {f"mujoco.{backend}" for backend in _BACKENDS}
    for name in [name for name in sys.modules if name.partition(".")[0] == "OpenGL" or name in mine]:
        del sys.modules[name]


def _restore(variable: str, value: str | None) -> None:
    if value is None:
        os.environ.pop(variable, None)
    else:
        os.environ[variable] = value
