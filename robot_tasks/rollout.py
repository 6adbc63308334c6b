"""Run a skill in the simulation: the only place where physics advances.

At every tick the tree decides, the reference moves and the controller writes its commands; then physics runs until the
next tick. Poses are measured at the tick itself: a MuJoCo step is split so that its first half, which computes
where everything is, ends one tick, and its second half, which computes and applies forces, begins the next.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

import mujoco
import numpy as np

from robot_tasks.contacts import Clearance, ContactMonitor
from robot_tasks.control import ImpedanceController
from robot_tasks.control.impedance import TIP
from robot_tasks.episode import Episode
from robot_tasks.geometry import Pose
from robot_tasks.motion import MotionGenerator
from robot_tasks.randomization import Variation
from robot_tasks.simulation import N_JOINTS, TICK, Simulation
from robot_tasks.skills import SkillContext, Status
from robot_tasks.tasks import Task

TICKS_PER_SAMPLE: Final = 5
"""Ticks between samples of the episode: rewards are summed over a 10 Hz grid."""
STILL_SPEED: Final = 1e-4
"""Joint speed in [rad/s] below which the arm counts as standing still."""


def rollout(
    task: Task,
    parameters: Mapping[str, float],
    variation: Variation,
    simulation: Simulation,
    *,
    stop_when_still: bool = True,
    on_tick: Callable[[float], None] | None = None,
) -> Episode:
    """Run one episode of a task.

    Parameters
    ----------
    task
        The task; its scene is that of the simulation.
    parameters
        Checked parameters of the skill.
    variation
        Start state and offsets of bodies.
    simulation
        Physics. Whatever ran in it before has no influence.
    stop_when_still
        End early once reference, commands and arm stand still, so that nothing can change any more; the episode
        is filled with its last sample.
    on_tick
        Called with the time in [s] at every tick and at the end, when all poses are up to date; must not change the
        simulation.

    Raises
    ------
    SimulationError
        If the physics diverged or bodies got into each other.
    """
    variation.apply(simulation)
    run = _Run(task, parameters, simulation)
    show = on_tick or _ignore
    n_samples = round(task.duration / (TICK * TICKS_PER_SAMPLE))
    for sample in range(n_samples):
        run.record()
        if stop_when_still and run.is_over():
            break
        for tick in range(sample * TICKS_PER_SAMPLE, (sample + 1) * TICKS_PER_SAMPLE):
            show(tick * TICK)
            run.tick(tick * TICK)
    else:
        run.record()
    show(simulation.time)
    simulation.raise_if_diverged()
    return run.episode(n_samples + 1)


class _Run:
    """The moving parts of one rollout."""

    def __init__(self, task: Task, parameters: Mapping[str, float], simulation: Simulation) -> None:
        self._simulation = simulation
        self._model, self._data = simulation.model, simulation.data
        self._tip = simulation.site_position(TIP)
        pose = self._measured_pose()
        self._tree = task.build_tree(parameters)
        self._context = SkillContext(tip=pose.position, world=simulation, goal=pose)
        self._generator = MotionGenerator(pose)
        self._controller = ImpedanceController(simulation)
        self._contacts = ContactMonitor(simulation)
        self._clearance = Clearance(simulation, task.obstacle) if task.obstacle else None
        self._object = task.object_body
        self._final_condition = task.final_condition
        self._reference = pose
        self._is_tree_done = False
        self._success_time: float | None = None
        self._time = 0.0
        self._n_still = 0
        self._samples: list[tuple[float, ...]] = []
        self._steps_per_tick = round(TICK / self._model.opt.timestep)

    def tick(self, time: float) -> None:
        """Decide, command, and run physics for one tick that starts at a time in [s]."""
        self._time = time
        x, y, z = self._tip.tolist()
        context, controller = self._context, self._controller
        context.tip = (x, y, z)
        if not self._is_tree_done:
            self._decide(time)
        controller.aim_stiffness(context.stiffness)
        controller.aim_force(context.force)
        self._generator.set_overlay(context.overlay, time)
        self._reference = self._generator.reference(time)
        controller.update(self._reference, TICK)
        self._advance()
        self._contacts.observe()

    def record(self) -> None:
        """Take a sample of the present state."""
        data = self._data
        joints = data.qpos[:N_JOINTS].tolist()
        pose = self._simulation.pose_of(self._object) if self._object else None
        self._samples.append(
            (
                *self._tip.tolist(),
                *self._reference.position,
                *joints,
                *self._controller.force,
                *(() if pose is None else (*pose.position, *pose.quaternion)),
            )
        )
        if self._clearance:
            self._clearance.observe()
        if self._final_condition:
            is_achieved = self._final_condition.holds(self._simulation)
            if not is_achieved:
                self._success_time = None
            elif self._success_time is None:
                self._success_time = self._simulation.time
        is_still = float(np.abs(data.qvel).max()) < STILL_SPEED and self._controller.is_settled
        self._n_still = self._n_still + 1 if is_still and self._generator.is_finished(self._time) else 0

    def is_over(self) -> bool:
        """Tell whether nothing can change any more.

        Twice in a row: an oscillating arm stands still for an instant, but not again a tenth of a second later.
        """
        return self._n_still >= 2 and self._time > 0.0

    def episode(self, n_samples: int) -> Episode:
        """Return the samples, the last one repeated up to the full length."""
        table = np.array(self._samples + self._samples[-1:] * (n_samples - len(self._samples)))
        simulated_seconds = (len(self._samples) - 1) * TICK * TICKS_PER_SAMPLE
        held = (n_samples - len(self._samples)) * TICK * TICKS_PER_SAMPLE
        contact = self._contacts.touch_record(held=held)
        return Episode(
            times=np.linspace(0.0, (n_samples - 1) * TICK * TICKS_PER_SAMPLE, n_samples),
            tip_positions=table[:, 0:3],
            reference_positions=table[:, 3:6],
            joint_positions=table[:, 6:13],
            commanded_forces=table[:, 13:16],
            object_poses=table[:, 16:] if self._object else None,
            success_time=self._success_time,
            simulated_seconds=simulated_seconds,
            clearance=min(self._clearance.smallest, -contact.deepest_penetration or np.inf)
            if self._clearance
            else np.inf,
            contact=contact,
            tool_contact=self._contacts.tool_record(held=held),
        )

    def _decide(self, time: float) -> None:
        """Tick the tree and start a trajectory if it changed its goal."""
        context, generator = self._context, self._generator
        context.forget_demands()
        status = self._tree.tick(context)
        if status is not Status.RUNNING:
            self._is_tree_done = True
            context.forget_demands()
            if status is Status.SUCCESS and self._final_condition is None:
                self._success_time = time
        if context.goal is not generator.goal and context.goal != generator.goal:
            generator.move_to(context.goal, measured=self._measured_pose(), time=time)

    def _advance(self) -> None:
        """Run physics for one tick."""
        model, data = self._model, self._data
        mujoco.mj_step2(model, data)
        mujoco.mj_step(model, data, self._steps_per_tick - 1)
        mujoco.mj_step1(model, data)

    def _measured_pose(self) -> Pose:
        x, y, z = self._tip.tolist()
        return Pose((x, y, z), self._simulation.site_quaternion(TIP))


def _ignore(time: float) -> None:
    """Show nothing."""
