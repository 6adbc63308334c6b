"""Find the front of two objectives under constraints that are known only by evaluating."""

from collections.abc import Mapping

from formulas import chakong_haimes


def evaluate(configuration: Mapping[str, float]) -> dict[str, float | bool]:
    """Return both objectives at one configuration, and whether it is allowed."""
    f1, f2, is_feasible = chakong_haimes(configuration["x1"], configuration["x2"])
    return {"f1": f1, "f2": f2, "Valid": is_feasible}


if __name__ == "__main__":
    from pathlib import Path

    from hypermap_lite.optimizer import optimize

    optimize(str(Path(__file__).with_suffix(".json")), evaluate)
