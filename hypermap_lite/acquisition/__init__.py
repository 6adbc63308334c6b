"""Acquisition functions: which point is worth the next evaluation."""

from collections.abc import Mapping
from typing import Final

from hypermap_lite.acquisition.base import Acquisition, AcquisitionContext, PriorWeighting, Scorer
from hypermap_lite.acquisition.bopro import Bopro
from hypermap_lite.acquisition.expected_improvement import ExpectedImprovement
from hypermap_lite.acquisition.feasibility_weighted import FeasibilityWeighted, FeasibilityWeighting
from hypermap_lite.acquisition.noisy_expected_improvement import NoisyExpectedImprovement
from hypermap_lite.acquisition.noisy_hypervolume_improvement import NoisyExpectedHypervolumeImprovement
from hypermap_lite.acquisition.prior_weighted import Pibo, PriorWeighted
from hypermap_lite.acquisition.thompson_sampling import ThompsonSampling
from hypermap_lite.acquisition.upper_confidence_bound import UpperConfidenceBound

ACQUISITIONS: Final[Mapping[str, type[Acquisition]]] = {
    "noisy_expected_hypervolume_improvement": NoisyExpectedHypervolumeImprovement,
    "noisy_expected_improvement": NoisyExpectedImprovement,
    "expected_improvement": ExpectedImprovement,
    "upper_confidence_bound": UpperConfidenceBound,
    "thompson_sampling": ThompsonSampling,
}
"""JSON name of each acquisition function."""

__all__ = [
    "ACQUISITIONS",
    "Acquisition",
    "AcquisitionContext",
    "Bopro",
    "ExpectedImprovement",
    "FeasibilityWeighted",
    "FeasibilityWeighting",
    "NoisyExpectedHypervolumeImprovement",
    "NoisyExpectedImprovement",
    "Pibo",
    "PriorWeighted",
    "PriorWeighting",
    "Scorer",
    "ThompsonSampling",
    "UpperConfidenceBound",
]
