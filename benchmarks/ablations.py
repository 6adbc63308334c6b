"""Variants of the default method, each with one default changed: what a default is worth.

A variant is a list of changes to the scenario, as `--set` takes them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

ABLATIONS: Mapping[str, Sequence[str]] = {
    "random forest": ("surrogate.type=random_forest",),
    "wide lengthscale prior": ("surrogate.lengthscale_location=1.414", "surrogate.lengthscale_width=1.732"),
    "noise held up": ("surrogate.noise_tail=2",),
    "high noise floor": ("surrogate.noise_floor=1e-6",),
    "noise-free model": ("surrogate.noise=false",),
    "restarted fits": ("surrogate.restart=true",),
    "Tchebyshev, drawn weights": (
        "acquisition.type=noisy_expected_improvement",
        "acquisition.scalarization.type=tchebyshev",
    ),
    "expected improvement": ("acquisition.type=expected_improvement",),
    "upper confidence bound": ("acquisition.type=upper_confidence_bound",),
    "Thompson sampling": ("acquisition.type=thompson_sampling",),
    "128 samples": ("acquisition.samples=128",),
    "no screening": ("acquisition.screening=0",),
    "feasibility to the first power": ("acquisition.feasibility_weighting.exponent=1",),
    "local search": ("maximizer.type=local_search",),
    "no escapes": ("optimizer.escapes=0",),
    "10 % uniform": ("optimizer.epsilon=0.1",),
}
