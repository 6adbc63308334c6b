"""Surrogates: models of the objectives."""

from collections.abc import Mapping
from typing import Final

from hypermap_lite.surrogates.base import Posterior, Prediction, Surrogate
from hypermap_lite.surrogates.gaussian_process import GaussianProcess
from hypermap_lite.surrogates.random_forest import RandomForest

SURROGATES: Final[Mapping[str, type[Surrogate]]] = {
    "gaussian_process": GaussianProcess,
    "random_forest": RandomForest,
}
"""JSON name of each surrogate."""

__all__ = ["SURROGATES", "GaussianProcess", "Posterior", "Prediction", "RandomForest", "Surrogate"]
