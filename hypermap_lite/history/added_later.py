"""Options that older scenarios did not have."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Final

ADDED_LATER: Final[Mapping[str, str]] = {
    "$.acquisition.feasibility_weighting.method": '"probability"',
    "$.acquisition.feasibility_weighting.exponent": "1",
    "$.acquisition.feasibility_weighting.approximation": '"laplace"',
    "$.acquisition.feasibility_weighting.learn_failed": "false",
    "$.acquisition.feasibility_weighting.first_feasible": '"classifier"',
    "$.acquisition.feasibility_weighting.next_feasible": '"classifier"',
    "$.acquisition.prior_weighting.make_up": "false",
    "$.acquisition.prior_weighting.prior_free": "0",
    "$.acquisition.prior_weighting.safeguard": "false",
    "$.acquisition.screening": "0",
    "$.acquisition.weights.ends": "0",
    "$.acquisition.weights.redraws": "0",
    "$.design_of_experiment.uniform_share": "0",
    "$.maximizer.joint_tolerance": "0",
    "$.maximizer.smooth_levels": "0",
    "$.optimizer.boundary_factor": "1",
    "$.optimizer.escapes": "0",
    "$.surrogate.categorical_prior": "false",
    "$.surrogate.compress_tails": "false",
    "$.surrogate.doubt_noise": "false",
    "$.surrogate.ignore_outliers": "false",
    "$.surrogate.learn_infeasible": "false",
    "$.surrogate.lengthscale_location": json.dumps(math.sqrt(2.0)),
    "$.surrogate.lengthscale_width": json.dumps(math.sqrt(3.0)),
    "$.surrogate.noise_floor": "1e-06",
    "$.surrogate.noise_tail": "2",
    "$.surrogate.restart": "true",
    "$.surrogate.separate_failures": "false",
    "$.surrogate.separate_modes": "false",
}
"""Their places, and the values (as JSON) that scenarios without them are taken to have: those that change nothing."""
