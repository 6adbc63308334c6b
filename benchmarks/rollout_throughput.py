"""Time rollouts against real time and against physics alone.

    python benchmarks/rollout_throughput.py [--repeats 31] [--output benchmarks/results]

Times are CPU times of this process (other load on the machine inflates them less than wall-clock) and medians over
the repeats. "Physics alone" replays the recorded controls of the same rollout by `mujoco.rollout` in C, without a
line of Python between the steps; the two are timed in turn, so that both see the same machine.
"""

from __future__ import annotations

import argparse
import csv
import os
import platform
import statistics
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import mujoco
import mujoco.rollout
import numpy as np

from robot_tasks.control import ImpedanceController
from robot_tasks.evaluation import evaluate
from robot_tasks.randomization import Variation
from robot_tasks.rollout import TICK, rollout
from robot_tasks.simulation import Simulation
from robot_tasks.tasks import TASKS, Task

# Parameters of a good skill for each task: the means of the operator's priors.
GOOD_PARAMETERS: dict[str, dict[str, float]] = {
    "obstacle_avoidance": {
        "mp1_position_y": 0.7,
        "mp1_position_z": 1.1,
        "mp2_position_y": 0.0,
        "mp2_position_z": 1.0,
        "mp2_threshold": 0.95,
        "mp3_threshold": 0.05,
    }
}
REPLICATES = 7
N_RANDOM = 20
COLUMNS = ("task", "case", "cpu_seconds", "simulated_seconds", "times_real_time", "share_of_physics_alone")
_REPLAYED = mujoco.mjtState.mjSTATE_CTRL | mujoco.mjtState.mjSTATE_QFRC_APPLIED

Row = dict[str, str | float]


def cpu_seconds(function: Callable[[], object]) -> float:
    start = time.process_time()
    function()
    return time.process_time() - start


def recorded_controls(
    task: Task, parameters: Mapping[str, float], variation: Variation, simulation: Simulation
) -> np.ndarray:
    """Run a full rollout and return the inputs of each physics step, shape (1, n_steps, n_inputs)."""
    inputs = []
    update = ImpedanceController.update

    def recording_update(self: ImpedanceController, *arguments: object) -> None:
        update(self, *arguments)
        state = np.empty(mujoco.mj_stateSize(simulation.model, _REPLAYED))
        mujoco.mj_getState(simulation.model, simulation.data, state, _REPLAYED)
        inputs.append(state)

    ImpedanceController.update = recording_update
    try:
        rollout(task, parameters, variation, simulation, stop_when_still=False)
    finally:
        ImpedanceController.update = update
    return np.repeat(np.array(inputs), round(TICK / simulation.model.opt.timestep), axis=0)[None]


def replay(variation: Variation, simulation: Simulation, controls: np.ndarray) -> np.ndarray:
    """Run physics alone on recorded inputs and return the final joint angles."""
    variation.apply(simulation)
    specification = mujoco.mjtState.mjSTATE_FULLPHYSICS
    initial = np.empty(mujoco.mj_stateSize(simulation.model, specification))
    mujoco.mj_getState(simulation.model, simulation.data, initial, specification)
    states, _ = mujoco.rollout.rollout(
        simulation.model, simulation.data, initial, controls, control_spec=int(_REPLAYED), nstep=controls.shape[1]
    )
    return states[0, -1, 1 : 1 + simulation.model.nq]


def measure_good_skill(task: Task, repeats: int) -> list[Row]:
    """Time one good skill: at full length, replayed, and with its early end."""
    parameters, simulation = GOOD_PARAMETERS[task.name], Simulation.from_scene(task.scene)
    variation = task.randomization.nominal(next(iter(task.randomization.starts)))
    controls = recorded_controls(task, parameters, variation, simulation)
    final_joints = simulation.data.qpos.copy()
    if not np.array_equal(replay(variation, simulation, controls), final_joints):
        raise RuntimeError("the replay ended elsewhere than the rollout: it timed something else")
    full, physics, early = [], [], []
    for _ in range(repeats):
        full.append(cpu_seconds(lambda: rollout(task, parameters, variation, simulation, stop_when_still=False)))
        physics.append(cpu_seconds(lambda: replay(variation, simulation, controls)))
        early.append(cpu_seconds(lambda: rollout(task, parameters, variation, simulation)))
    share = statistics.median(p / f for p, f in zip(physics, full, strict=True))
    return [
        row(task, "physics alone, full length", statistics.median(physics), task.duration, 1.0),
        row(task, "rollout, full length", statistics.median(full), task.duration, share),
        row(task, "rollout with early end", statistics.median(early), task.duration),
    ]


def measure_configurations(task: Task) -> list[Row]:
    """Time what an optimizer pays per configuration, for the good skill and for random ones."""
    rng = np.random.default_rng(0)
    random = [{p.name: rng.uniform(p.low, p.high) for p in task.parameters} for _ in range(N_RANDOM)]
    rows = []
    for case, configurations in (("good skill", [GOOD_PARAMETERS[task.name]] * 5), ("random parameters", random)):
        times = [
            cpu_seconds(lambda c=c: [evaluate(task.name, c, seed) for seed in range(REPLICATES)])
            for c in configurations
        ]
        rows.append(row(task, f"{REPLICATES} rollouts, {case}", statistics.median(times), REPLICATES * task.duration))
    return rows


def row(task: Task, case: str, seconds: float, simulated: float, share: float | None = None) -> Row:
    return {
        "task": task.name,
        "case": case,
        "cpu_seconds": round(seconds, 4),
        "simulated_seconds": simulated,
        "times_real_time": round(simulated / seconds),
        "share_of_physics_alone": "" if share is None else round(share, 3),
    }


def as_markdown(rows: list[Row]) -> str:
    lines = ["| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    lines += ["| " + " | ".join(str(row[column]) for column in COLUMNS) + " |" for row in rows]
    return "\n".join(lines)


def write_results(rows: list[Row], repeats: int, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "rollout_throughput.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    load = os.getloadavg()[0]
    machine = f"{platform.machine()}, {os.cpu_count()} cores, load average {load:.1f} at the end"
    versions = f"Python {platform.python_version()}, mujoco {mujoco.__version__}, numpy {np.__version__}"
    page = f"""# Rollout throughput

    python benchmarks/rollout_throughput.py --repeats {repeats}

{versions}; {machine}.
CPU seconds on one core, medians of {repeats} repeats ({N_RANDOM} configurations for the random parameters). Simulated
seconds are those the episode stands for, early end or not. Physics alone replays the same inputs in C, without Python
between the steps, and ends in the same bits.

{as_markdown(rows)}
"""
    (folder / "rollout_throughput.md").write_text(page, encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=31)
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    options = parser.parse_args()
    rows = []
    for name in GOOD_PARAMETERS:
        rows += measure_good_skill(TASKS[name], options.repeats) + measure_configurations(TASKS[name])
    print(as_markdown(rows))
    write_results(rows, options.repeats, options.output)


if __name__ == "__main__":
    main()
