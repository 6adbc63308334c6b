"""Variants of the default method: what a default is worth.

A variant is a list of changes to the scenario, as `--set` takes them. The first takes bounds of the space like the rest
of it, the second learns nothing of the objectives from infeasible evaluations. The others take bounds as the first
does, and change one default more, so each is to be compared with the first.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

PLAIN = ("optimizer.boundary_factor=1",)
CHANGES: Mapping[str, Sequence[str]] = {
    "random forest": ("surrogate.type=random_forest",),
    "wide lengthscale prior": ("surrogate.lengthscale_location=1.414", "surrogate.lengthscale_width=1.732"),
    "shorter lengthscales": ("surrogate.lengthscale_location=-1",),
    "noise held up": ("surrogate.noise_tail=2",),
    "noise-free model": ("surrogate.noise=false",),
    "restarted fits": ("surrogate.restart=true",),
    "Tchebyshev with drawn weights": (
        "acquisition.type=noisy_expected_improvement",
        "acquisition.scalarization.type=tchebyshev",
    ),
    "expected improvement": ("acquisition.type=expected_improvement",),
    "Thompson sampling": ("acquisition.type=thompson_sampling",),
    "feasibility to the first power": ("acquisition.feasibility_weighting.exponent=1",),
    "no escapes": ("optimizer.escapes=0",),
    "10 % uniform": ("optimizer.epsilon=0.1",),
}
ABLATIONS: Mapping[str, Sequence[str]] = {
    "bounds like the rest": PLAIN,
    "infeasible values ignored": ("surrogate.learn_infeasible=false",),
    **{name: (*PLAIN, *changes) for name, changes in CHANGES.items()},
}
