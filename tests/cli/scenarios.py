"""A small scenario and its black box, written where a test wants them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

BLACK_BOX = """
import time
from pathlib import Path

HERE = Path(__file__).parent


def evaluate(configuration, seed, trial, replicate):
    with (HERE / "begun").open("a") as file:
        file.write(f"{trial} {replicate}\\n")
    time.sleep(SECONDS)
    x, k = configuration["x"], configuration["k"]
    return {"f": x**2 + k + seed * 1e-12, "g": (x - 1) ** 2 - k}


def wait_for_a_file(configuration, trial):
    (HERE / f"waiting_{trial}").write_text("")
    while trial >= 2 and not (HERE / "go").exists():
        time.sleep(0.01)
    return {"f": configuration["x"], "g": -configuration["x"]}


def crash(configuration):
    raise RuntimeError("no such luck")


def crash_unless_mended(configuration, seed):
    if not (HERE / "mended").exists():
        raise RuntimeError("broken")
    return {"f": configuration["x"] + seed * 1e-12, "g": -configuration["x"]}


def huge(configuration):
    x = configuration["x"] * 0.8e308
    return {"f": x, "g": -x}


def crash_first(configuration, trial):
    if trial == 0:
        raise RuntimeError("cold start")
    return {"f": configuration["x"], "g": -configuration["x"]}
"""


def write_scenario(folder: Path, *, seconds: float = 0.0, function: str = "evaluate", **sections: Any) -> Path:
    """Write a scenario of random search and its module; `sections` replace whole sections."""
    module = f"black_box_{abs(hash(str(folder))) % 10**9}"
    (folder / f"{module}.py").write_text(BLACK_BOX.replace("SECONDS", str(seconds)))
    content = {
        "application_name": "demo",
        "input_parameters": {
            "x": {"parameter_type": "real", "values": [-2, 2]},
            "k": {"parameter_type": "integer", "values": [0, 9]},
        },
        "objectives": [{"name": "f"}, {"name": "g"}],
        "budget": {"evaluations": 8, "batch_size": 2},
        "design_of_experiment": {"number_of_samples": 2},
        "optimizer": "random_search",
        "evaluator": {"type": "python", "function": f"{module}:{function}", "replicates": 1},
        "output": {"directory": str(folder / "run")},
    }
    for name, section in sections.items():
        old = content.get(name)
        content[name] = {**old, **section} if isinstance(old, dict) and isinstance(section, dict) else section
    path = folder / "scenario.json"
    path.write_text(json.dumps(content))
    return path
