"""Tables on disk know the cases that they have."""

import sys
from pathlib import Path

import pytest

HOME = str(Path(__file__).parents[2] / "benchmarks")


@pytest.fixture
def reporting():
    sys.path.insert(0, HOME)
    import reporting

    yield reporting
    sys.path.remove(HOME)


@pytest.mark.parametrize("noise", [0.0, 0.1, 1 / 3])
def test_case_with_a_number_is_measured_once_also_by_a_later_process(reporting, tmp_path: Path, noise: float) -> None:
    measured = []

    def measure(noise: float, seed: int) -> dict[str, float]:
        measured.append(seed)
        return {"noise": noise, "seed": seed, "regret": 0.5}

    for _ in range(2):
        table = reporting.ResultTable(tmp_path / "t.csv", ("noise", "seed", "regret"), key=("noise", "seed"))
        for seed in (0, 1, 0):
            table.fill({"noise": noise, "seed": seed}, measure)
    assert measured == [0, 1]
    assert len((tmp_path / "t.csv").read_text().splitlines()) == 3
