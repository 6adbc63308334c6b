"""Writes run folders as a run would leave them, for the tests of pictures and fronts."""

import csv
import json

import numpy as np

TWO_MAXIMIZED = (
    {"name": "performance", "goal": "maximize", "reference_point": None},
    {"name": "safety", "goal": "maximize", "reference_point": None},
)

ONE_PARAMETER = {
    "x": {"parameter_type": "real", "values": [0, 10], "prior": {"type": "gaussian", "mean": 2, "std": 1}},
}
TWO_PARAMETERS = {
    **ONE_PARAMETER,
    "k": {"parameter_type": "real", "values": [0.001, 1], "scale": "log"},
}


def write_run(
    folder,
    Y,
    *,
    objectives=TWO_MAXIMIZED,
    n_design=0,
    sem=None,
    states=None,
    name="demo",
    parameters=ONE_PARAMETER,
    configurations=None,
    **sections,
):
    """Write history.csv and scenario.json of a run with objective values Y, shape (n, m), NaN where not completed.

    `configurations` has a row of texts per evaluation, in the order of `parameters`; `sections` go to the scenario.
    """
    Y = np.asarray(Y, dtype=float)
    names = [o["name"] for o in objectives]
    sem = np.full(Y.shape, np.nan) if sem is None else sem
    folder.mkdir(parents=True, exist_ok=True)
    scenario = {"application_name": name, "input_parameters": parameters, "objectives": list(objectives), **sections}
    scenario["versions"] = {"hypermap_lite": "0"}
    (folder / "scenario.json").write_text(json.dumps(scenario))
    columns = [*parameters, *names, "Timestamp", "trial", "phase", "state", "replicates", *(f"{n}_sem" for n in names)]
    columns += ["prior_weight", "acquisition_value", "suggest_seconds", "evaluate_seconds", "error"]
    with (folder / "history.csv").open("w", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        for i, y in enumerate(Y):
            state = states[i] if states else "completed" if np.isfinite(y).all() else "failed"
            phase = "design" if i < n_design else "model"
            configuration = (
                configurations[i] if configurations else [repr(i / 10), repr((i + 1) / 1000)][: len(parameters)]
            )
            cells = [*map(_cell, y), 100 * i, i, phase, state, 7, *map(_cell, sem[i])]
            writer.writerow(
                [*configuration, *cells, "", "", "0.1", "0.2", "" if state == "completed" else "crashed, hard"]
            )
    return folder


def _cell(value):
    return repr(float(value)) if np.isfinite(value) else ""
