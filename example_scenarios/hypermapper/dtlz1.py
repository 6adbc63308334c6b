"""Find the front of two objectives of six parameters, where both sum to 0.5."""

from collections.abc import Mapping

from formulas import dtlz1


def evaluate(configuration: Mapping[str, float]) -> dict[str, float]:
    """Return both objectives at one configuration."""
    f1, f2 = dtlz1([configuration[f"x{i}"] for i in range(1, 7)])
    return {"f1": f1, "f2": f2}


if __name__ == "__main__":
    from pathlib import Path

    from hypermap_lite.optimizer import optimize

    optimize(str(Path(__file__).with_suffix(".json")), evaluate)
