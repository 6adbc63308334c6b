"""Seeds of single evaluations, from the scenario's seed and nothing else."""

from __future__ import annotations

from typing import Final

import numpy as np

STREAM: Final = 2
"""Number of this stream of random numbers; the others belong to the optimizer."""


def replicate_seed(scenario_seed: int, trial: int, replicate: int) -> int:
    """Return the seed of one call of the black box, 0 to 2**31 - 1."""
    state = np.random.SeedSequence([scenario_seed, STREAM, trial, replicate]).generate_state(1)
    return int(state[0]) >> 1
