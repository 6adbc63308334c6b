"""One look for all pictures: sizes, colours that colour-blind readers can tell apart, and how files are written."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, cast

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hypermap_lite.errors import UsageError
from hypermap_lite.objectives import Goal, Objective
from hypermap_lite.plotting.runs import Run

COLOURS: Final = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
"""The palette of Okabe and Ito (2008), most distinct first; its yellow is left out, it vanishes on white."""

GREY: Final = "#666666"
INK: Final = "#222222"
LIGHT_GREY: Final = "#BBBBBB"
DASHES: Final = (0.0, (5.0, 3.0))
"""Of the line at the end of the initial design [line widths]."""

MARKERS: Final = ("o", "^", "D", "v", "P", "X", "*")
"""One per label beside its colour, so that prints in grey stay readable."""

FORMATS: Final = (".png", ".pdf")
OTHER_FORMATS: Final = frozenset({".svg", ".jpg", ".jpeg", ".eps", ".ps", ".gif", ".tif", ".tiff", ".webp", ".csv"})
"""Endings that are a mistake; any other is taken for a part of the name."""

RESOLUTION: Final = 200
"""Of the PNG [dots per inch]."""

CHARACTER_WIDTH: Final = 0.072
"""Of the legend's font, on average [inch]."""

HANDLE_WIDTH: Final = 0.65
"""Of a legend's symbol with the space around it [inch]."""

SETTINGS: Final[dict[str, Any]] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 11,
    "axes.labelsize": 12,
    "axes.titlesize": 13,
    "legend.fontsize": 10.5,
    "xtick.labelsize": 10.5,
    "ytick.labelsize": 10.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#444444",
    "axes.linewidth": 0.9,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#E6E6E6",
    "grid.linewidth": 0.8,
    "lines.linewidth": 2.0,
    "legend.frameon": False,
    "legend.handlelength": 1.6,
    "figure.constrained_layout.h_pad": 0.06,
    "figure.constrained_layout.w_pad": 0.06,
    "savefig.dpi": RESOLUTION,
    "pdf.fonttype": 42,
    "axes.formatter.useoffset": False,
    "text.usetex": False,
    "text.parse_math": False,
}
"""Matplotlib's settings for every picture, whatever the user's own are; names with a $ or _ stay as written."""


@contextmanager
def house_style() -> Iterator[None]:
    """Draw and save under `SETTINGS`, on top of Matplotlib's defaults."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(cast(Any, SETTINGS))  # the stubs want literal keys
        yield


def new_figure(width: float, height: float) -> Figure:
    """Return a figure of a fixed size [inch] that needs no display."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def colour(index: int) -> str:
    """Return the colour of the label number `index`."""
    return COLOURS[index % len(COLOURS)]


def marker(index: int) -> str:
    """Return the marker of the label number `index`."""
    return MARKERS[index % len(MARKERS)]


def axis_label(objective: Objective) -> str:
    """Return an objective's name with the direction in which it is better, as an arrow along its axis."""
    if objective.goal is Goal.MAXIMIZE:
        return f"{objective.name}  (larger is better \N{RIGHTWARDS ARROW})"
    return f"{objective.name}  (\N{LEFTWARDS ARROW} smaller is better)"


def label_with_power(axes: Axes, label: str) -> None:
    """Label the vertical axis, with the power of ten of large and small numbers in the label, as in ``f / 10⁶``."""
    axes.set_ylabel(label)
    highest = max(map(abs, axes.get_ylim()))
    power = math.floor(math.log10(highest)) if highest > 0 else 0
    if not -3 <= power <= 4:
        exponent = str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        axes.yaxis.set_major_formatter(lambda value, _position: f"{value / 10.0**power:.4g}")
        axes.set_ylabel(f"{label} / 10{exponent}")


def mark_design_end(axes: Axes, n_design: int) -> None:
    """Draw the dashed line after the last evaluation of the initial design."""
    axes.axvline(n_design + 0.5, color=GREY, linestyle=DASHES, linewidth=1.3, zorder=1.5)


def legend_entry(
    label: str,
    colour: str,
    shape: str = "",
    *,
    line: Any = "none",
    size: float = 6.5,
    width: float = 2.0,
    alpha: float = 1.0,
    hollow: bool = False,
) -> Line2D:
    """Return one entry of a legend: a marker, a line, or both."""
    return Line2D(
        [],
        [],
        label=label,
        color=colour,
        linestyle=line,
        linewidth=width,
        marker=shape,
        markersize=size,
        markerfacecolor="white" if hollow else colour,
        markeredgecolor=colour,
        markeredgewidth=1.8 if hollow or shape not in "ov^DPs*" else 0.5,
        alpha=alpha,
    )


def add_legend(figure: Figure, entries: Sequence[Line2D]) -> None:
    """Put the legend below the panels, where it hides nothing, in as many columns as fit."""
    widest = max(len(str(entry.get_label())) for entry in entries) * CHARACTER_WIDTH + HANDLE_WIDTH
    n_columns = max(1, min(len(entries), int(figure.get_figwidth() / widest)))
    n_rows = math.ceil(len(entries) / n_columns)
    figure.legend(handles=list(entries), loc="outside lower center", ncols=math.ceil(len(entries) / n_rows))


def set_title(figure: Figure, title: str | None, runs: Sequence[Run]) -> None:
    """Write the title: the one given, else the application's name where all runs share it."""
    names = {run.name for run in runs}
    text = title if title is not None else names.pop() if len(names) == 1 else ""
    if text:
        figure.suptitle(text, fontsize=13)


def output_path(output: str | Path | None, runs: Sequence[Run], kind: str) -> Path:
    """Return where a picture goes: as told, else into the folder of the only run, else the working directory."""
    if output is None:
        return runs[0].folder / kind if len(runs) == 1 else Path(kind)
    path = Path(output)
    if path.suffix.lower() in OTHER_FORMATS:
        raise UsageError(f"{path}: pictures are written as .png or .pdf, or as both if the name has no ending")
    return path


def save(figure: Figure, output: Path) -> list[Path]:
    """Write a figure and return the files: the one with a known ending, or PNG and PDF for a path without.

    The files hold no dates, so that equal data make equal files.

    Raises
    ------
    UsageError
        If a file cannot be written.
    """
    files = [output] if output.suffix in FORMATS else [output.with_name(output.name + f) for f in FORMATS]
    for file in files:
        metadata = {"CreationDate": None} if file.suffix == ".pdf" else {"Software": None}
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            figure.savefig(file, metadata=metadata)
        except OSError as error:
            raise UsageError(f"{file}: the picture cannot be written ({error.strerror})") from error
    return files


def save_data(columns: Sequence[str], rows: Sequence[Sequence[object]], output: Path) -> Path:
    """Write the numbers behind a picture beside it, as ``<its name>_data.csv``, and return that file."""
    stem = output.stem if output.suffix in FORMATS else output.name
    file = output.with_name(f"{stem}_data.csv")
    with file.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        for row in rows:
            writer.writerow(["" if isinstance(cell, float) and math.isnan(cell) else cell for cell in row])
    return file
