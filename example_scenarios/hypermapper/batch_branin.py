"""Minimize the Branin function, two configurations per call."""

from collections.abc import Mapping, Sequence

from formulas import branin


def evaluate(batch: Mapping[str, Sequence[float]]) -> list[float]:
    """Return the objective of each configuration: the values of a parameter come, and the results go, as lists."""
    return [branin(x1, x2) for x1, x2 in zip(batch["x1"], batch["x2"], strict=True)]


if __name__ == "__main__":
    from pathlib import Path

    from hypermap_lite.optimizer import optimize

    optimize(str(Path(__file__).with_suffix(".json")), evaluate)
