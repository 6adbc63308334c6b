"""Variants of the default method: what a default is worth.

A variant is a list of changes to the scenario, as `--set` takes them; each changes one default and leaves the rest.
`OF_FEASIBILITY` holds those that change nothing without an unknown constraint, `OF_TAILS` those that change next to
nothing without values far beyond the rest, `OF_OUTLIERS` those that matter where evaluations fail without a reason,
`OF_FAILURES` where they fail with one, `OF_MODES` where the front needs two kinds of outcomes, `OF_NOISE` those that
change nothing with several objectives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

ABLATIONS: Mapping[str, Sequence[str]] = {
    "bounds like the rest": ("optimizer.boundary_factor=1",),
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
    "no escapes": ("optimizer.escapes=0",),
    "10 % uniform": ("optimizer.epsilon=0.1",),
}
OF_FEASIBILITY: Mapping[str, Sequence[str]] = {
    "infeasible values ignored": ("surrogate.learn_infeasible=false",),
    "feasibility to the first power": ("acquisition.feasibility_weighting.exponent=1",),
    "feasibility by the mode": ("acquisition.feasibility_weighting.approximation=laplace",),
    "first feasible by the classifier": ("acquisition.feasibility_weighting.first_feasible=classifier",),
    "next feasible by the classifier": ("acquisition.feasibility_weighting.next_feasible=classifier",),
}
OF_TAILS: Mapping[str, Sequence[str]] = {"tails as they are": ("surrogate.compress_tails=false",)}
OF_OUTLIERS: Mapping[str, Sequence[str]] = {"outliers believed": ("surrogate.ignore_outliers=false",)}
OF_NOISE: Mapping[str, Sequence[str]] = {"noise believed": ("surrogate.doubt_noise=false",)}
OF_FAILURES: Mapping[str, Sequence[str]] = {"failures among the rest": ("surrogate.separate_failures=false",)}
OF_MODES: Mapping[str, Sequence[str]] = {"modes among the rest": ("surrogate.separate_modes=false",)}
