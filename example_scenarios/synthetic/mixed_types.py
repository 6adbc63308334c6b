"""A stand-in for training a small network: every kind of parameter, and noise from the seed."""

import math
import random
from collections.abc import Mapping
from typing import Any

PENALTIES = {"adam": 0.0, "sgd": 0.05, "rmsprop": 0.02}
"""What each optimizer adds to the error."""


def evaluate(configuration: Mapping[str, Any], seed: int) -> dict[str, float]:
    """Return the validation error [1] and the training time [s] of one training with this seed."""
    work = configuration["layers"] * configuration["width"]
    error = (
        0.05
        + 0.04 * (math.log10(configuration["learning_rate"]) + 2.5) ** 2
        + 0.02 * (math.log10(configuration["weight_decay"]) + 4) ** 2
        + 0.3 * (configuration["dropout"] - 0.2) ** 2
        + 0.1 * (configuration["momentum"] - 0.9) ** 2
        + 2.0 / work
        + 0.0004 * abs(configuration["batch_size"] - 64)
        + PENALTIES[configuration["optimizer"]]
    )
    minutes = 0.2 + work / 200 + 8 / configuration["batch_size"]
    noise = random.Random(seed).gauss(0, 0.003)
    return {"validation_error": error + noise, "seconds_to_train": 60 * minutes, "work": work}
