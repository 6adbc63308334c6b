"""The table of contenders by name, and what starts them."""

from __future__ import annotations

import functools
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ablations import ABLATIONS, OF_FAILURES, OF_FEASIBILITY, OF_MODES, OF_NOISE, OF_OUTLIERS, OF_TAILS
from contenders import WORKERS, Contender, Ours, Peer, Spread, Task

COMMAND = "#     "
"""What the lines with the commands that make an environment begin with."""


@dataclass(frozen=True, kw_only=True)
class Method:
    """A contender to be."""

    start: Callable[..., Contender]
    """Called with the task, and with ``python`` if there is an environment."""

    environment: str | None = None
    """Name of the package that it needs, of the environment that has it, and of that's list in the folder `peers`."""


def ours(changes: Mapping[str, Any] | None = None, overrides: Sequence[str] = ()) -> Method:
    """Return a variant of this package: parts of a scenario, and changes as on the command line."""
    return Method(start=functools.partial(Ours, changes=changes, overrides=overrides))


def peer(worker: str, algorithm: str) -> Method:
    """Return an algorithm of another package."""
    return Method(start=functools.partial(Peer, worker=worker, algorithm=algorithm), environment=worker)


DEFAULT = "default"
METHODS: Mapping[str, Method] = {
    DEFAULT: ours(),
    "paper preset": ours({"preset": "paper"}),
    "Sobol": Method(start=Spread),
    "random": Method(start=functools.partial(Peer, python=Path(sys.executable), worker="random")),
    "Optuna TPE": peer("optuna", "TPE"),
    "Optuna GP": peer("optuna", "GP"),
    "BoTorch": peer("botorch", ""),
    "SMAC3 forest": peer("smac", "forest"),
    "SMAC3 GP": peer("smac", "GP"),
    "HyperMapper forest": peer("hypermapper", "forest"),
    "HyperMapper GP": peer("hypermapper", "GP"),
    **{
        name: ours(overrides=changes)
        for variants in (ABLATIONS, OF_FEASIBILITY, OF_TAILS, OF_OUTLIERS, OF_FAILURES, OF_MODES, OF_NOISE)
        for name, changes in variants.items()
    },
}
PEERS = tuple(name for name, method in METHODS.items() if method.environment is not None)


@functools.cache
def has_package(python: Path, package: str) -> bool:
    """Tell whether an interpreter is there and can import a package."""
    if not python.exists():
        return False
    return subprocess.run([str(python), "-c", f"import {package}"], capture_output=True).returncode == 0


def starter(name: str, method: Method, environments: Path) -> Callable[[Task], Contender] | str:
    """Return what starts a contender, or how to make the environment that it lacks."""
    if method.environment is None:
        return method.start
    python = environments / method.environment / "bin" / "python"
    if has_package(python, method.environment):
        return functools.partial(method.start, python=python)
    return f"{name} is skipped: {python} cannot import {method.environment}. To make it:\n" + "\n".join(
        f"    {line}" for line in commands(method.environment, environments)
    )


def commands(environment: str, environments: Path) -> list[str]:
    """Return the commands that make an environment: those in the comments of its list of packages."""
    lines = (WORKERS / f"{environment}.txt").read_text(encoding="utf-8").splitlines()
    said = [line.removeprefix(COMMAND) for line in lines if line.startswith(COMMAND)]
    return [line.replace("DIR", str(environments)) for line in said]
