"""Random generators: one per purpose and trial, so that a resumed run draws what the uninterrupted one would."""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from hypermap_lite.typing import Rng


class Stream(IntEnum):
    """What a generator is for."""

    DESIGN = 0
    SUGGESTION = 1
    EVALUATION = 2
    EXPLORATION = 3
    NEIGHBOURS = 4
    RESTART = 5
    PRIOR = 6
    TRUST = 7
    ESCAPE = 8
    REPORT = 16


def generator(seed: int, stream: Stream, *numbers: int) -> Rng:
    """Return the generator of a stream and trial."""
    return np.random.default_rng([seed, stream, *numbers])
