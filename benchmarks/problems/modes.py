"""Skills of which the front needs two kinds of outcomes, with a cliff between them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from .base import FloatArray, Problem, real_parameters

OBJECT = np.array([0.62, 0.35, 0.55])
IN_REACH = 0.3
"""Distance from the object up to which the hand gets hold of it."""

ENOUGH_GRIP = 0.25


def giving_up(X: FloatArray) -> FloatArray:
    """Return the loss and the effort of a grasp that may give up, both to be small, shape (n, 2).

    It gets hold of the object where x1 to x3 are within `IN_REACH` of it, d away, and the grip x4 is enough, in 8 % of
    the cube; then

        loss   = -1 + 0.6 (1 - x5)^2 + 2 d^2 + 0.2 (x6 - 0.3)^2
        effort = 0.5 + 0.6 x5^2 + 0.4 (x4 - ENOUGH_GRIP) + 0.2 (x6 - 0.7)^2

    and elsewhere it gives up: loss 0, effort 0.15 + 0.15 x4 + 0.05 x5.
    """
    d = np.sqrt(((X[:, :3] - OBJECT) ** 2).sum(axis=1))
    x4, x5, x6 = X[:, 3:].T
    holds = (d <= IN_REACH) & (x4 >= ENOUGH_GRIP)
    loss = -1 + 0.6 * (1 - x5) ** 2 + 2 * d**2 + 0.2 * (x6 - 0.3) ** 2
    effort = 0.5 + 0.6 * x5**2 + 0.4 * (x4 - ENOUGH_GRIP) + 0.2 * (x6 - 0.7) ** 2
    given_up = np.column_stack([np.zeros(len(X)), 0.15 + 0.15 * x4 + 0.05 * x5])
    return np.where(holds[:, None], np.column_stack([loss, effort]), given_up)


def gaits(X: FloatArray) -> FloatArray:
    """Return the duration and the effort of a walk in one of two gaits, both to be small, shape (n, 2).

    Where x1 + x2 / 2 + 0.2 sin(6 x3) > 0.65 it is fast and hard, and elsewhere slow and gentle; with
    s = sum_j (xj - 0.45)^2 for j = 4 ... 6,

        fast: duration = 1.5 - 0.5 x1 + 0.6 s,  effort = 2 + 0.7 x1 + 0.3 (x3 - 0.3)^2 + 0.5 s
        slow: duration = 2 + 0.6 x2 + 0.4 s,    effort = 1.5 - 0.5 x2 + 0.3 (x3 - 0.6)^2 + 0.3 s
    """
    x1, x2, x3 = X[:, :3].T
    s = ((X[:, 3:] - 0.45) ** 2).sum(axis=1)
    fast = np.column_stack([1.5 - 0.5 * x1 + 0.6 * s, 2 + 0.7 * x1 + 0.3 * (x3 - 0.3) ** 2 + 0.5 * s])
    slow = np.column_stack([2 + 0.6 * x2 + 0.4 * s, 1.5 - 0.5 * x2 + 0.3 * (x3 - 0.6) ** 2 + 0.3 * s])
    return np.where((x1 + x2 / 2 + 0.2 * np.sin(6 * x3) > 0.65)[:, None], fast, slow)


GIVING_UP = Problem(
    function=giving_up,
    parameters=real_parameters([(0, 1)] * 6),
    reference_point=(0.2, 1.2),
    best=0.7 - 1.264 * 0.632 / 12 + 0.21,
)
"""With t from 0 to 1 the front of successes is loss = -1 + 0.632 t^2, effort = 0.5 + 0.632 (1 - t)^2: x5 = 1 - t and
x6 = 0.3 + 0.4 (1 - t) are the best trade-offs. Giving up with the least effort adds 0.2 (1.2 - 0.15)."""

GAITS = Problem(
    function=gaits, parameters=real_parameters([(0, 1)] * 6), reference_point=(3.0, 3.0), best=0.325 + 0.5 + 1.05 + 0.8
)
"""Fast, the efforts are 2 to 2.7 at durations of 1.5 to 1; slow, 1.5 to 1 at durations of 2 to 2.6."""

MODES: Mapping[str, Problem] = {"giving_up": GIVING_UP, "gaits": GAITS, "gaits_noisy": replace(GAITS, noise=0.1)}
