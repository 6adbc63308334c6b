"""Command line: ``python -m robot_tasks list | show TASK | evaluate TASK --parameters FILE [--seed N]``."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from robot_tasks.errors import RobotTasksError
from robot_tasks.tasks import TASKS, Task


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code: 0, or 2 for a usage error."""
    options = _parser().parse_args(arguments)
    try:
        if options.command == "list":
            print(*(f"{task.name}  {task.description}" for task in TASKS.values()), sep="\n")
        elif options.command == "show":
            print(*_describe(_task(options.task)), sep="\n")
        else:
            print(json.dumps(_evaluate(options.task, options.parameters, options.seed)))
    except (RobotTasksError, OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m robot_tasks", description="Robot tasks to tune.")
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("list", help="list the tasks")
    show = commands.add_parser("show", help="show parameters, objectives and reward terms of a task")
    show.add_argument("task")
    evaluate = commands.add_parser("evaluate", help="run one rollout and print its numbers as one JSON object")
    evaluate.add_argument("task")
    evaluate.add_argument("--parameters", required=True, metavar="FILE", help="JSON object; - reads standard input")
    evaluate.add_argument("--seed", type=int, default=0, help="start state and offsets of bodies (default 0)")
    return parser


def _task(name: str) -> Task:
    from robot_tasks.evaluation import find_task

    return find_task(name)


def _evaluate(task: str, file: str, seed: int) -> Mapping[str, float]:
    from robot_tasks.evaluation import evaluate

    text = sys.stdin.read() if file == "-" else Path(file).read_text(encoding="utf-8")
    try:
        configuration = json.loads(text)
    except json.JSONDecodeError as error:
        raise ValueError(f"{file}: not JSON: {error}. Give an object of parameter names and numbers.") from error
    if not isinstance(configuration, dict):
        raise ValueError(
            f"{file}: got a {type(configuration).__name__}. Give an object of parameter names and numbers."
        )
    return evaluate(task, configuration, seed)


def _describe(task: Task) -> list[str]:
    lines = [f"{task.name}: {task.description}", "", "parameters"]
    for parameter in task.parameters:
        bounds = f"[{parameter.low:g}, {parameter.high:g}] {parameter.unit}"
        lines.append(f"  {parameter.name:<16} {bounds:<14} {parameter.description}")
    for name, terms in task.objectives.items():
        lines += ["", f"objective {name} (to be maximized), sum over {task.duration:g} s at 10 Hz of"]
        lines += [f"  {term.weight:g} x {term.name} = {term.reward}" for term in terms]
    return lines


if __name__ == "__main__":
    sys.exit(main())
