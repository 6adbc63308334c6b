"""Find the trade-off between the Branin function and the sum of its arguments."""

from collections.abc import Mapping

from formulas import branin


def evaluate(configuration: Mapping[str, float]) -> dict[str, float]:
    """Return both objectives at one configuration."""
    x1, x2 = configuration["x1"], configuration["x2"]
    return {"Value": branin(x1, x2), "Energy": x1 + x2}


if __name__ == "__main__":
    from pathlib import Path

    from hypermap_lite.optimizer import optimize

    optimize(str(Path(__file__).with_suffix(".json")), evaluate)
