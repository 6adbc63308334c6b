"""Tests for offscreen.py: which OpenGL is tried, and what one is told without any; test_render.py looks at pictures."""

import os
import sys

import pytest

from robot_tasks import offscreen
from robot_tasks.errors import GraphicsError
from robot_tasks.offscreen import OffScreen, View

SMALL = View(width=96, height=64)


def test_without_opengl_the_error_says_what_was_tried_and_what_to_install(simulation, monkeypatch):
    def fail(backend, model):
        os.environ["PYOPENGL_PLATFORM"] = backend
        raise OSError("no driver\nand more")

    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(offscreen, "_open_backend", fail)
    monkeypatch.setattr(offscreen, "_forget_opengl", lambda: None)
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.delenv("PYOPENGL_PLATFORM", raising=False)
    with pytest.raises(GraphicsError, match=r"\(egl: no driver; osmesa: no driver\)\. Install libegl1"):
        OffScreen(simulation, SMALL)
    assert not {"MUJOCO_GL", "PYOPENGL_PLATFORM"} & set(os.environ)


@pytest.mark.parametrize(
    ("wanted", "platform", "backends"),
    [
        pytest.param(None, "linux", ("egl", "osmesa"), id="unset"),
        pytest.param("on", "linux", ("egl", "osmesa"), id="no backend's name"),
        pytest.param(" OSMesa ", "linux", ("osmesa",), id="wanted"),
        pytest.param(None, "darwin", ("cgl",), id="macOS"),
    ],
)
def test_the_environment_chooses_the_backend(monkeypatch, wanted, platform, backends):
    monkeypatch.setattr(sys, "platform", platform)
    assert offscreen._backends(wanted) == backends
