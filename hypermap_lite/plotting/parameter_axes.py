"""Axes that show parameters: which ones, where their values lie on the unit interval, and what the ticks say."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.ticker import MaxNLocator

from hypermap_lite.assembly import build_space
from hypermap_lite.errors import RunFolderError, UsageError, nearest
from hypermap_lite.history.foreign_values import parse_foreign_value
from hypermap_lite.plotting.reference import number
from hypermap_lite.plotting.runs import Run
from hypermap_lite.scenario import load_scenario
from hypermap_lite.space import CategoricalParameter, IntegerParameter, Parameter, RealParameter, SearchSpace
from hypermap_lite.typing import FloatArray, Value

MAX_TICKS: Final = 12
"""An axis of more levels than this has ticks at some of them."""


def space_of(run: Run) -> SearchSpace:
    """Return the search space of a run.

    Raises
    ------
    ScenarioError
        If its ``scenario.json`` is no scenario.
    UsageError
        If nobody said what the parameters of a samples file are.
    """
    if run.samples is None:
        return build_space(load_scenario(run.folder / "scenario.json"))
    if "input_parameters" not in run.scenario:
        raise UsageError(f"{run.samples}: its parameters are not known; give the scenario with --scenario")
    return build_space(load_scenario(run.scenario))


def chosen_axes(names: Sequence[str], space: SearchSpace) -> list[int]:
    """Return the axes of the named parameters, in the order of the names.

    Raises
    ------
    UsageError
        If a name is no parameter's, or stands twice.
    """
    for i, name in enumerate(names):
        if name not in space.names:
            hint = nearest(name, space.names)
            raise UsageError(f"unknown parameter '{name}'; known: {', '.join(space.names)}. {hint}".rstrip())
        if name in names[:i]:
            raise UsageError(f"the parameter '{name}' is given twice")
    return [space.names.index(name) for name in names]


def values_of(run: Run, parameter: Parameter) -> list[Value]:
    """Return the values of one parameter in all evaluations of a run.

    Raises
    ------
    RunFolderError
        If the history holds no such values.
    """
    file = run.samples or run.folder / "history.csv"
    if parameter.name not in run.columns:
        raise RunFolderError(f"{file}: no column '{parameter.name}'; found {', '.join(run.columns)}")
    try:
        return [parse_foreign_value(parameter, row[parameter.name]) for row in run.rows]
    except ValueError as error:
        raise RunFolderError(f"{file}: {error}") from error


def end_codes(parameter: Parameter) -> tuple[float, float]:
    """Return the codes of the first and the last value."""
    if parameter.n_levels is None:
        return 0.0, 1.0
    first, last = parameter.codes_of_levels(np.array([0, parameter.n_levels - 1]))
    return float(first), float(last)


def name_with_scale(parameter: Parameter) -> str:
    """Return what stands at a parameter's axis: its name, and that it is logarithmic if so."""
    is_logarithmic = isinstance(parameter, RealParameter | IntegerParameter) and parameter.log
    return f"{parameter.name} (log)" if is_logarithmic else parameter.name


def text_of(value: Value, digits: int = 4) -> str:
    """Write a value for people, with a true minus sign and so many significant digits."""
    if isinstance(value, tuple):
        return " ".join(map(str, value))
    return value if isinstance(value, str) else number(value, digits).replace("-", "\N{MINUS SIGN}")


def ticks(parameter: Parameter) -> tuple[FloatArray, list[str]]:
    """Return the codes of an axis' ticks and what they say: round numbers, or levels.

    Up to `MAX_TICKS` levels all have a tick, and so has every name; of more numbers some have.
    """
    n = parameter.n_levels
    if isinstance(parameter, RealParameter | IntegerParameter) and (n is None or n > MAX_TICKS):
        values = _round_numbers(parameter)
        return np.array([parameter.locate(value) for value in values]), _texts_of(values, alike=not parameter.log)
    step = 1 if isinstance(parameter, CategoricalParameter) else math.ceil((n or 1) / MAX_TICKS)
    codes = parameter.codes_of_levels(np.arange(0, n or 0, step))
    return codes, [text_of(value) for value in parameter.decode(codes)]


def _texts_of(values: Sequence[float], *, alike: bool) -> list[str]:
    """Write numbers for people, with equally many decimals if they shall look alike."""
    texts = list(map(text_of, values))
    decimals = max((len(text.partition(".")[2]) for text in texts), default=0)
    if not alike or any("e" in text for text in texts):
        return texts
    return [f"{value:.{decimals}f}".replace("-", "\N{MINUS SIGN}") for value in values]


def _round_numbers(parameter: RealParameter | IntegerParameter) -> list[float]:
    """Return some round numbers between the bounds; on a log axis powers of ten, with their double and half if few."""
    low, high = parameter.low, parameter.high
    locator = MaxNLocator(5, steps=[1, 2, 2.5, 5, 10], integer=parameter.n_levels is not None)
    candidates = [float(value) for value in locator.tick_values(low, high)]
    if parameter.log:
        decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
        powers = [float(f"1e{k}") for k in decades]
        within = [power for power in powers if low <= power <= high]
        if len(within) > 2:
            return within[:: math.ceil(len(within) / 6)]
        finer = [factor * power for power in powers for factor in (1, 2, 5) if low <= factor * power <= high]
        candidates = finer if len(finer) > 1 else candidates
    return [value + 0.0 for value in candidates if low <= value <= high]  # no negative zero
