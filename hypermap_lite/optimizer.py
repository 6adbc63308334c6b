"""HyperMapper's entry from Python: ``optimizer.optimize(file, function)``.

    from hypermap_lite import optimizer     # was: from hypermapper import optimizer
    optimizer.optimize("scenario.json", function)

What else there is to say about a run, `hypermap_lite.optimize` takes.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from hypermap_lite.result import Result
from hypermap_lite.run import run_scenario
from hypermap_lite.scenario import load_scenario
from hypermap_lite.starting import is_going_on, set_run_folder_aside

logger = logging.getLogger(__name__)


def optimize(
    parameters_file: str | Path | Mapping[str, Any], black_box_function: Callable[..., Any] | None = None
) -> Result:
    """Run a scenario from its beginning, as HyperMapper does.

    The former run folder, if there is one, is renamed to ``<name>.bak-N``. Only a scenario that says where earlier
    evaluations are goes on with its run folder. stdout stays what it is.

    Parameters
    ----------
    parameters_file
        A scenario file, or its content as a mapping.
    black_box_function
        Called with a mapping of parameter values; returns a number if there is one objective, or a mapping of all
        outputs. In a scenario whose evaluator has ``"batch": true`` (HyperMapper: several evaluations per iteration)
        it is called with a mapping of lists and returns a list, or a mapping of lists. Not called if the scenario
        has a client or a table to answer.

    Returns
    -------
    Result
        What the run has found.

    Raises
    ------
    HypermapLiteError
        If the scenario cannot be run, or the run ends without a usable result; see `hypermap_lite.optimize`.
    """
    scenario = load_scenario(parameters_file)
    component = scenario.evaluator.component
    if black_box_function is not None and component is not None and component.type in ("client_server", "exhaustive"):
        logger.warning("the function is not called: the scenario's evaluator is %s", component.type)
        black_box_function = None
    on_built = None if is_going_on(scenario) else partial(set_run_folder_aside, scenario)
    return run_scenario(scenario, black_box_function, on_built=on_built)
