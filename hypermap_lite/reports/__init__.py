"""What the surrogate says at the end of a run: which parameters matter, and which configurations are best."""

from hypermap_lite.reports.parameter_importance import ParameterImportance, parameter_importance
from hypermap_lite.reports.posterior_front import BestPrediction, PosteriorFront, posterior_front

__all__ = ["BestPrediction", "ParameterImportance", "PosteriorFront", "parameter_importance", "posterior_front"]
