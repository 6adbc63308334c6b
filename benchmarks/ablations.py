"""Variants of the default method, each with one default changed: what a default is worth.

A variant is a list of changes to the scenario, as `--set` takes them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

ABLATIONS: Mapping[str, Sequence[str]] = {
    "random forest": ("surrogate.type=random_forest",),
    "expected improvement": ("acquisition.type=expected_improvement",),
    "upper confidence bound": ("acquisition.type=upper_confidence_bound",),
    "Thompson sampling": ("acquisition.type=thompson_sampling",),
    "noise-free model": ("surrogate.noise=false",),
    "10 % uniform": ("optimizer.epsilon=0.1",),
}
