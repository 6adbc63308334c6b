"""Options that older scenarios did not have, and what they are taken to say.

A run folder's ``scenario.json`` holds every option there was when the run began. An option that has come since has,
for such a scenario, the value that leaves its method as it was, whatever the default for a new scenario is.
"""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final


@dataclass(frozen=True, slots=True)
class Added:
    """One option and where it belongs."""

    section: tuple[str, ...]
    option: str
    value: Any
    """What a scenario without it says."""

    key: str
    """The section's key that names its member."""

    members: tuple[str, ...]
    """Members that have the option, the default one first."""

    @property
    def place(self) -> str:
        """Where it stands in the scenario."""
        return ".".join(("$", *self.section, self.option))


SAMPLING: Final = ("noisy_expected_hypervolume_improvement", "noisy_expected_improvement", "expected_improvement")
WEIGHTING: Final = ("acquisition", "feasibility_weighting")
WEIGHTS: Final = ("acquisition", "weights")
SURROGATE: Final = ("surrogate",)
PROCESS: Final = ("gaussian_process",)

ADDED: Final = (
    Added(WEIGHTING, "method", "probability", "method", ("probability",)),
    Added(WEIGHTING, "exponent", 1, "method", ("probability",)),
    Added(("acquisition",), "screening", 0, "type", SAMPLING),
    Added(WEIGHTS, "ends", 0, "type", ("dirichlet",)),
    Added(WEIGHTS, "redraws", 0, "type", ("dirichlet",)),
    Added(SURROGATE, "lengthscale_location", math.sqrt(2.0), "type", PROCESS),
    Added(SURROGATE, "lengthscale_width", math.sqrt(3.0), "type", PROCESS),
    Added(SURROGATE, "noise_floor", 1e-6, "type", PROCESS),
    Added(SURROGATE, "restart", True, "type", PROCESS),
)

ADDED_LATER: Final[Mapping[str, str]] = {added.place: json.dumps(added.value) for added in ADDED}
"""The same by place, as JSON."""


def of_older_version(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return a scenario that a run has recorded, with the options it lacks as they were.

    A scenario that is not of a run folder (it names no versions) is returned as it is.
    """
    complete = copy.deepcopy(dict(document))
    versions = complete.get("versions")
    if not isinstance(versions, Mapping) or not any(versions.values()):
        return complete
    for added in ADDED:
        section: Any = complete
        for name in added.section:
            section = section.setdefault(name, {}) if isinstance(section, dict) else None
        if isinstance(section, dict) and section.get(added.key, added.members[0]) in added.members:
            section.setdefault(added.option, added.value)
    return complete
