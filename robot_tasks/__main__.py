"""Command line: ``python -m robot_tasks list | show TASK | evaluate TASK ... | render TASK ... --output FILE``."""

from __future__ import annotations

import argparse
import csv
import json
import os
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Final

from robot_tasks.errors import MissingPackageError, RobotTasksError

if TYPE_CHECKING:  # both load MuJoCo, for which --help does not wait
    from robot_tasks.randomization import Randomization
    from robot_tasks.tasks import Task

WIDTH: Final = 110
"""Columns of what `show` prints."""
_GAP_UNITS: Final = {
    "friction": "times",
    "payload": "kg",
    "joint_damping": "Nms/rad",
    "joint_stiction": "Nm",
    "command_delay": "s",
    "sensing_delay": "s",
    "offsets": "m",
    "force_compensation": "N",
    "force_limit": "N",
}
_LONG_NUMBER: Final = re.compile(r"\d+\.\d{5,}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code: 0, 2 for a usage error, 130 after Ctrl-C."""
    options = _parser().parse_args(arguments)
    try:
        for line in options.run(options):
            print(line)
        sys.stdout.flush()
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
        return 130
    except BrokenPipeError:  # whoever read, such as `head`, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except ModuleNotFoundError as error:
        if error.name != "mujoco":
            raise
        print(f"error: {MissingPackageError('mujoco')}", file=sys.stderr)
        return 2
    except (RobotTasksError, OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m robot_tasks", description="Robot tasks to tune.")
    commands = parser.add_subparsers(required=True)
    commands.add_parser("list", help="list the tasks").set_defaults(run=_list)
    show = commands.add_parser("show", help="show parameters, objectives, circumstances and skill of a task")
    show.set_defaults(run=_show)
    evaluate = commands.add_parser("evaluate", help="run one rollout and print its numbers as one JSON object")
    evaluate.set_defaults(run=_evaluate)
    render = commands.add_parser("render", help="run one rollout and write a clip of it, or a strip of frames")
    render.set_defaults(run=_render)
    for command in (show, evaluate, render):
        _add_configuration(command)
    for command in (evaluate, render):
        command.add_argument("--seed", type=_seed, default=0, help="start state and places of bodies (default 0)")
    _add_picture(render)
    return parser


def _add_configuration(command: argparse.ArgumentParser) -> None:
    command.add_argument("task", metavar="TASK")
    command.add_argument(
        "--parameters", metavar="FILE", help="JSON object of numbers (- reads standard input), or a run's pareto.csv"
    )
    command.add_argument("--trial", type=int, metavar="N", help="which row of a CSV file")
    command.add_argument(
        "--set", dest="settings", action="append", default=[], metavar="NAME=VALUE", help="one number; overrides FILE"
    )
    variant = command.add_mutually_exclusive_group()
    variant.set_defaults(variant="paper")
    choices = (
        ("--as-published-code", "published_code", "where paper and code differ, take the code"),
        ("--real", "real", "take the stand-in for the real robot"),
    )
    for flag, name, text in choices:
        variant.add_argument(flag, dest="variant", action="store_const", const=name, help=text)


def _add_picture(command: argparse.ArgumentParser) -> None:
    command.add_argument("--output", required=True, type=Path, metavar="FILE", help="clip.mp4, or strip.png")
    command.add_argument("--camera", default="front", help="camera of the scene (default front)")
    command.add_argument("--width", type=int, default=480, help="of a frame, in pixels (default 480)")
    command.add_argument("--height", type=int, default=360, help="of a frame, in pixels (default 360)")
    command.add_argument("--fps", type=int, default=20, help="frames per second of a clip (default 20)")
    command.add_argument("--speed", type=float, default=1.0, help="of a clip: 2 is twice as fast as life (default 1)")
    command.add_argument("--frames", type=int, default=6, help="number of frames of a strip (default 6)")


def _seed(text: str) -> int:
    if not text.strip().lstrip("-").isdigit():
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number")
    if int(text) < 0:
        raise argparse.ArgumentTypeError(f"{text} is negative; give 0 or more")
    return int(text)


def _list(options: argparse.Namespace) -> Iterator[str]:
    from robot_tasks.tasks import TASKS

    for task in TASKS.values():
        yield f"{task.name}  {task.description}"


def _show(options: argparse.Namespace) -> Iterator[str]:
    from robot_tasks.evaluation import find_task

    task = find_task(options.task, options.variant)
    middle = {parameter.name: 0.5 * (parameter.low + parameter.high) for parameter in task.parameters}
    configuration = task.check(middle | _configuration(options))
    for paragraph in (
        [f"{task.name}: {task.description}"],
        _parameters(task),
        *_objectives(task),
        _circumstances(task.randomization),
        *_gap(task),
        *_skill(task, configuration),
    ):
        yield from paragraph
        yield ""


def _evaluate(options: argparse.Namespace) -> Iterator[str]:
    from robot_tasks.evaluation import evaluate

    numbers = evaluate(options.task, _configuration(options), options.seed, variant=options.variant)
    yield json.dumps(numbers)


def _render(options: argparse.Namespace) -> Iterator[str]:
    wanted = os.environ.pop("MUJOCO_GL", None)  # a backend that is not installed would break the import of MuJoCo
    from robot_tasks.evaluation import find_task
    from robot_tasks.offscreen import View
    from robot_tasks.render import outcome, render_clip, render_strip

    if wanted is not None:
        os.environ["MUJOCO_GL"] = wanted
    rollout = {"seed": options.seed, "variant": options.variant}
    view = View(camera=options.camera, width=options.width, height=options.height)
    task, path, configuration = options.task, options.output, _configuration(options)
    if path.suffix.lower() == ".png":
        numbers = render_strip(task, configuration, path, **rollout, view=view, frames=options.frames)
    else:
        numbers = render_clip(task, configuration, path, **rollout, view=view, fps=options.fps, speed=options.speed)
    yield f"{path}: {outcome(find_task(task, options.variant), numbers)}"


def _configuration(options: argparse.Namespace) -> dict[str, float]:
    """Read the values of a file, if one is given, and override them by single settings; a task checks them."""
    configuration = _read_parameters(options) if options.parameters else {}
    for setting in options.settings:
        name, _, value = setting.partition("=")
        try:
            configuration[name] = float(value)
        except ValueError as error:
            raise ValueError(
                f"--set {setting}: no number after '='. Give NAME=VALUE, as in mp2_threshold=0.9."
            ) from error
    return configuration


def _read_parameters(options: argparse.Namespace) -> dict[str, float]:
    if not options.parameters.lower().endswith(".csv"):
        return _read_json(options.parameters)
    from robot_tasks.evaluation import find_task

    names = [parameter.name for parameter in find_task(options.task, options.variant).parameters]
    return _read_trial(options.parameters, options.trial, names)


def _read_trial(file: str, trial: int | None, names: Sequence[str]) -> dict[str, float]:
    """Read the parameters of one row of a history or a front."""
    with Path(file).open(newline="", encoding="utf-8") as lines:
        rows = {row.get("trial", str(position)): row for position, row in enumerate(csv.DictReader(lines))}
    if trial is None and len(rows) == 1:
        trial = int(next(iter(rows)))
    if str(trial) not in rows:
        problem = "which row?" if trial is None else f"no trial {trial}."
        raise ValueError(f"{file}: {problem} Give --trial with one of {', '.join(rows)}.")
    row = rows[str(trial)]
    missing = [name for name in names if not row.get(name)]
    if missing:
        raise ValueError(f"{file}: no column {', '.join(missing)}. Give the file of a run of this task.")
    return {name: float(row[name]) for name in names}


def _read_json(file: str) -> dict[str, float]:
    text = sys.stdin.read() if file == "-" else Path(file).read_text(encoding="utf-8")
    try:
        configuration = json.loads(text)
    except json.JSONDecodeError as error:
        raise ValueError(f"{file}: not JSON: {error}. Give an object of parameter names and numbers.") from error
    if not isinstance(configuration, dict):
        raise ValueError(
            f"{file}: got a {type(configuration).__name__}. Give an object of parameter names and numbers."
        )
    return configuration


def _parameters(task: Task) -> Iterator[str]:
    yield "parameters to tune"
    width = max(len(parameter.name) for parameter in task.parameters)
    for parameter in task.parameters:
        bounds = f"[{parameter.low:g}, {parameter.high:g}] {parameter.unit}"
        yield f"  {parameter.name:<{width}}  {bounds:<16} {parameter.description}"


def _objectives(task: Task) -> Iterator[list[str]]:
    for name, terms in task.objectives.items():
        lines = [f"objective {name} (to be maximized), sum over {task.duration:g} s at 10 Hz of"]
        for term in terms:
            lines += _folded(f"{term.weight:g} x {term.name} = {term.reward}", indent=2)
            lines += _folded(_summary(term.reward), indent=6, hanging=0)
        yield lines


def _circumstances(randomization: Randomization) -> Iterator[str]:
    """Tell what a seed chooses."""
    yield "randomized, by the seed"
    yield "  one of these start states, joint angles in [rad]"
    for name, angles in randomization.starts.items():
        yield f"    {name}  {'  '.join(f'{angle:5.2f}' for angle in angles)}"
    for field in fields(randomization):
        if field.name != "starts":
            for thing in getattr(randomization, field.name):
                yield from _folded(str(thing), indent=2)
                yield from _folded(_summary(thing), indent=6, hanging=0)


def _gap(task: Task) -> Iterator[list[str]]:
    """Tell what a stand-in does differently, and which of its numbers an optimizer cannot know."""
    nothing = type(task.gap)()
    differences = [
        f"  {field.name:<18}  {getattr(task.gap, field.name)} {_GAP_UNITS.get(field.name, '')}".rstrip()
        for field in fields(task.gap)
        if getattr(task.gap, field.name) != getattr(nothing, field.name)
    ]
    if differences:
        yield ["stand-in for the real robot: differences unknown to the optimizer", *differences]


def _skill(task: Task, configuration: Mapping[str, float]) -> Iterator[list[str]]:
    from robot_tasks.skills.drawing import describe, draw, skills_in

    tree = task.build_tree(configuration)
    values = ", ".join(f"{name} {value:g}" for name, value in configuration.items())
    yield [*_folded(f"behaviour tree, with {values}", indent=0), *(f"  {line}" for line in draw(tree).splitlines())]
    for skill in skills_in(tree):
        yield [f"skill {line}" if position == 0 else line for position, line in enumerate(describe(skill.description))]
    success = "the skill succeeds" if task.final_condition is None else f"at the end {task.final_condition}"
    yield [f"success: {success}"]


def _summary(thing: object) -> str:
    """Return the first line of the docstring of what something is."""
    return (type(thing).__doc__ or "").partition("\n")[0]


def _folded(text: str, *, indent: int, hanging: int = 4) -> list[str]:
    """Break a long line, its numbers shortened to four digits."""
    text = _LONG_NUMBER.sub(lambda number: f"{float(number[0]):.4g}", text)
    return wrap(text, WIDTH, initial_indent=" " * indent, subsequent_indent=" " * (indent + hanging))


if __name__ == "__main__":
    sys.exit(main())
