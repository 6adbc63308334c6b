"""A MuJoCo model and its state, with access by name and a reset that forgets everything."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import resources
from typing import Any, Final, Literal, Self, TypeAlias

import mujoco
import numpy as np
from numpy.typing import NDArray

from robot_tasks.errors import SimulationError, UnknownNameError
from robot_tasks.geometry import Pose
from robot_tasks.names import N_JOINTS

FloatArray: TypeAlias = NDArray[np.float64]
Kind: TypeAlias = Literal["body", "joint", "geom", "site", "actuator", "camera", "sensor"]

TICK: Final = 0.02
"""Seconds between decisions and between updates of the reference; the sensors' buffers hold one tick."""

_OBJECT_TYPES: Final = {
    "body": mujoco.mjtObj.mjOBJ_BODY,
    "joint": mujoco.mjtObj.mjOBJ_JOINT,
    "geom": mujoco.mjtObj.mjOBJ_GEOM,
    "site": mujoco.mjtObj.mjOBJ_SITE,
    "actuator": mujoco.mjtObj.mjOBJ_ACTUATOR,
    "camera": mujoco.mjtObj.mjOBJ_CAMERA,
    "sensor": mujoco.mjtObj.mjOBJ_SENSOR,
}
_COUNTS: Final = {
    "body": "nbody",
    "joint": "njnt",
    "geom": "ngeom",
    "site": "nsite",
    "actuator": "nactuator",
    "camera": "ncam",
    "sensor": "nsensor",
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
        self._places: dict[str, tuple[FloatArray, FloatArray | None, FloatArray | None]] = {}

    @classmethod
    def from_scene(
        cls, file_name: str, *, timestep: float | None = None, modify: Callable[[Any], None] | None = None
    ) -> Self:
        """Load a scene from the package's `models` folder, such as ``"obstacle_avoidance.xml"``.

        Parameters
        ----------
        file_name
            Name of the scene's file.
        timestep
            Physics step in [s] instead of the scene's own.
        modify
            Changes the scene, a `mujoco.MjSpec`, before it is compiled.

        Raises
        ------
        UnknownNameError
            If there is no such scene.
        """
        specification = load_scene(file_name)
        set_timestep(specification, timestep or specification.option.timestep)
        if modify is not None:
            modify(specification)
        return cls(specification.compile())

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

    def pose_of(self, name: str) -> Pose:
        """Return the present pose of a body or site in world axes.

        Raises
        ------
        UnknownNameError
            If the scene has neither a body nor a site of this name.
        """
        if name not in self._places:
            self._places[name] = self._find_place(name)
        position, quaternion, matrix = self._places[name]
        x, y, z = position.tolist()
        if quaternion is None:
            quaternion = np.empty(4)
            mujoco.mju_mat2Quat(quaternion, matrix)
        w, i, j, k = quaternion.tolist()
        return Pose((x, y, z), (w, i, j, k))

    def _find_place(self, name: str) -> tuple[FloatArray, FloatArray | None, FloatArray | None]:
        """Find live views of position and of quaternion (bodies) or rotation matrix (sites)."""
        data = self.data
        if name in self.names("site"):
            index = self.id_of("site", name)
            return data.site_xpos[index], None, data.site_xmat[index]
        if name in self.names("body"):
            index = self.id_of("body", name)
            return data.xpos[index], data.xquat[index], None
        raise UnknownNameError("body or site", name, {*self.names("body"), *self.names("site")})

    def sensor_history(self, name: str) -> FloatArray:
        """Return a live view of a sensor's readings at every step of the last tick, shape (n_steps, size).

        The scene gives the sensor a buffer (``nsample``) of as many samples as a tick has steps, so the rows are in
        the order of time at the end of each tick.
        """
        model, index = self.model, self.id_of("sensor", name)
        n_samples, size = int(model.sensor_history[index, 0]), int(model.sensor_dim[index])
        if n_samples != round(TICK / model.opt.timestep):
            raise ValueError(f"sensor '{name}' keeps {n_samples} samples; a tick has {TICK / model.opt.timestep:g}")
        start = int(model.sensor_historyadr[index]) + 2 + n_samples  # after a period, a cursor and the times
        history: FloatArray = self.data.history[start : start + n_samples * size].reshape(n_samples, size)
        return history

    def site_position(self, name: str) -> FloatArray:
        """Return a live view of the world position of a site, shape (3,), in [m]."""
        position: FloatArray = self.data.site_xpos[self.id_of("site", name)]
        return position

    def shift_body(self, name: str, offset: Sequence[float]) -> None:
        """Move a fixed body by an offset in [m] from its nominal place, until the next reset."""
        index = self.id_of("body", name)
        self.model.body_pos[index] = self._nominal["body_pos"][index] + np.asarray(offset)

    def reset(self) -> None:
        """Return model and state to how they were loaded, warm start of the solver included."""
        for field, nominal in self._nominal.items():
            getattr(self.model, field)[:] = nominal
        mujoco.mj_resetData(self.model, self.data)

    def place_body(self, name: str, pose: Pose) -> None:
        """Put a free body at rest at a pose; call before `place_arm`, which computes what follows."""
        joint = int(self.model.body_jntadr[self.id_of("body", name)])
        if joint < 0 or self.model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_FREE:
            raise ValueError(f"body '{name}' is not free to be placed anywhere. Give it a <freejoint>.")
        start = int(self.model.jnt_qposadr[joint])
        self.data.qpos[start : start + 7] = (*pose.position, *pose.quaternion)

    def place_arm(self, joint_positions: Sequence[float]) -> None:
        """Put the arm at rest at joint angles in [rad] and compute all that follows from them."""
        self.data.qpos[:N_JOINTS] = joint_positions
        mujoco.mj_forward(self.model, self.data)

    def hold_commands(self) -> None:
        """Let actuators with a delay go on from the present commands, as if these had long been given."""
        model, data = self.model, self.data
        for actuator, (n_samples, *_) in enumerate(model.actuator_history.tolist()):
            if n_samples:
                start, size = model.actuator_ctrladr[actuator], model.actuator_ctrlnum[actuator]
                values = np.tile(data.ctrl[start : start + size], (n_samples, 1))
                mujoco.mj_initCtrlHistory(model, data, actuator, None, values)

    def raise_if_diverged(self) -> None:
        """Raise a `SimulationError` if MuJoCo met numbers that are not finite or too large."""
        for kind in _DIVERGED:
            if self.data.warning[kind].number:
                problem = mujoco.mju_warningText(kind, self.data.warning[kind].lastinfo)
                raise SimulationError(self.time, problem.rstrip("."))


def load_scene(file_name: str) -> Any:
    """Read a scene of the package's `models` folder as an editable `mujoco.MjSpec`.

    Raises
    ------
    UnknownNameError
        If there is no such scene.
    """
    folder = resources.files("robot_tasks") / "models"
    with resources.as_file(folder) as path:
        scenes = [scene.name for scene in path.glob("*.xml")]
        if file_name not in scenes:
            raise UnknownNameError("scene", file_name, scenes)
        return mujoco.MjSpec.from_file(str(path / file_name))


def set_timestep(specification: Any, timestep: float) -> None:
    """Change the physics step of a scene to a time in [s], and with it the length of its sensors' buffers.

    Raises
    ------
    ValueError
        If a tick has no whole number of such steps.
    """
    if abs(round(TICK / timestep) * timestep - TICK) > 1e-9:
        raise ValueError(f"a physics step of {timestep:g} s: a tick of {TICK:g} s must have a whole number of steps")
    specification.option.timestep = timestep
    for sensor in specification.sensors:
        if sensor.nsample:
            sensor.nsample = round(TICK / timestep)
