"""Time rollouts against real time and against physics alone.

    python benchmarks/rollout_throughput.py [--repeats 31] [--output benchmarks/results]

Times are CPU times of this process (other load on the machine inflates them less than wall-clock) and medians over
the repeats. "Physics alone" replays the recorded inputs of the same rollout by `mj_step`, with nothing else between
the ticks; the two are timed in turn, so that both see the same machine. "Two workers" is wall-clock time: two processes
share the rollouts of one.
"""

from __future__ import annotations

import argparse
import csv
import os
import platform
import statistics
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import mujoco
import numpy as np

from robot_tasks.control import ImpedanceController
from robot_tasks.evaluation import evaluate, load
from robot_tasks.randomization import Variation
from robot_tasks.rollout import TICK, rollout
from robot_tasks.simulation import Simulation
from robot_tasks.tasks import TASKS, Task

# Parameters of a good skill for each task: near the means of the operator's priors.
GOOD_PARAMETERS: dict[str, dict[str, float]] = {
    "peg_insertion": {"PathVelocity": 0.05, "PathDistance": 0.005, "Radius": 0.012, "Force": -7.0},
    "object_pushing": {
        "offset_x_start": 0.09,
        "offset_y_start": 0.15,
        "offset_x_goal": -0.12,
        "offset_y_goal": -0.05,
    },
    "obstacle_avoidance": {
        "mp1_position_y": 0.7,
        "mp1_position_z": 1.1,
        "mp2_position_y": 0.0,
        "mp2_position_z": 1.0,
        "mp2_threshold": 0.95,
        "mp3_threshold": 0.05,
    },
}
# A skill that never comes to rest, for the full length: the peg's search without success.
RESTLESS_PARAMETERS = {"peg_insertion": {"PathVelocity": 0.1, "PathDistance": 0.015, "Radius": 0.02, "Force": -1.0}}
REPLICATES = 7
N_RANDOM = 20
N_PARALLEL = 40
COLUMNS = ("task", "case", "cpu_seconds", "simulated_seconds", "times_real_time", "share_of_physics_alone")
Row = dict[str, str | float]


def cpu_seconds(function: Callable[[], object]) -> float:
    start = time.process_time()
    function()
    return time.process_time() - start


def recorded_inputs(
    task: Task, parameters: Mapping[str, float], variation: Variation, simulation: Simulation
) -> list[tuple[np.ndarray, ...]]:
    """Run a full rollout and return what the controller wrote at each tick: controls, torques, gains."""
    data, model, inputs = simulation.data, simulation.model, []
    update = ImpedanceController.update

    def recording_update(self: ImpedanceController, *arguments: object) -> None:
        update(self, *arguments)
        fields = data.ctrl, data.qfrc_applied, model.actuator_gainprm, model.actuator_biasprm
        inputs.append(tuple(field.copy() for field in fields))

    ImpedanceController.update = recording_update
    try:
        rollout(task, parameters, variation, simulation, stop_when_still=False)
    finally:
        ImpedanceController.update = update
    return inputs


def replay(variation: Variation, simulation: Simulation, inputs: list[tuple[np.ndarray, ...]]) -> np.ndarray:
    """Run physics alone on recorded inputs and return the final positions."""
    model, data = simulation.model, simulation.data
    variation.apply(simulation)
    n_steps = round(TICK / model.opt.timestep)
    gains = None
    for ctrl, torques, gainprm, biasprm in inputs:
        data.ctrl[:], data.qfrc_applied[:] = ctrl, torques
        if biasprm is not gains:
            model.actuator_gainprm[:], model.actuator_biasprm[:], gains = gainprm, biasprm, biasprm
        mujoco.mj_step(model, data, n_steps)
    return data.qpos.copy()


def share_gains(inputs: list[tuple[np.ndarray, ...]]) -> list[tuple[np.ndarray, ...]]:
    """Let ticks with the same gains hold the same arrays, so that a replay writes them only when they change."""
    shared = inputs[:1]
    for tick in inputs[1:]:
        same = all(np.array_equal(a, b) for a, b in zip(tick[2:], shared[-1][2:], strict=True))
        shared.append(tick[:2] + shared[-1][2:] if same else tick)
    return shared


def measure_good_skill(task: Task, repeats: int) -> list[Row]:
    """Time one good skill: at full length, replayed, and with its early end."""
    parameters, simulation = GOOD_PARAMETERS[task.name], load(task)
    variation = task.randomization.nominal(next(iter(task.randomization.starts)))
    inputs = share_gains(recorded_inputs(task, parameters, variation, simulation))
    final_positions = simulation.data.qpos.copy()
    if not np.array_equal(replay(variation, simulation, inputs), final_positions):
        raise RuntimeError(f"{task.name}: the replay ended elsewhere than the rollout: it timed something else")
    full, physics, early = [], [], []
    for _ in range(repeats):
        full.append(cpu_seconds(lambda: rollout(task, parameters, variation, simulation, stop_when_still=False)))
        physics.append(cpu_seconds(lambda: replay(variation, simulation, inputs)))
        early.append(cpu_seconds(lambda: rollout(task, parameters, variation, simulation)))
    share = statistics.median(p / f for p, f in zip(physics, full, strict=True))
    rows = [
        row(task, "physics alone, full length", statistics.median(physics), task.duration, 1.0),
        row(task, "rollout, full length", statistics.median(full), task.duration, share),
        row(task, "rollout with early end", statistics.median(early), task.duration),
    ]
    if task.name in RESTLESS_PARAMETERS:
        restless = RESTLESS_PARAMETERS[task.name]
        times = [cpu_seconds(lambda: rollout(task, restless, variation, simulation)) for _ in range(repeats)]
        rows.append(row(task, "rollout that searches to the end", statistics.median(times), task.duration))
    return rows


def measure_workers(task: Task, repeats: int) -> list[Row]:
    """Time the same rollouts by one process and by two, on the wall clock."""
    jobs = [(task.name, GOOD_PARAMETERS[task.name], seed) for seed in range(N_PARALLEL)]
    walls: dict[int, list[float]] = {1: [], 2: []}
    with ProcessPoolExecutor(1) as one, ProcessPoolExecutor(2) as two:
        pools = {1: one, 2: two}
        for repeat in range(1 + min(repeats, 5)):  # the first round starts the processes and loads the scenes
            for n_workers, pool in pools.items():
                start = time.perf_counter()
                list(pool.map(run_job, jobs, chunksize=N_PARALLEL // 4))
                if repeat:
                    walls[n_workers].append(time.perf_counter() - start)
    gain = statistics.median(a / b for a, b in zip(walls[1], walls[2], strict=True))
    simulated = N_PARALLEL * task.duration
    return [
        row(task, f"{N_PARALLEL} rollouts, one worker", statistics.median(walls[1]), simulated),
        row(task, f"{N_PARALLEL} rollouts, two workers: {gain:.2f} x one", statistics.median(walls[2]), simulated),
    ]


def run_job(job: tuple[str, Mapping[str, float], int]) -> float:
    name, parameters, seed = job
    return evaluate(name, parameters, seed)["success"]


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
seconds are those the episode stands for, early end or not. Physics alone replays the same inputs by `mj_step` and ends
in the same bits. The rows with workers are wall-clock seconds, medians of 5.

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
        rows += measure_good_skill(TASKS[name], options.repeats)
        rows += measure_configurations(TASKS[name]) + measure_workers(TASKS[name], options.repeats)
    print(as_markdown(rows))
    write_results(rows, options.repeats, options.output)


if __name__ == "__main__":
    main()
