"""Tests for starting.py."""

from dataclasses import replace

import pytest

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.scenario_record import write_scenario
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.model import Scenario
from hypermap_lite.starting import is_going_on, set_run_folder_aside


def scenario(folder, **canonical) -> Scenario:
    loaded = load_scenario(
        {
            "input_parameters": {"x": {"parameter_type": "real", "values": [-2, 2]}},
            "objectives": [{"name": "f"}],
            "output": {"directory": str(folder / "run")},
        }
    )
    return replace(loaded, canonical={**loaded.canonical, **canonical})


def record(given: Scenario, folder) -> None:
    (folder / "run").mkdir()
    write_scenario(folder / "run" / "scenario.json", given.canonical)


def test_scenario_without_earlier_evaluations_starts_anew(tmp_path):
    record(scenario(tmp_path), tmp_path)
    assert not is_going_on(scenario(tmp_path))


def test_scenario_with_earlier_evaluations_goes_on_with_its_own_folder(tmp_path):
    earlier = scenario(tmp_path, earlier_evaluations="rows.csv")
    assert is_going_on(earlier)
    record(earlier, tmp_path)
    assert is_going_on(earlier)


def test_folder_of_another_scenario_is_not_gone_on_with(tmp_path):
    record(scenario(tmp_path), tmp_path)
    assert not is_going_on(scenario(tmp_path, earlier_evaluations="rows.csv"))


def test_run_folder_is_renamed_and_others_are_refused(tmp_path):
    assert set_run_folder_aside(scenario(tmp_path)) is None
    record(scenario(tmp_path), tmp_path)
    assert set_run_folder_aside(scenario(tmp_path)) == tmp_path / "run.bak-1"
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "thesis.tex").write_text("")
    with pytest.raises(RunFolderError, match="is not a run folder"):
        set_run_folder_aside(scenario(tmp_path))
