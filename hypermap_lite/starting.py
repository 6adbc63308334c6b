"""How a run begins: from nothing, or from where its folder stands."""

from __future__ import annotations

from pathlib import Path

from hypermap_lite.assembly import build_space
from hypermap_lite.errors import RunFolderError, ScenarioError
from hypermap_lite.evaluation.earlier import earlier_evaluations
from hypermap_lite.evaluation.outcome import EARLIER, Evaluation
from hypermap_lite.history.backups import set_aside
from hypermap_lite.history.rows import read_history
from hypermap_lite.history.scenario_record import is_of_scenario
from hypermap_lite.scenario.model import Scenario


def set_run_folder_aside(scenario: Scenario) -> Path | None:
    """Rename the run folder of a scenario, if there is one, to ``<name>.bak-N``; return its new path.

    Raises
    ------
    RunFolderError
        If it is no run folder, is in use, or holds a file of the scenario or the working directory.
    """
    # A scenario of one's own stays where it is; one that is the record of the run goes with it.
    written = [layer.directory for layer in scenario.layers if layer.directory and "versions" not in layer.document]
    return set_aside(scenario.output.directory, needed=written)


def is_going_on(scenario: Scenario) -> bool:
    """Tell whether a scenario that HyperMapper's users start anew each time goes on with its run folder instead.

    It does if it says where earlier evaluations are, and the folder is that of the same scenario and began with them.
    """
    folder = Path(scenario.output.directory)
    if not scenario.canonical.get("earlier_evaluations"):
        return False
    return is_of_scenario(folder / "scenario.json", scenario.canonical) and _began_with_its_rows(scenario, folder)


def _began_with_its_rows(scenario: Scenario, folder: Path) -> bool:
    """Tell whether a run's first rows are those of the file of earlier evaluations, which may have more by now.

    A file that is gone is no reason to begin anew, nor is a folder without any rows.
    """
    space = build_space(scenario)
    try:
        rows = read_history(folder, space, scenario.objectives, scenario.feasible_output)
        there = [row for row in rows if row.suggestion.phase == EARLIER]
        now = earlier_evaluations(scenario, space)
    except (ScenarioError, RunFolderError):
        return True
    return not rows or list(map(_told, there)) == list(map(_told, now[: len(there)]))


def _told(row: Evaluation) -> tuple[object, ...]:
    return row.configuration, row.state, row.values
