"""Draw what a camera of a simulation sees, without a display: by EGL, or else by OSMesa."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from importlib import import_module
from types import TracebackType
from typing import Any, Final, Self, TypeAlias

import mujoco
import numpy as np
from numpy.typing import NDArray

from robot_tasks.errors import GraphicsError, OptionError
from robot_tasks.simulation import Simulation

Pixels: TypeAlias = NDArray[np.uint8]
"""Red, green and blue of a frame, top row first, shape (height, width, 3)."""


SMALLEST: Final = 16
LARGEST: Final = 2160
"""Width and height of a frame in pixels."""
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
