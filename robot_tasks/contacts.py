"""Watch the contacts of arm and tool with things they should not touch."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import mujoco
import numpy as np

from robot_tasks.episode import ContactRecord
from robot_tasks.simulation import Simulation

HIDDEN_GROUP: Final = 3
"""Group of geoms that only stand in for a visible one in contacts."""
RELEASE: Final = 0.1
"""Seconds without contact after which the next contact counts as another touch."""


class ContactMonitor:
    """Collect a `ContactRecord` over an episode.

    Parameters
    ----------
    simulation
        The simulation to watch.
    untouchable
        Names of geoms; arm and tool are whatever collides with them.
    """

    def __init__(self, simulation: Simulation, untouchable: Iterable[str]) -> None:
        self._model = simulation.model
        self._data = simulation.data
        self._untouchable = {simulation.id_of("geom", name) for name in untouchable}
        self._seconds_per_step = float(simulation.model.opt.timestep)
        self._force = np.zeros(6)
        self._last_touch = -np.inf
        self._touches = self._steps = 0
        self._is_touching = False
        self._peak_force = self._penetration = 0.0

    def record(self, *, held: float = 0.0) -> ContactRecord:
        """Return what was observed so far, a present contact prolonged by a time in [s]."""
        return ContactRecord(
            touches=self._touches,
            seconds=self._steps * self._seconds_per_step + (held if self._is_touching else 0.0),
            peak_force=self._peak_force,
            deepest_penetration=self._penetration,
        )

    def is_near(self) -> bool:
        """Tell whether an untouchable geom is touched or closer than the `gap` of the scene's geoms."""
        if not self._data.ncon:
            return False
        return not self._untouchable.isdisjoint(self._data.contact.geom.ravel().tolist())

    def observe(self) -> None:
        """Take in the contacts of one physics step whose forces have been computed."""
        data = self._data
        self._is_touching = False
        if not data.nefc:  # near, but nothing pushes
            return
        for index, (pair, distance) in enumerate(
            zip(data.contact.geom.tolist(), data.contact.dist.tolist(), strict=True)
        ):
            if distance < 0.0 and self._is_untouchable(pair):
                self._is_touching = True
                mujoco.mj_contactForce(self._model, data, index, self._force)
                self._peak_force = max(self._peak_force, float(self._force[0]))
                self._penetration = max(self._penetration, -distance)
        if self._is_touching:
            self._steps += 1
            self._touches += data.time - self._last_touch > RELEASE
            self._last_touch = data.time

    def _is_untouchable(self, pair: list[int]) -> bool:
        return pair[0] in self._untouchable or pair[1] in self._untouchable


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
        is_moving = simulation.model.body_weldid[simulation.model.geom_bodyid] > 0
        is_visible = simulation.model.geom_group < HIDDEN_GROUP
        self._geoms = np.flatnonzero(is_moving & is_visible).tolist()
        self.smallest = reach

    def observe(self) -> None:
        """Take in the present state."""
        for geom in self._geoms:
            distance = mujoco.mj_geomDistance(self._model, self._data, geom, self._obstacle, self.smallest, None)
            self.smallest = min(self.smallest, distance)
