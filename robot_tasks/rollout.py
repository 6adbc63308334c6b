"""Run a skill in the simulation: the only place where physics advances.

At every tick the tree decides, the reference moves and the controller writes its commands; then physics runs until the
next tick. Poses are measured at the tick itself: a MuJoCo step is split so that its first half, which computes
where everything is, ends one tick, and its second half, which computes and applies forces, begins the next.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from math import isfinite
from typing import Final

import mujoco

from robot_tasks.control import ImpedanceController
from robot_tasks.episode import Episode
from robot_tasks.geometry import Pose
from robot_tasks.motion import MotionGenerator
from robot_tasks.names import TIP
from robot_tasks.randomization import Variation
from robot_tasks.recorder import SAMPLE_SECONDS, TICKS_PER_SAMPLE, Recorder
from robot_tasks.simulation import TICK, Simulation
from robot_tasks.skills import SkillContext, Status
from robot_tasks.tasks import Task

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
    run = _Run(task, parameters, variation, simulation)
    show = on_tick or _ignore
    for sample in range(round(task.duration / SAMPLE_SECONDS)):
        run.sample()
        if run.is_stopped or (stop_when_still and run.is_still()):
            break
        for tick in range(sample * TICKS_PER_SAMPLE, (sample + 1) * TICKS_PER_SAMPLE):
            show(tick * TICK)
            run.tick(tick * TICK)
            if run.is_stopped:
                break
    else:
        run.sample()
    show(simulation.time)
    return run.episode()


class _Run:
    """Skill, motion generator and controller of one rollout, and the simulation they move."""

    def __init__(
        self, task: Task, parameters: Mapping[str, float], variation: Variation, simulation: Simulation
    ) -> None:
        pose = simulation.pose_of(TIP)
        self.is_stopped = False
        self._simulation = simulation
        self._model, self._data = simulation.model, simulation.data
        self._tip = simulation.site_position(TIP)
        self._tree = task.build_tree(parameters)
        self._context = SkillContext(tip=pose.position, world=simulation, goal=pose)
        self._generator = MotionGenerator(pose)
        self._controller = ImpedanceController(simulation, force_compensation=task.gap.force_compensation)
        self._recorder = Recorder(task, simulation, variation.shifts)
        self._contacts = self._recorder.contacts
        self._skill_decides = task.final_condition is None
        self._force_limit = task.gap.force_limit
        self._has_operator = isfinite(task.gap.force_limit)
        self._late_tips = deque([pose.position], maxlen=1 + task.gap.ticks_of_sensing_delay)
        self._sees_late = task.gap.ticks_of_sensing_delay > 0
        self._reference = pose
        self._is_tree_done = False
        self._time = 0.0
        self._n_still = 0
        self._steps_per_tick = round(TICK / simulation.model.opt.timestep)

    def tick(self, time: float) -> None:
        """Decide, command, and run physics for one tick that starts at a time in [s]."""
        self._time = time
        context = self._context
        x, y, z = self._tip.tolist()
        context.tip = x, y, z
        if self._sees_late:
            self._late_tips.append(context.tip)
            context.tip = self._late_tips[0]
        if not self._is_tree_done:
            self._decide(time)
        self._reference = self._generator.reference(time)
        self._controller.update(self._reference, TICK)
        self._advance()
        self._contacts.observe()
        if self._has_operator:
            self.is_stopped = self._contacts.load > self._force_limit

    def sample(self) -> None:
        """Take a sample, and note whether anything moves."""
        self._recorder.sample(self._reference.position, self._controller.force)
        is_still = (
            self._controller.is_settled
            and self._generator.is_finished(self._time)
            and max(map(abs, self._data.qvel.tolist())) < STILL_SPEED
        )
        self._n_still = self._n_still + 1 if is_still else 0

    def is_still(self) -> bool:
        """Tell whether nothing can change any more.

        Twice in a row: an oscillating arm stands still for an instant, but not again a tenth of a second later.
        """
        return self._n_still >= 2 and self._time > 0.0

    def episode(self) -> Episode:
        """Return what happened."""
        return self._recorder.episode(is_stopped=self.is_stopped)

    def _decide(self, time: float) -> None:
        """Tick the tree, pass its demands on, and start a trajectory if it changed its goal."""
        context, generator, controller = self._context, self._generator, self._controller
        context.forget_demands()
        status = self._tree.tick(context)
        if status is not Status.RUNNING:
            self._is_tree_done = True
            context.forget_demands()
            if status is Status.SUCCESS and self._skill_decides:
                self._recorder.success_time = time
        if context.goal is not generator.goal and context.goal != generator.goal:
            measured = Pose(context.tip, self._simulation.pose_of(TIP).quaternion)
            generator.move_to(context.goal, measured=measured, time=time)
        controller.aim_stiffness(context.stiffness)
        controller.aim_force(context.force)
        generator.set_overlay(context.overlay, time)

    def _advance(self) -> None:
        """Run physics for one tick."""
        model, data = self._model, self._data
        mujoco.mj_step2(model, data)
        mujoco.mj_step(model, data, self._steps_per_tick - 1)
        mujoco.mj_step1(model, data)


def _ignore(time: float) -> None:
    """Show nothing."""
