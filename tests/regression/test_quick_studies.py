"""The quick form of each of the paper's studies runs, from the command line to the figures: minutes each, so long."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from hypermap_lite.cli import main

STUDIES = sorted((Path(__file__).parents[2] / "example_scenarios" / "robot" / "studies").glob("*.json"))


@pytest.mark.long
@pytest.mark.parametrize("file", STUDIES, ids=lambda file: file.stem)
def test_quick_study_runs_to_its_figures(file: Path, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    assert main(["--quiet", "study", str(file), "--quick", "--output-dir", str(tmp_path)]) == 0
    with (tmp_path / "comparison.csv").open(newline="") as stream:
        rows = {row["variant"]: row for row in csv.DictReader(stream)}
    assert list(rows) == list(json.loads(file.read_text())["variants"])
    assert {(row["runs"], row["evaluations"]) for row in rows.values()} == {("3", "25")}
    if "operator_prior" in rows:  # what holds in every task, with these seeds: it is worth something
        assert float(rows["operator_prior"]["ratio"]) > 1.0
    for picture in ("hypervolume.png", "attainment.png"):
        assert (tmp_path / picture).stat().st_size > 10_000
