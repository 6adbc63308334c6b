"""How a run begins: from nothing, or from where its folder stands."""

from __future__ import annotations

from pathlib import Path

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.backups import set_aside
from hypermap_lite.history.scenario_record import check_scenario
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

    It does if it says where earlier evaluations are, and the folder is that of the same scenario.
    """
    if not scenario.canonical.get("earlier_evaluations"):
        return False
    try:
        check_scenario(Path(scenario.output.directory) / "scenario.json", scenario.canonical)
    except RunFolderError:
        return False
    return True
