"""Watch contacts: forces on the tool, and touches of what arm and tool should leave alone.

The scene's contact sensors keep their readings of every physics step of a tick, so nothing is missed between ticks.
"""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np

from robot_tasks.episode import ContactRecord, ForceRecord
from robot_tasks.errors import SimulationError
from robot_tasks.simulation import Simulation

HIDDEN_GROUP: Final = 3
"""Group of geoms that only stand in for a visible one in contacts."""
RELEASE: Final = 0.1
"""Seconds without contact after which the next contact counts as another touch."""
TOUCH: Final = "touch_"
"""Prefix of the sensors that report the strongest contact of arm or tool with something untouchable."""
DEEPEST_OVERLAP: Final = 0.01
"""Overlap of two bodies in [m] beyond which one has got into the other and its numbers mean nothing.

The hardest blows of these arms overlap by 1 to 3 mm.
"""


class ContactMonitor:
    """Collect what the contact sensors of a scene report over an episode.

    Parameters
    ----------
    simulation
        The simulation to watch. Its scene has the sensors ``tool_force`` and ``deepest``, and one whose name begins
        with `TOUCH` for each geom that should not be touched.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._deepest = simulation.sensor_history("deepest")
        self._tool_force = simulation.sensor_history("tool_force")
        self._touch_sensors = [
            simulation.sensor_history(name) for name in simulation.names("sensor") if name.startswith(TOUCH)
        ]
        self._seconds_per_step = float(simulation.model.opt.timestep)
        self._last_touch = -np.inf
        self._touches = self._touch_steps = self._force_steps = 0
        self._is_touching = False
        self._peak_touch = self._penetration = 0.0
        self._tool_peak = self._tool_sum = self._tool_last = 0.0

    @property
    def tool_peak(self) -> float:
        """Largest net contact force on the tool so far in [N]."""
        return self._tool_peak

    def touch_record(self, *, held: float = 0.0) -> ContactRecord:
        """Return the unwanted contacts so far, a present one prolonged by a time in [s]."""
        return ContactRecord(
            touches=self._touches,
            seconds=self._touch_steps * self._seconds_per_step + (held if self._is_touching else 0.0),
            peak_force=self._peak_touch,
            deepest_penetration=self._penetration,
        )

    def tool_record(self, *, held: float = 0.0) -> ForceRecord:
        """Return the forces on the tool so far, the present one prolonged by a time in [s]."""
        return ForceRecord(
            peak=self._tool_peak,
            impulse=self._tool_sum * self._seconds_per_step + held * self._tool_last,
            seconds=self._force_steps * self._seconds_per_step + (held if self._tool_last else 0.0),
        )

    def observe(self) -> None:
        """Take in the physics steps of one tick, at its end.

        Raises
        ------
        SimulationError
            If two bodies overlap by more than `DEEPEST_OVERLAP`.
        """
        self._is_touching, self._tool_last = False, 0.0
        deepest = self._deepest.min()
        if deepest >= 0.0:  # nothing touched anything
            return
        if deepest < -DEEPEST_OVERLAP:
            problem = f"two bodies overlap by {-1e3 * deepest:.1f} mm, {1e3 * DEEPEST_OVERLAP:g} at most mean anything"
            raise SimulationError(self._simulation.time, problem)
        self._observe_tool()
        for readings in self._touch_sensors:
            if readings[:, 3].min() < 0.0:
                self._observe_touch()
                return

    def _observe_tool(self) -> None:
        force = self._tool_force
        if not force.any():
            return
        magnitude = np.sqrt(np.einsum("ij,ij->i", force, force))  # (n_steps,)
        self._tool_peak = max(self._tool_peak, float(magnitude.max()))
        self._tool_sum += float(magnitude.sum())
        self._tool_last = float(magnitude[-1])
        self._force_steps += int(np.count_nonzero(magnitude))

    def _observe_touch(self) -> None:
        """Go through the steps of a tick in which something untouchable was touched."""
        readings = np.stack(self._touch_sensors)  # (n_sensors, n_steps, 4): force in the contact's frame, distance
        touched = readings[:, :, 3] < 0.0
        self._peak_touch = max(self._peak_touch, float(readings[:, :, 0][touched].max()))
        self._penetration = max(self._penetration, -float(readings[:, :, 3].min()))
        is_touching = [bool(step.any()) for step in touched.T]
        start = self._simulation.time - len(is_touching) * self._seconds_per_step
        for step, touches in enumerate(is_touching):
            if touches:
                time = start + step * self._seconds_per_step
                self._touches += time - self._last_touch > RELEASE
                self._last_touch = time
        self._touch_steps += sum(is_touching)
        self._is_touching = is_touching[-1]


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
        is_robot = model.body_rootid == model.body_rootid[simulation.id_of("body", "tool_body")]
        is_moving = model.body_weldid > 0
        is_visible = model.geom_group < HIDDEN_GROUP
        self._geoms = np.flatnonzero((is_robot & is_moving)[model.geom_bodyid] & is_visible).tolist()
        self.smallest = reach

    def observe(self) -> None:
        """Take in the present state."""
        for geom in self._geoms:
            distance = mujoco.mj_geomDistance(self._model, self._data, geom, self._obstacle, self.smallest, None)
            self.smallest = min(self.smallest, distance)
