"""Watch contacts: forces on the tool, and touches of what arm and tool should leave alone.

The scene's contact sensors keep their readings of every physics step of a tick, so nothing is missed between ticks.
"""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from robot_tasks.episode import ContactRecord, FloatArray, ForceRecord
from robot_tasks.errors import SimulationError
from robot_tasks.names import TOOL
from robot_tasks.simulation import Simulation

HIDDEN_GROUP: Final = 3
"""Group of geoms that only stand in for a visible one in contacts."""
RELEASE: Final = 0.1
"""Seconds without contact after which the next contact counts as another touch."""
TOUCH: Final = "touch_"
"""Prefix of the sensors that report the strongest contact of arm or tool with something untouchable."""
FIRST_LENGTH: Final = 1024
"""Ticks for which a monitor has room at first; an episode of 18 s has 900."""
DEEPEST_OVERLAP: Final = 0.01
"""Overlap of two bodies in [m] beyond which one has got into the other and its numbers mean nothing.

The hardest blows of these arms overlap by 1 to 3 mm.
"""


class ContactMonitor:
    """Collect what the contact sensors of a scene report over an episode.

    At each tick the sensors' buffers are put aside whole; what they mean is worked out when it is asked for.

    Parameters
    ----------
    simulation
        The simulation to watch. Its scene has the sensors ``tool_force`` and ``deepest``, and one whose name begins
        with `TOUCH` for each geom that should not be touched.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._history = simulation.data.history
        self._tool_force = simulation.sensor_history("tool_force")
        self._deepest = simulation.sensor_history("deepest")
        touch_names = [name for name in simulation.names("sensor") if name.startswith(TOUCH)]
        self._touches = {name: simulation.sensor_history(name) for name in touch_names}
        self._seconds_per_step = float(simulation.model.opt.timestep)
        self._start = simulation.time
        self._log = np.empty((FIRST_LENGTH, self._history.size))
        self._n_ticks = 0

    def observe(self) -> None:
        """Take in the physics steps of one tick, at its end."""
        if self._n_ticks == len(self._log):
            self._log = np.concatenate([self._log, np.empty_like(self._log)])
        self._log[self._n_ticks] = self._history
        self._n_ticks += 1

    @property
    def load(self) -> float:
        """Force in [N] on tool or arm, averaged over the last tick: impacts as one feels them who stands by."""
        tool = np.linalg.norm(self._tool_force, axis=1).mean()
        touches = [(sensor[:, 0] * (sensor[:, 3] < 0.0)).mean() for sensor in self._touches.values()]
        return float(max(tool, *touches)) if touches else float(tool)

    def check(self) -> None:
        """Look through all steps so far.

        Raises
        ------
        SimulationError
            If two bodies overlapped by more than `DEEPEST_OVERLAP`.
        """
        if not self._n_ticks:
            return
        depths = self._readings(self._deepest)[:, 0]
        deepest = int(depths.argmin())
        if depths[deepest] < -DEEPEST_OVERLAP:
            problem = f"two bodies overlap by {-1e3 * depths[deepest]:.1f} mm, {1e3 * DEEPEST_OVERLAP:g} at most mean"
            raise SimulationError(float(self._step_times()[deepest]), f"{problem} anything")

    def touch_record(self, *, held: float = 0.0) -> ContactRecord:
        """Return the unwanted contacts so far, a present one prolonged by a time in [s]."""
        if not (self._touches and self._n_ticks):
            return ContactRecord()
        if not any(self._overlap(sensor) for sensor in self._touches.values()):
            return ContactRecord()
        readings = np.stack([self._readings(sensor) for sensor in self._touches.values()])  # (n_sensors, n_steps, 4)
        forces, distances = readings[:, :, 0], readings[:, :, 3]
        is_touching: NDArray[np.bool_] = np.any(distances < 0.0, axis=0)
        times = self._step_times()[is_touching]
        seconds = len(times) * self._seconds_per_step + (held if is_touching[-1] else 0.0)
        return ContactRecord(
            touches=1 + int(np.count_nonzero(np.diff(times) > RELEASE)),
            seconds=seconds,
            peak_force=float(forces[distances < 0.0].max()),
            deepest_penetration=-float(distances.min()),
        )

    def overlap_with(self, geom: str) -> float:
        """Return the largest overlap so far of arm or tool with a geom that has a touch sensor, in [m], else zero."""
        sensor = self._touches.get(TOUCH + geom)
        return 0.0 if sensor is None or not self._n_ticks else self._overlap(sensor)

    def tool_record(self, *, held: float = 0.0) -> ForceRecord:
        """Return the forces on the tool so far, the present one prolonged by a time in [s]."""
        if not self._n_ticks:
            return ForceRecord()
        forces = self._readings(self._tool_force)  # (n_steps, 3)
        if not forces.any():
            return ForceRecord()
        magnitudes = np.linalg.norm(forces, axis=1)
        last = float(magnitudes[-1])
        return ForceRecord(
            peak=float(magnitudes.max()),
            impulse=float(magnitudes.sum()) * self._seconds_per_step + held * last,
            seconds=int(np.count_nonzero(magnitudes)) * self._seconds_per_step + (held if last else 0.0),
        )

    def _overlap(self, touch: FloatArray) -> float:
        """Return the largest overlap so far in the readings of a touch sensor, in [m], else zero."""
        start = self._column(touch) + 3
        return max(0.0, -float(self._log[: self._n_ticks, start : start + touch.size - 3 : touch.shape[1]].min()))

    def _column(self, sensor: FloatArray) -> int:
        """Return where the readings of a sensor begin in a row of the log."""
        return int(sensor.ctypes.data - self._history.ctypes.data) // self._history.itemsize

    def _readings(self, sensor: FloatArray) -> FloatArray:
        """Return the readings of a sensor at all steps so far, shape (n_steps, size)."""
        start = self._column(sensor)
        return self._log[: self._n_ticks, start : start + sensor.size].reshape(-1, sensor.shape[1])

    def _step_times(self) -> FloatArray:
        """Return the time of every step in [s], shape (n_steps,)."""
        n_steps = len(self._deepest) * self._n_ticks
        times: FloatArray = self._start + np.arange(1.0, n_steps + 1.0) * self._seconds_per_step
        return times


class Clearance:
    """Measure how near arm and tool, in the shapes one sees, come to a geom.

    Parameters
    ----------
    simulation
        The simulation to watch.
    obstacle
        Name of the geom.
    reach
        Largest distance in [m] that is told apart; the search for larger ones is cut short.
    """

    def __init__(self, simulation: Simulation, obstacle: str, *, reach: float = 0.5) -> None:
        self._model = simulation.model
        self._data = simulation.data
        self._obstacle = simulation.id_of("geom", obstacle)
        model = simulation.model
        is_robot = model.body_rootid == model.body_rootid[simulation.id_of("body", TOOL)]
        is_moving = model.body_weldid > 0
        # A body without a geom that collides is one that cannot reach anything.
        can_touch = np.bincount(model.geom_bodyid, model.geom_contype, model.nbody) > 0
        is_visible = model.geom_group < HIDDEN_GROUP
        self._geoms = np.flatnonzero((is_robot & is_moving & can_touch)[model.geom_bodyid] & is_visible).tolist()
        self.smallest = reach

    def observe(self) -> None:
        """Take in the present state."""
        model, data, obstacle, smallest = self._model, self._data, self._obstacle, self.smallest
        for geom in self._geoms:
            # The search is cut short at the distance given, and then returns it.
            smallest = mujoco.mj_geomDistance(model, data, geom, obstacle, smallest, None)
        self.smallest = smallest
