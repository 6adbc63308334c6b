"""From a configuration and a seed to numbers: the only link to an optimizer."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Final

import numpy as np

from robot_tasks.episode import Episode
from robot_tasks.errors import UnknownNameError
from robot_tasks.rollout import rollout
from robot_tasks.simulation import Simulation
from robot_tasks.tasks import PUBLISHED, STAND_INS, TASKS, Task

PAPER: Final = "paper"
VARIANTS: Final[dict[str, Mapping[str, Task]]] = {PAPER: TASKS, "published_code": PUBLISHED, "real": STAND_INS}
"""Tasks as the paper means them; as its published code computes them; on a stand-in for the real robot."""


class _WarmSimulations(threading.local):
    """One simulation per physics, thread and process: loading costs as much as half a second of simulated time."""

    def __init__(self) -> None:
        self._simulations: dict[tuple[str, str], Simulation] = {}

    def get(self, task: Task) -> Simulation:
        key = task.scene, repr(task.gap)
        if key not in self._simulations:
            self._simulations[key] = load(task)
        return self._simulations[key]


_SIMULATIONS: Final = _WarmSimulations()


def find_task(name: str, variant: str = PAPER) -> Task:
    """Look up a task by name, in one of its `VARIANTS`.

    Raises
    ------
    UnknownNameError
        If there is no such task or variant.
    """
    if variant not in VARIANTS:
        raise UnknownNameError("variant", variant, VARIANTS)
    if name not in TASKS:
        raise UnknownNameError("task", name, TASKS)
    if name not in VARIANTS[variant]:
        raise UnknownNameError(f"variant of task '{name}'", variant, variants_of(name))
    return VARIANTS[variant][name]


def variants_of(name: str) -> tuple[str, ...]:
    """List the variants that a task has."""
    return tuple(variant for variant, tasks in VARIANTS.items() if name in tasks)


def load(task: Task, *, timestep: float | None = None) -> Simulation:
    """Load the physics of a task, its reality gap included, with its own or another step in [s]."""
    return Simulation.from_scene(task.scene, timestep=timestep, modify=task.gap.apply)


def evaluate(
    task_name: str, configuration: Mapping[str, float], seed: int = 0, *, variant: str = PAPER
) -> dict[str, float]:
    """Run one rollout and measure it.

    Equal arguments give bit-identical results on one machine, whatever ran before.

    Parameters
    ----------
    task_name
        Name of a task.
    configuration
        Value of every parameter of the task.
    seed
        Chooses start state and offsets of bodies. The same seed means the same circumstances for every configuration.
    variant
        One of `VARIANTS`.

    Returns
    -------
    dict
        Objectives (to be maximized) first, then every reward term, then what `summarize` reports.

    Raises
    ------
    UnknownNameError
        If there is no such task or variant.
    ParameterError
        If the configuration does not fit the task.
    SimulationError
        If the physics diverged or bodies got into each other: the rollout means nothing and has no score.
    """
    task = find_task(task_name, variant)
    parameters = task.check(configuration)
    variation = task.randomization.sample(np.random.default_rng(seed))
    return measure(task, rollout(task, parameters, variation, _SIMULATIONS.get(task)))


def measure(task: Task, episode: Episode) -> dict[str, float]:
    """Compute objectives, reward terms and summary of an episode."""
    terms = {term.name: term.total(episode) for term in task.terms}
    objectives = {name: sum(terms[term.name] for term in members) for name, members in task.objectives.items()}
    return objectives | terms | summarize(episode)


def summarize(episode: Episode) -> dict[str, float]:
    """Reduce an episode to numbers that are worth a column but are no objectives.

    Returns
    -------
    dict
        ``success``: 1 if the task was achieved, else 0. ``time_to_success`` in [s]: the length of the episode if it
        never was. ``touches``: contacts of arm or tool with untouchable things, at least 0.1 s apart.
        ``contact_seconds``: their total time in [s]. ``peak_contact_force``: largest normal force among them in [N].
        ``deepest_penetration``: their largest overlap in [m]. ``clearance``: smallest distance of arm or tool to the
        obstacle, if there is one, in [m], at most 0.5, sampled every 0.1 s. ``tool_peak_force``, ``tool_mean_force``
        in [N] and ``tool_impulse`` in [Ns]: magnitude of the net contact force on the tool, wanted or not; the mean
        over the time in contact. ``commanded_impulse``: integral of the commanded force's magnitude in [Ns].
        ``interventions``: 1 if the operator stopped the robot, which happens on stand-ins only.
        ``simulated_seconds``: time after which nothing moved in [s].
    """
    contact, tool = episode.contact, episode.tool_contact
    clearance = {} if np.isinf(episode.clearance) else {"clearance": episode.clearance}
    commanded = np.sqrt(np.square(episode.commanded_forces[1:]).sum(axis=1))  # (n_steps,)
    duration = float(episode.times[-1])
    return {
        "success": float(episode.is_success),
        "time_to_success": duration if episode.success_time is None else episode.success_time,
        "touches": float(contact.touches),
        "contact_seconds": contact.seconds,
        "peak_contact_force": contact.peak_force,
        "deepest_penetration": contact.deepest_penetration,
        **clearance,
        "tool_peak_force": tool.peak,
        "tool_mean_force": tool.mean,
        "tool_impulse": tool.impulse,
        "commanded_impulse": float(commanded.sum()) * duration / episode.n_steps,
        "interventions": float(episode.interventions),
        "simulated_seconds": episode.simulated_seconds,
    }
