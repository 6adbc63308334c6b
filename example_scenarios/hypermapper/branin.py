"""Find one of the three minima of the Branin function, 0.397887."""

from collections.abc import Mapping

from formulas import branin


def evaluate(configuration: Mapping[str, float]) -> float:
    """Return the objective at one configuration."""
    return branin(configuration["x1"], configuration["x2"])


if __name__ == "__main__":
    from pathlib import Path

    from hypermap_lite.optimizer import optimize

    optimize(str(Path(__file__).with_suffix(".json")), evaluate)
