"""Minimize a product of two Branin functions, one of real and one of integer parameters."""

from collections.abc import Mapping

from formulas import branin


def evaluate(configuration: Mapping[str, float]) -> float:
    """Return the objective at one configuration; the smallest possible is about 0.1981."""
    x1, x2, x3, x4 = (configuration[name] for name in ("x1", "x2", "x3", "x4"))
    return branin(x1, x2) * branin(x3, x4)


if __name__ == "__main__":
    from pathlib import Path

    from hypermap_lite.optimizer import optimize

    optimize(str(Path(__file__).with_suffix(".json")), evaluate)
