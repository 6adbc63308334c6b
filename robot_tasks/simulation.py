"""A MuJoCo model and its state, with access by name and a reset that forgets everything."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import resources
from typing import Any, Final, Literal, Self, TypeAlias

import mujoco
import numpy as np
from numpy.typing import NDArray

from robot_tasks.errors import SimulationError, UnknownNameError

FloatArray: TypeAlias = NDArray[np.float64]
Kind: TypeAlias = Literal["body", "joint", "geom", "site", "actuator", "camera"]

N_JOINTS: Final = 7
"""Joints of the arm; they come first in every scene."""

_OBJECT_TYPES: Final = {
    "body": mujoco.mjtObj.mjOBJ_BODY,
    "joint": mujoco.mjtObj.mjOBJ_JOINT,
    "geom": mujoco.mjtObj.mjOBJ_GEOM,
    "site": mujoco.mjtObj.mjOBJ_SITE,
    "actuator": mujoco.mjtObj.mjOBJ_ACTUATOR,
    "camera": mujoco.mjtObj.mjOBJ_CAMERA,
}
_COUNTS: Final = {
    "body": "nbody",
    "joint": "njnt",
    "geom": "ngeom",
    "site": "nsite",
    "actuator": "nactuator",
    "camera": "ncam",
}
_WRITABLE_FIELDS: Final = ("body_pos", "body_quat", "actuator_gainprm", "actuator_biasprm")
_DIVERGED: Final = (
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
    mujoco.mjtWarning.mjWARN_BADCTRL,
)


class Simulation:
    """Physics of one scene.

    A simulation is made once and reset before each episode. Only the model fields that `reset` restores may be
    written: body positions and orientations, and the gains of actuators.

    Parameters
    ----------
    model
        A compiled model whose first seven joints are those of the arm.

    Attributes
    ----------
    model, data
        MuJoCo's own objects, for everything that has no name here.
    """

    def __init__(self, model: Any) -> None:  # mujoco has no type stubs for its compiled module
        self.model = model
        self.data = mujoco.MjData(model)
        self._nominal = {field: getattr(model, field).copy() for field in _WRITABLE_FIELDS}

    @classmethod
    def from_scene(cls, file_name: str) -> Self:
        """Load a scene from the package's `models` folder, such as ``"obstacle_avoidance.xml"``."""
        folder = resources.files("robot_tasks") / "models"
        with resources.as_file(folder) as path:
            scenes = [scene.name for scene in path.glob("*.xml")]
            if file_name not in scenes:
                raise UnknownNameError("scene", file_name, scenes)
            return cls(mujoco.MjModel.from_xml_path(str(path / file_name)))

    @property
    def time(self) -> float:
        """Simulated time in [s]."""
        return float(self.data.time)

    def id_of(self, kind: Kind, name: str) -> int:
        """Look up the index of a named element.

        Raises
        ------
        UnknownNameError
            If the model has no such element; the message lists those it has.
        """
        index = int(mujoco.mj_name2id(self.model, _OBJECT_TYPES[kind], name))
        if index < 0:
            raise UnknownNameError(kind, name, self.names(kind))
        return index

    def names(self, kind: Kind) -> tuple[str, ...]:
        """List the names of all elements of a kind, in the model's order."""
        count = getattr(self.model, _COUNTS[kind])
        return tuple(mujoco.mj_id2name(self.model, _OBJECT_TYPES[kind], i) or "" for i in range(count))

    def site_position(self, name: str) -> FloatArray:
        """Return a live view of the world position of a site, shape (3,), in [m]."""
        position: FloatArray = self.data.site_xpos[self.id_of("site", name)]
        return position

    def site_quaternion(self, name: str) -> tuple[float, float, float, float]:
        """Compute the orientation of a site as a quaternion w, x, y, z."""
        quaternion = np.empty(4)
        mujoco.mju_mat2Quat(quaternion, self.data.site_xmat[self.id_of("site", name)])
        w, x, y, z = quaternion.tolist()
        return w, x, y, z

    def shift_body(self, name: str, offset: Sequence[float]) -> None:
        """Move a fixed body by an offset in [m] from its nominal place, until the next reset."""
        index = self.id_of("body", name)
        self.model.body_pos[index] = self._nominal["body_pos"][index] + np.asarray(offset)

    def reset(self) -> None:
        """Return model and state to how they were loaded, warm start of the solver included."""
        for field, nominal in self._nominal.items():
            getattr(self.model, field)[:] = nominal
        mujoco.mj_resetData(self.model, self.data)

    def place_arm(self, joint_positions: Sequence[float]) -> None:
        """Put the arm at rest at joint angles in [rad] and compute all that follows from them."""
        self.data.qpos[:N_JOINTS] = joint_positions
        mujoco.mj_forward(self.model, self.data)

    def raise_if_diverged(self) -> None:
        """Raise a `SimulationError` if MuJoCo met numbers that are not finite or too large."""
        for kind in _DIVERGED:
            if self.data.warning[kind].number:
                problem = mujoco.mju_warningText(kind, self.data.warning[kind].lastinfo)
                raise SimulationError(self.time, problem.rstrip("."))
