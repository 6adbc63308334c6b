"""``plot prior``: what a scenario believes about two of its parameters, and the points the belief came from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from hypermap_lite.assembly import build_prior, build_space
from hypermap_lite.errors import RunFolderError, UsageError
from hypermap_lite.plotting import style
from hypermap_lite.plotting.parameter_axes import chosen_axes, name_with_scale, ticks, values_of
from hypermap_lite.plotting.runs import SamplesFile, Source, load_run
from hypermap_lite.priors import JointDensity, ProductPrior
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.model import Scenario
from hypermap_lite.space import Parameter, SearchSpace
from hypermap_lite.typing import FloatArray, Value

N_GRID: Final = 201
"""Places along a continuous axis."""

MAX_CELLS: Final = 50
"""A discrete axis of more levels than this is drawn as a continuous one."""

EDGE: Final = 1e-3
"""Distance of the outermost places from the ends of the axis, where some densities are infinite."""

N_CONTOURS: Final = 10

MAX_CHARACTERS: Final = 55
"""Texts of ticks that are longer together are slanted, for want of room below the plane."""

FLATTEST: Final = 2.0
"""Density at the dark end of the scale, at least; so a uniform prior is not drawn as a peak."""

SCALE: Final = LinearSegmentedColormap.from_list("prior", ["#FFFFFF", "#CFE3F1", "#73B0D7", "#0072B2", "#003B5C"])
"""Colours of the density, rising in darkness alone."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DensityAxis:
    """One parameter as an axis of the picture, in codes from 0 to 1."""

    parameter: Parameter
    codes: FloatArray
    """Places at which the density is taken, shape (n,)."""

    edges: FloatArray
    """Edges of the cells around those places, shape (n + 1,)."""

    density: FloatArray
    """Marginal density, 1.0 where uniform, shape (n,)."""

    is_discrete: bool
    """Whether each place is a level."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PriorPoints:
    """Points in the plane of the two parameters."""

    values: tuple[tuple[Value, Value], ...]
    """In native units."""

    codes: FloatArray
    """Shape (n, 2)."""

    weights: FloatArray
    """How much each counts, from 0 to 1, shape (n,)."""


def plot_prior(
    folders: Sequence[Source],
    output: str | Path | None = None,
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
    reference_point: Mapping[str, float] | None = None,
    data: bool = False,
    parameters: Sequence[str] | None = None,
) -> list[Path]:
    """Draw the prior on two parameters and on each alone; see `hypermap_lite.plotting.PlotFunction`.

    The one run may be a scenario file as well. All other parameters are integrated out. The density is that on the
    unit cube, 1 where the prior says nothing; a logarithmic axis is even in the logarithm. Points a prior was learned
    from are drawn, and so is an initial design drawn from the prior. `labels` and `reference_point` have no part here.

    `parameters` are two names; by default the first two that have a prior.
    """
    if len(folders) != 1:
        raise UsageError(f"`plot prior` draws one prior, and {len(folders)} runs or scenarios are given")
    source = folders[0]
    if isinstance(source, SamplesFile):
        raise UsageError(f"{source.path}: `plot prior` draws the prior of a run folder or a scenario file")
    file, folder = _scenario_file(Path(source))
    scenario = load_scenario(file)
    space = build_space(scenario)
    prior = build_prior(scenario, space)
    pair = _chosen_pair(parameters, space, prior, file)
    target = style.output_path(output or (folder / "prior" if folder is not None else None), [], "prior")
    joint = prior.marginal(pair)
    across, up = (_density_axis(space.parameters[j], prior.marginal([j])) for j in pair)
    places = np.array([[u, v] for v in up.codes for u in across.codes])
    density = _density(joint, places).reshape(len(up.codes), len(across.codes))
    learned_from = _points_learned_from(scenario, across.parameter, up.parameter)
    design = _design_of(folder, scenario, across.parameter, up.parameter)
    with style.house_style():
        figure = _draw(across, up, density, learned_from, design)
        style.set_title(figure, scenario.application_name if title is None else title, [])
        files = style.save(figure, target)
    if not data:
        return files
    rows = _numbers_behind(across, up, density, {"learned from": learned_from, "design": design})
    return [*files, style.save_data(["what", across.parameter.name, up.parameter.name, "density"], rows, target)]


def _scenario_file(source: Path) -> tuple[Path, Path | None]:
    """Return the scenario file that a run folder, a history or a scenario file stands for, and the run folder if any.

    Raises
    ------
    RunFolderError
        If a folder holds no scenario.
    """
    if not source.is_dir() and source.suffix != ".csv" and source.exists():
        return source, None
    folder = source if source.is_dir() or source.suffix != ".csv" else source.parent
    if not (folder / "scenario.json").is_file():
        where = "no scenario.json in it" if folder.exists() else "no such file or folder"
        raise RunFolderError(f"{folder}: not a run folder ({where}). Give the folder a run wrote, or a scenario file")
    return folder / "scenario.json", folder


def _chosen_pair(names: Sequence[str] | None, space: SearchSpace, prior: ProductPrior, file: Path) -> list[int]:
    """Return the axes of the two parameters to draw, or raise UsageError."""
    if prior.is_uniform:
        raise UsageError(f"{file}: no parameter has a prior, so there is none to draw")
    if space.dimension < 2:
        raise UsageError(f"{file}: `plot prior` needs 2 parameters, this scenario has 1")
    if names is not None:
        if len(names) != 2:
            raise UsageError(f"`plot prior` draws 2 parameters, and {len(names)} are given: {', '.join(names)}")
        return chosen_axes(names, space)
    with_prior = sorted(axis for axes, _ in prior.factors for axis in axes)
    others = [axis for axis in range(space.dimension) if axis not in with_prior]
    return sorted([*with_prior, *others][:2])


def _density(density: JointDensity, U: FloatArray) -> FloatArray:
    """Return a density at n points, shape (n, k), as shape (n,); at the ends of an axis that a little within."""
    return np.exp(density.log_density(np.clip(U, EDGE, 1 - EDGE)))


def _density_axis(parameter: Parameter, marginal: JointDensity) -> DensityAxis:
    """Return one parameter's axis with its marginal density, level by level if there are few."""
    is_discrete = parameter.n_levels is not None and parameter.n_levels <= MAX_CELLS
    if is_discrete:
        codes, edges = parameter.level_codes(), parameter.bin_edges()
    else:
        codes = np.linspace(0, 1, N_GRID)
        edges = np.concatenate([[0.0], (codes[1:] + codes[:-1]) / 2, [1.0]])
    density = _density(marginal, codes[:, None])
    return DensityAxis(parameter=parameter, codes=codes, edges=edges, density=density, is_discrete=is_discrete)


def _points_learned_from(scenario: Scenario, across: Parameter, up: Parameter) -> PriorPoints | None:
    """Return the points of the joint prior that was learned from both parameters, if there is one."""
    for spec in scenario.joint_priors:
        points = spec.options.get("points") or {}
        if across.name in points and up.name in points:
            return _points(across, up, points[across.name], points[up.name], spec.options.get("point_weights"))
    return None


def _design_of(folder: Path | None, scenario: Scenario, across: Parameter, up: Parameter) -> PriorPoints | None:
    """Return the initial design of a run that was drawn from the prior, if there is one."""
    if folder is None or not (folder / "history.csv").is_file():
        return None
    if scenario.design.type not in ("auto", "prior_sampling"):
        return None
    run = load_run(folder)
    drawn = [i for i, row in enumerate(run.rows) if row.get("phase") == "design"]
    first, second = values_of(run, across), values_of(run, up)
    return _points(across, up, [first[i] for i in drawn], [second[i] for i in drawn]) if drawn else None


def _points(
    across: Parameter,
    up: Parameter,
    first: Sequence[Value],
    second: Sequence[Value],
    weights: Sequence[float] | None = None,
) -> PriorPoints:
    """Return points given by their native values."""
    counts = np.ones(len(first)) if weights is None else np.array(weights, dtype=float)
    codes = np.column_stack([across.encode(first), up.encode(second)])
    return PriorPoints(values=tuple(zip(first, second, strict=True)), codes=codes, weights=counts / counts.max())


def _draw(
    across: DensityAxis,
    up: DensityAxis,
    density: FloatArray,
    learned_from: PriorPoints | None,
    design: PriorPoints | None,
) -> Figure:
    """Draw the plane with the marginal densities above and to the right, and the scale of the colours."""
    figure = style.new_figure(7.2, 6.4)
    panels = figure.subplots(2, 2, width_ratios=[4, 1], height_ratios=[1, 4], squeeze=False)
    (above, corner), (plane, beside) = panels
    corner.set_axis_off()
    top = max(float(density.max()), FLATTEST)
    levels = np.linspace(0, top, N_CONTOURS + 1)
    _draw_plane(plane, across, up, density, levels)
    _draw_points(plane, learned_from, design)
    _draw_marginal(above, across, is_upright=True)
    _draw_marginal(beside, up, is_upright=False)
    scale = ScalarMappable(cmap=SCALE)
    scale.set_clim(0, top)
    bar = figure.colorbar(scale, ax=panels, location="right", fraction=0.04, pad=0.02, aspect=32)
    bar.set_label("prior density (uniform = 1)")
    bar.outline.set_visible(False)
    style.add_legend(figure, _legend(learned_from, design))
    return figure


def _draw_plane(axes: Axes, across: DensityAxis, up: DensityAxis, density: FloatArray, levels: FloatArray) -> None:
    """Draw the density as filled contours, or as cells if an axis is discrete."""
    if across.is_discrete or up.is_discrete:
        axes.pcolormesh(across.edges, up.edges, density, cmap=SCALE, vmin=0, vmax=levels[-1], rasterized=True)
        for axis, draw in ((across, axes.axvline), (up, axes.axhline)):
            for edge in axis.edges[1:-1] if axis.is_discrete else ():
                draw(edge, color="white", linewidth=1.0, zorder=1.5)
    else:
        axes.contourf(across.codes, up.codes, density, levels=levels, cmap=SCALE)
        axes.contour(across.codes, up.codes, density, levels=levels[1:], colors="white", linewidths=0.5, alpha=0.6)
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1)
    axes.grid(visible=False)
    axes.spines[:].set_visible(True)
    codes, texts = ticks(across.parameter)
    is_crowded = sum(map(len, texts)) + 2 * len(texts) > MAX_CHARACTERS
    axes.set_xticks(codes, texts, rotation=30 if is_crowded else 0, ha="right" if is_crowded else "center")
    axes.set_yticks(*ticks(up.parameter))
    axes.set_xlabel(name_with_scale(across.parameter))
    axes.set_ylabel(name_with_scale(up.parameter))


def _draw_points(axes: Axes, learned_from: PriorPoints | None, design: PriorPoints | None) -> None:
    """Draw the points the prior came from, larger by weight and number, and the small ones that came from the prior."""
    if design is not None:
        axes.plot(
            *design.codes.T,
            linestyle="none",
            marker="s",
            markersize=4.5,
            markerfacecolor="white",
            markeredgecolor=style.INK,
            markeredgewidth=1.1,
            zorder=4,
            clip_on=False,
        )
    if learned_from is not None:
        places, rows = np.unique(learned_from.codes, axis=0, return_inverse=True)
        weights = np.bincount(rows.ravel(), learned_from.weights)
        axes.scatter(
            places[:, 0],
            places[:, 1],
            s=12 + 30 * weights / weights.max(),
            c=style.COLOURS[1],
            edgecolors="white",
            linewidths=0.7,
            zorder=5,
            clip_on=False,
        )


def _draw_marginal(axes: Axes, axis: DensityAxis, *, is_upright: bool) -> None:
    """Draw the density of one parameter along a side of the plane, and where it would be if uniform."""
    colour = style.COLOURS[0]
    if axis.is_discrete:
        draw = axes.bar if is_upright else axes.barh
        draw((axis.edges[1:] + axis.edges[:-1]) / 2, axis.density, np.diff(axis.edges) * 0.86, color=colour, alpha=0.55)
    else:
        fill = axes.fill_between if is_upright else axes.fill_betweenx
        fill(axis.codes, axis.density, color=colour, alpha=0.25, linewidth=0)
        line = (axis.codes, axis.density) if is_upright else (axis.density, axis.codes)
        axes.plot(*line, color=colour, linewidth=1.6)
    (axes.axhline if is_upright else axes.axvline)(1, color=style.GREY, linestyle=style.DASHES, linewidth=1.0)
    (axes.set_xlim if is_upright else axes.set_ylim)(0, 1)
    (axes.set_ylim if is_upright else axes.set_xlim)(0, 1.08 * max(float(axis.density.max()), 1.0))
    along, height = (axes.xaxis, axes.yaxis) if is_upright else (axes.yaxis, axes.xaxis)
    along.set_ticks([])
    height.set_major_locator(MaxNLocator(2, integer=True))
    axes.grid(visible=False)


def _legend(learned_from: PriorPoints | None, design: PriorPoints | None) -> list[Line2D]:
    """Return the entries of the legend."""
    entries = []
    if learned_from is not None:
        text = f"learned from ({len(learned_from.values)} points)"
        entries.append(style.legend_entry(text, style.COLOURS[1], "o"))
    if design is not None:
        entries.append(style.legend_entry("initial design, drawn from it", style.INK, "s", size=5, hollow=True))
    entries.append(style.legend_entry("marginal density", style.COLOURS[0], line="-", width=1.6))
    entries.append(style.legend_entry("uniform", style.GREY, line=style.DASHES, width=1.0))
    return entries


def _numbers_behind(
    across: DensityAxis, up: DensityAxis, density: FloatArray, points: Mapping[str, PriorPoints | None]
) -> list[list[object]]:
    """Return the rows of the data of the picture: the plane, both marginals, and the points."""
    first, second = (axis.parameter.decode(axis.codes) for axis in (across, up))
    rows: list[list[object]] = [
        ["joint", a, b, float(density[k, i])] for k, b in enumerate(second) for i, a in enumerate(first)
    ]
    rows += [["marginal", a, "", float(value)] for a, value in zip(first, across.density, strict=True)]
    rows += [["marginal", "", b, float(value)] for b, value in zip(second, up.density, strict=True)]
    rows += [[what, *values, ""] for what, found in points.items() if found is not None for values in found.values]
    return rows
