"""Named sets of method defaults; the scenario's own keys win over them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, Final


def paper(*, has_priors: bool) -> Mapping[str, Any]:
    """Return the method of the paper, to the letter [1]_.

    References
    ----------
    .. [1] Mayr et al. Learning Skill-based Industrial Robot Tasks with User Priors. CASE 2022.
    """
    design = {"type": "prior_sampling", "uniform_share": 0.0} if has_priors else {"type": "random_sampling"}
    return {
        "design_of_experiment": design,
        "optimizer": {"type": "bayesian", "escapes": 0, "boundary_factor": 1.0},
        "surrogate": {
            "type": "gaussian_process",
            "categorical_prior": False,
            "noise_floor": 1e-6,
            "noise_tail": 2.0,
            "doubt_noise": False,
            "lengthscale_location": math.sqrt(2.0),
            "lengthscale_width": math.sqrt(3.0),
            "restart": True,
            "learn_infeasible": False,
            "compress_tails": False,
            "ignore_outliers": False,
            "separate_failures": False,
            "separate_modes": False,
        },
        "maximizer": {"type": "multistart_gradient", "smooth_levels": 0, "joint_tolerance": 0.0},
        "acquisition": {
            "type": "noisy_expected_improvement",
            "screening": 0,
            "scalarization": {"type": "linear"},
            "weights": {"type": "dirichlet", "alpha": 1.0},
            "feasibility_weighting": {
                "method": "probability",
                "exponent": 1.0,
                "approximation": "laplace",
                "learn_failed": False,
                "first_feasible": "classifier",
                "next_feasible": "classifier",
            },
            "prior_weighting": {
                "method": "pibo",
                "floor": 1e-6,
                "prior_free": 0.0,
                "safeguard": False,
                "make_up": False,
            },
        },
    }


PRESETS: Final[Mapping[str, Callable[..., Mapping[str, Any]]]] = {"paper": paper}
"""JSON name of each preset; called with ``has_priors``, it returns the part of a scenario it stands for."""
