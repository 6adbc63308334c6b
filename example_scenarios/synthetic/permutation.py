"""The cost of running eight jobs one after the other: those that are late cost by their weights."""

from collections.abc import Mapping
from typing import Any

HOURS = (3.0, 1.0, 4.0, 2.0, 5.0, 1.5, 2.5, 3.5)
"""Of each job at the rated speed [h]."""

DUE = (9.0, 4.0, 20.0, 3.0, 24.0, 6.0, 12.0, 16.0)
"""When each job should be ready [h]."""

WEIGHTS = (2.0, 1.0, 3.0, 2.0, 1.0, 4.0, 2.0, 1.0)
"""What an hour of delay of each job costs."""


def evaluate(configuration: Mapping[str, Any]) -> float:
    """Return the weighted delays of all jobs, plus what the speed costs in wear."""
    now, cost = 0.0, 0.0
    for job in configuration["order"]:
        now += HOURS[job] / configuration["speed"]
        cost += WEIGHTS[job] * max(now - DUE[job], 0.0)
    return cost + 5.0 * configuration["speed"] ** 3
