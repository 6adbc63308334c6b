"""Turn a running simulation into an episode."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from robot_tasks.contacts import Clearance, ContactMonitor
from robot_tasks.episode import Episode
from robot_tasks.geometry import Vector
from robot_tasks.names import N_JOINTS, TIP
from robot_tasks.simulation import TICK, Simulation
from robot_tasks.tasks import Task

TICKS_PER_SAMPLE: Final = 5
"""Ticks between samples of the episode: rewards are summed over a 10 Hz grid."""
SAMPLE_SECONDS: Final = TICK * TICKS_PER_SAMPLE


class Recorder:
    """Take samples on a regular grid, and watch contacts, clearance and what the task wants to hold at the end.

    Parameters
    ----------
    task
        Says what to watch.
    simulation
        The simulation, set up for the rollout.
    shifts
        How far its bodies stand from their nominal places in [m].

    Attributes
    ----------
    contacts
        To be told of every tick.
    success_time
        When the task was achieved in [s]. Set by the recorder if the task has a final condition, else by whoever runs
        the skill.
    """

    def __init__(self, task: Task, simulation: Simulation, shifts: Mapping[str, Vector]) -> None:
        self.contacts = ContactMonitor(simulation)
        self.success_time: float | None = None
        self._simulation = simulation
        self._shifts = shifts
        self._tip = simulation.site_position(TIP)
        self._joints = simulation.data.qpos[:N_JOINTS]
        self._object = task.object_body
        self._obstacle = task.obstacle
        self._clearance = Clearance(simulation, task.obstacle) if task.obstacle else None
        self._final_condition = task.final_condition
        self._n_samples = 1 + round(task.duration / SAMPLE_SECONDS)
        self._samples: list[tuple[float, ...]] = []

    def sample(self, reference: Vector, force: tuple[float, ...]) -> None:
        """Take a sample of the present state, the present reference position in [m] and commanded force in [N]."""
        place = self._simulation.pose_of(self._object) if self._object else None
        pose = (*place.position, *place.quaternion) if place else ()
        self._samples.append((*self._tip.tolist(), *reference, *self._joints.tolist(), *force, *pose))
        if self._clearance:
            self._clearance.observe()
        if self._final_condition:
            if not self._final_condition.holds(self._simulation):
                self.success_time = None
            elif self.success_time is None:
                self.success_time = (len(self._samples) - 1) * SAMPLE_SECONDS

    def episode(self, *, is_stopped: bool) -> Episode:
        """Return what happened, the last sample repeated up to the full length.

        Parameters
        ----------
        is_stopped
            Whether an operator stopped the robot and took it out of contact. Otherwise a contact at the end lasts.

        Raises
        ------
        SimulationError
            If the physics diverged or bodies got into each other.
        """
        self._simulation.raise_if_diverged()
        self.contacts.check()
        n_missing = self._n_samples - len(self._samples)
        table = np.array(self._samples + self._samples[-1:] * n_missing)
        held = 0.0 if is_stopped else n_missing * SAMPLE_SECONDS
        contact = self.contacts.touch_record(held=held)
        return Episode(
            times=np.linspace(0.0, (self._n_samples - 1) * SAMPLE_SECONDS, self._n_samples),
            tip_positions=table[:, 0:3],
            reference_positions=table[:, 3:6],
            joint_positions=table[:, 6:13],
            commanded_forces=table[:, 13:16],
            object_poses=table[:, 16:] if self._object else None,
            shifts=self._shifts,
            success_time=self.success_time,
            simulated_seconds=(len(self._samples) - 1) * SAMPLE_SECONDS,
            clearance=self._smallest_clearance(),
            contact=contact,
            tool_contact=self.contacts.tool_record(held=held),
            interventions=int(is_stopped),
        )

    def _smallest_clearance(self) -> float:
        """Return the smallest distance at a sample, or the largest overlap at any step, as a negative number."""
        if self._obstacle is None or self._clearance is None:
            return np.inf
        overlap = self.contacts.overlap_with(self._obstacle)
        return min(self._clearance.smallest, -overlap) if overlap else self._clearance.smallest
