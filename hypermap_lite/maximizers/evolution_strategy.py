"""CMA-ES on the unit cube: the only place that knows the package ``cma``."""

from __future__ import annotations

import warnings
from importlib.util import find_spec
from typing import Any

import numpy as np

from hypermap_lite.errors import ScenarioError
from hypermap_lite.typing import FloatArray, Rng

QUIET = -9
"""Verbosity at which the package writes nothing."""

TOLERANCE = 1e-9
"""Smallest steps worth taking, in units of the cube; configurations closer than that are hardly two."""

LARGEST_STEP = 1 / 3
"""Standard deviation along a single axis at most, as the package has it for several."""


class EvolutionStrategy:
    """Covariance matrix adaptation [1]_ by pycma [2]_, minimizing, with all randomness from given generators.

    Parameters
    ----------
    start
        First mean, shape (d,).
    sigma
        First standard deviation along every axis.
    rng
        Source of all randomness until another is set.
    population
        Points per generation; None for 4 + 3 ln d.
    tolerance
        Steps below this, in units of the cube, are the end.
    smallest_steps
        Least standard deviation along each axis, shape (d,); None for none.

    References
    ----------
    .. [1] Hansen, Ostermeier. Completely Derandomized Self-Adaptation in Evolution Strategies. Evolutionary
       Computation, 2001.
    .. [2] Hansen, Akimoto, Baudis. CMA-ES/pycma. Zenodo, doi:10.5281/zenodo.2559634.
    """

    def __init__(
        self,
        start: FloatArray,
        sigma: float,
        rng: Rng,
        *,
        population: int | None = None,
        tolerance: float = TOLERANCE,
        smallest_steps: FloatArray | None = None,
    ) -> None:
        import cma  # slow to import, and an extra

        self.rng = rng
        options: dict[str, Any] = {
            "bounds": [0.0, 1.0],
            "verbose": QUIET,
            "verb_log": 0,
            "seed": np.nan,  # leave the global generator alone
            "randn": lambda *shape: self.rng.standard_normal(shape),
            "CMA_mirrors": 0,
            "tolx": tolerance,
            "signals_filename": "",
        }
        self._smallest_step = 0.0
        if len(start) == 1:  # the package fails where a single axis reaches its limits: `tell` keeps them
            options["maxstd_boundrange"] = np.inf
            self._smallest_step = 0.0 if smallest_steps is None else float(smallest_steps[0])
            smallest_steps = None
        if population is not None:
            options["popsize"] = population
        if smallest_steps is not None:
            options["minstd"] = smallest_steps
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self._strategy = cma.CMAEvolutionStrategy(np.clip(start, 0.0, 1.0), sigma, options)

    @property
    def population(self) -> int:
        """Points per generation."""
        return int(self._strategy.popsize)

    @property
    def is_finished(self) -> bool:
        """Whether going on makes no sense: it has converged, or is stuck."""
        return bool(self._strategy.stop())

    def ask(self, n: int) -> FloatArray:
        """Return n points of the current distribution, shape (n, d)."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return np.clip(np.array(self._strategy.ask(n)), 0.0, 1.0)

    def tell(self, X: FloatArray, values: FloatArray) -> None:
        """Update the distribution by n evaluated points, shape (n, d), and their values, shape (n,), finite."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self._strategy.tell(list(X), list(values))
        if X.shape[1] == 1:
            step = float(self._strategy.stds[0])
            self._strategy.sigma *= min(max(step, self._smallest_step), LARGEST_STEP) / step


def require_cma() -> None:
    """Raise a `ScenarioError` if the package ``cma`` is not installed; does not load it, which is slow."""
    if find_spec("cma") is None:
        hint = 'Install it by: pip install "hypermap-lite[cma]"'
        raise ScenarioError("$.type", "it needs the package cma, which is not installed", hint=hint)
