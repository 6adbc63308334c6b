"""Which part of the plane of two objectives a panel shows, and how it marks what lies outside."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from matplotlib.axes import Axes

from hypermap_lite.typing import BoolArray, FloatArray

MARGIN: Final = 0.06
"""Empty border around what must be seen, as a fraction of its range."""

REACH: Final = 1.0
"""How far beyond the core of the points, in core ranges, a point may lie and still widen the view."""

INSET: Final = 0.014
"""Distance from the border of the marks for points outside, as a fraction of the view."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class View:
    """The limits of a panel."""

    low: FloatArray
    """Lower ends of both axes, shape (2,)."""

    high: FloatArray

    def contains(self, points: FloatArray) -> BoolArray:
        """Tell which of n points, shape (n, 2), are in view, shape (n,)."""
        return np.array(((self.low <= points) & (points <= self.high)).all(axis=1), dtype=bool)

    def apply(self, axes: Axes) -> None:
        """Fix the limits of a panel."""
        axes.set_xlim(self.low[0], self.high[0])
        axes.set_ylim(self.low[1], self.high[1])

    def draw_outside(self, axes: Axes, points: FloatArray, colour: str) -> int:
        """Mark the points outside by triangles at the border that point to them, and return how many there are.

        Parameters
        ----------
        axes
            The panel, with these limits.
        points
            Shape (n, 2).
        colour
            Of the triangles.
        """
        points = points[~self.contains(points)]
        size = self.high - self.low
        excess = np.maximum(self.low - points, points - self.high) / size  # negative inside
        direction = 2 * excess.argmax(axis=1) + (points > self.high)[np.arange(len(points)), excess.argmax(axis=1)]
        at = np.clip(points, self.low + INSET * size, self.high - INSET * size)
        for code, shape in enumerate("<>v^"):
            axes.plot(
                *at[direction == code].T,
                linestyle="none",
                marker=shape,
                markersize=6,
                markerfacecolor=colour,
                markeredgecolor="white",
                markeredgewidth=0.6,
                zorder=6,
            )
        return len(points)


def robust_view(important: FloatArray, others: FloatArray) -> View:
    """Choose a view that holds all important points, and the others unless they are few and far away.

    An outlier is further from the core of the points than `REACH` times its range, in one objective or both. The core
    is what the important points and the middle half of all points span.

    Parameters
    ----------
    important
        Points that must be in view, shape (k, 2), k >= 1.
    others
        Points that may be left out, shape (n, 2).

    Returns
    -------
    View
        With a `MARGIN` around all that it was made for.
    """
    quartiles = np.quantile(np.vstack([important, others]), [0.25, 0.75], axis=0)
    core = np.vstack([important, quartiles])
    reach = REACH * _extent(core)
    is_near = ((core.min(axis=0) - reach <= others) & (others <= core.max(axis=0) + reach)).all(axis=1)
    shown = np.vstack([important, others[is_near]])
    margin = MARGIN * _extent(shown)
    return View(low=shown.min(axis=0) - margin, high=shown.max(axis=0) + margin)


def _extent(points: FloatArray) -> FloatArray:
    """Return the range of the points in each objective, shape (2,); where it is zero, the size of the value."""
    low, high = points.min(axis=0), points.max(axis=0)
    return np.where(high > low, high - low, np.maximum(np.abs(high), 1.0))
