"""Minimize the function of Currin et al. on a grid of two ordinal parameters."""

from collections.abc import Mapping

from formulas import currin


def evaluate(configuration: Mapping[str, float]) -> float:
    """Return the objective at one configuration; the smallest possible is 1.1804."""
    return currin(configuration["x1"], configuration["x2"])


if __name__ == "__main__":
    from pathlib import Path

    from hypermap_lite.optimizer import optimize

    optimize(str(Path(__file__).with_suffix(".json")), evaluate)
