"""The posterior front in a picture: ``posterior_front.csv``, where a run has one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from hypermap_lite.plotting import style
from hypermap_lite.plotting.files import numbers_of, read_rows
from hypermap_lite.plotting.runs import Run
from hypermap_lite.typing import FloatArray

COLOUR_INDEX: Final = 1
"""The second colour: the first is that of the observed front."""

MARKER: Final = "D"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PosteriorPoints:
    """Means and standard deviations of the noise-free objectives, as the user directed them."""

    mean: FloatArray
    """Shape (k, m)."""

    std: FloatArray
    """Shape (k, m)."""

    def draw(self, axes: Axes, columns: list[int]) -> None:
        """Draw the means in the plane of two objectives, with one standard deviation to each side."""
        (x, y), (x_std, y_std) = self.mean[:, columns].T, self.std[:, columns].T
        look = {
            "fmt": MARKER,
            "color": style.colour(COLOUR_INDEX),
            "markersize": 5.5,
            "markerfacecolor": "white",
            "markeredgewidth": 1.5,
            "elinewidth": 1.1,
            "zorder": 5.5,
        }
        axes.errorbar(x, y, xerr=x_std, yerr=y_std, **cast(Any, look))

    def legend_entry(self) -> Line2D:
        """Return what the legend says."""
        n = len(self.mean)
        text = f"posterior front ({n} point{'s' * (n != 1)}, mean \N{PLUS-MINUS SIGN} std)"
        return style.legend_entry(text, style.colour(COLOUR_INDEX), MARKER, hollow=True, size=6)


def posterior_points(run: Run) -> PosteriorPoints | None:
    """Read the posterior front of a run; None if it has none.

    Raises
    ------
    RunFolderError
        If its file lacks a column, or a number cannot be read.
    """
    file = run.folder / "posterior_front.csv"
    if run.samples is not None or not file.is_file():
        return None
    names = [o.name for o in run.objectives]
    columns, rows = read_rows(file, required=[])
    mean, std = (
        numbers_of(rows, [_column(f"{name}_{what}", columns) for name in names], file) for what in ("mean", "std")
    )
    is_usable = np.isfinite(np.hstack([mean, std])).all(axis=1)
    return PosteriorPoints(mean=mean[is_usable], std=std[is_usable]) if is_usable.any() else None


def _column(name: str, columns: tuple[str, ...]) -> str:
    """Return how a column is called: a parameter or an objective of the same name goes before."""
    return f"posterior.{name}" if f"posterior.{name}" in columns else name
