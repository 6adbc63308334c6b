"""One-exchange steps: every point that differs from a given one along a single axis."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import combinations

import numpy as np

from hypermap_lite.space.parameter import Parameter
from hypermap_lite.space.permutation import PermutationParameter
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import BoolArray, FloatArray

FEW_LEVELS = 16
"""A discrete axis with at most so many levels is tried whole, another by steps in both directions."""

LEVEL_STEP_GROWTH = 4
"""Steps along an axis of many levels are 1, 4, 16, ... levels in both directions."""

REAL_STEPS = (0.1, 0.03, 0.01, 0.003, 0.001)
"""Steps along an axis tried in both directions, in units of the cube."""

SIGNED_STEPS = np.sort([sign * step for step in REAL_STEPS for sign in (-1.0, 1.0)])

SHORT_STEPS = (0.03, 0.003)
"""Steps along two axes at once, each tried in both directions, in units of the cube."""

MAX_MOVES = 100


def axis_neighbours(parameter: Parameter, code: float) -> FloatArray:
    """Return the codes one exchange away from a code on one axis, both directions, shape (k,)."""
    if isinstance(parameter, PermutationParameter):
        return parameter.neighbours(code)
    around = np.minimum(np.maximum(code + SIGNED_STEPS, 0.0), 1.0)
    if parameter.n_levels is None:
        return around
    level = int(parameter.level_index(np.array([code]))[0])
    if parameter.n_levels <= FEW_LEVELS or not parameter.is_ordered:
        levels = np.arange(parameter.n_levels)
    else:
        sizes = LEVEL_STEP_GROWTH ** np.arange(int(math.log(parameter.n_levels, LEVEL_STEP_GROWTH)) + 1)
        levels = np.concatenate([level - sizes, level + sizes, parameter.level_index(around)])
        levels = np.unique(levels[(levels >= 0) & (levels < parameter.n_levels)])
    return parameter.codes_of_levels(levels[levels != level])


def neighbours(space: SearchSpace, x: FloatArray, axes: BoolArray) -> FloatArray:
    """Return all allowed points one exchange away from x along the chosen axes, shape (k, d).

    With constraints also points two exchanges away, along pairs of axes that a constraint ties together.
    """
    rows = []
    for j in np.flatnonzero(axes):
        codes = axis_neighbours(space.parameters[j], float(x[j]))
        moved = np.repeat(x[None], len(codes), axis=0)
        moved[:, j] = codes
        rows.append(moved)
    rows += [_both_moved(space, x, i, j) for i, j in _tied_pairs(space, axes)]
    return space.keep_allowed(np.vstack(rows)) if rows else np.empty((0, len(x)))


def _tied_pairs(space: SearchSpace, axes: BoolArray) -> list[tuple[int, int]]:
    """Return the pairs of chosen axes that stand in one constraint."""
    if not space.constraints:
        return []
    chosen = [int(j) for j in np.flatnonzero(axes)]
    names = space.names
    return [
        (i, j)
        for i, j in combinations(chosen, 2)
        if any({names[i], names[j]} <= constraint.names for constraint in space.constraints)
    ]


def _both_moved(space: SearchSpace, x: FloatArray, i: int, j: int) -> FloatArray:
    """Return the points that differ from x by a short step along both of two axes, shape (k, d)."""
    a, b = (_short_steps(space.parameters[axis], float(x[axis])) for axis in (i, j))
    moved = np.repeat(x[None], len(a) * len(b), axis=0)
    moved[:, i], moved[:, j] = np.repeat(a, len(b)), np.tile(b, len(a))
    return moved


def _short_steps(parameter: Parameter, code: float) -> FloatArray:
    """Return the codes of some close values of one axis, or of all other levels if they are few and without order."""
    if parameter.n_levels is None:
        return np.clip(code + np.array([sign * step for step in SHORT_STEPS for sign in (-1.0, 1.0)]), 0.0, 1.0)
    if isinstance(parameter, PermutationParameter):
        return parameter.neighbours(code)
    level = int(parameter.level_index(np.array([code]))[0])
    levels = np.array([level - 1, level + 1])
    if parameter.n_levels <= FEW_LEVELS and not parameter.is_ordered:
        levels = np.arange(parameter.n_levels)
    levels = levels[(levels >= 0) & (levels < parameter.n_levels) & (levels != level)]
    return parameter.codes_of_levels(levels)


def climb(
    space: SearchSpace,
    score_of: Callable[[FloatArray], FloatArray],
    starts: FloatArray,
    axes: BoolArray,
    *,
    tolerance: float = 0.0,
) -> tuple[FloatArray, FloatArray]:
    """Move each start to its best one-exchange neighbour along the chosen axes until none is better by a tolerance.

    The climbs know nothing of each other; their neighbours are scored together, since a score of a few points costs
    little less than that of many.

    Parameters
    ----------
    space, score_of
        Where to climb, and how high n points are, shape (n, d) to (n,).
    starts
        Allowed points, shape (k, d).
    axes
        Those to step along, shape (d,).
    tolerance
        A climb ends where its best step gains no more.

    Returns
    -------
    tuple
        The points, shape (k, d), and their scores, shape (k,).
    """
    X, heights = starts.copy(), np.array(score_of(starts))
    climbing = list(range(len(X)))
    for _ in range(MAX_MOVES):
        around = {i: points for i in climbing if len(points := neighbours(space, X[i], axes))}
        if not around:
            break
        scores = np.split(score_of(np.vstack([*around.values()])), np.cumsum([len(p) for p in around.values()])[:-1])
        climbing = []
        for (i, points), there in zip(around.items(), scores, strict=True):
            best = int(np.argmax(there))
            gain = there[best] - heights[i]
            if there[best] > heights[i]:
                X[i], heights[i] = points[best], there[best]
                if not gain <= tolerance:
                    climbing.append(i)
    return X, heights
