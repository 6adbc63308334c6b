"""Which evaluations say most about the boundary of what is feasible."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from hypermap_lite.surrogates.kernels import MaternHammingKernel
from hypermap_lite.typing import BoolArray, FloatArray

IndexArray: TypeAlias = NDArray[np.intp]


def telling_rows(X: FloatArray, is_feasible: BoolArray, kernel: MaternHammingKernel, n: int) -> IndexArray:
    """Return the positions of up to n points that say most about the boundary, rising, shape (<= n,).

    All of the rarer kind, or n / 2 of them evenly spaced in time; of the other kind, half are those closest to the
    rarer one by the kernel, half evenly spaced in time.
    """
    if len(X) <= n:
        return np.arange(len(X))
    rare = is_feasible if is_feasible.sum() * 2 <= len(X) else ~is_feasible
    few, many = np.flatnonzero(rare), np.flatnonzero(~rare)
    few = evenly(few, n // 2)
    n_many = n - len(few)
    if len(few):
        closeness = kernel(X[many], X[few]).max(axis=1)
        order = np.argsort(-closeness, kind="stable")
        close, rest = many[order[: n_many // 2]], np.sort(many[order[n_many // 2 :]])
    else:
        close, rest = few, many
    return np.sort(np.concatenate([few, close, evenly(rest, n_many - len(close))]))


def evenly(positions: IndexArray, n: int) -> IndexArray:
    """Return n evenly spaced entries of a longer array, or all of a shorter one."""
    if len(positions) <= n:
        return positions
    return positions[np.linspace(0, len(positions) - 1, n).round().astype(int)]
