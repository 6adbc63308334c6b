"""Names and files: the run folder, HyperMapper's CSVs, the black box, the seed."""

from __future__ import annotations

import os
import re
from typing import Final

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.hypermapper.draft import Draft
from hypermap_lite.scenario.table import Table, read_table

FILE_DEFAULTS: Final = {"output_data_file": "output_samples.csv", "output_pareto_file": "output_pareto.csv"}
"""Names that stand for the application's name and the same."""

MODES: Final = "default, client-server, exhaustive"
"""Modes that there are here too."""

FAILED: Final = ("failed", "timeout")
"""States of evaluations that are not taken over."""

RUN_FOLDER: Final = "run"
"""End of the run folder's name."""


def translate_names(draft: Draft) -> None:
    """Translate the names of the application and the objectives, and the seed."""
    reading = draft.reading
    name = safe_name(reading["application_name"])
    draft.set("application_name", name, "application_name")
    if name != reading["application_name"]:
        draft.note("application_name", f"here it is '{name}': letters, digits, _, - and . only; the CSVs keep the name")
    objectives = [{"name": objective} for objective in reading["optimization_objectives"]]
    draft.set("objectives", objectives, "optimization_objectives")
    for i, objective in enumerate(reading["optimization_objectives"]):
        draft.places[f"$.objectives[{i}].name"] = f"$.optimization_objectives[{i}]"
        if not objective:
            raise ScenarioError(f"$.optimization_objectives[{i}]", "the name is empty", allowed="a name")
    if reading.has("seed"):
        draft.set("seed", reading["seed"], "seed")


def safe_name(name: str) -> str:
    """Return an application's name with the characters that ours may have."""
    return re.sub(r"[^0-9A-Za-z_.-]", "_", name).lstrip(".") or "application"


def translate_output(draft: Draft) -> None:
    """Translate where the results go, and what is printed at the end."""
    reading = draft.reading
    folder = f"{safe_name(reading['application_name'])}_{RUN_FOLDER}"
    old = earlier_rows(draft)
    if old is not None:
        # One folder per starting point: resuming from one's own, growing output file never meets an old run's folder.
        folder += f"_after_{n_usable(old)}"
    draft.set("output.directory", in_run_directory(draft, folder), "run_directory")
    for key, ours in (("output_data_file", "samples_file"), ("output_pareto_file", "pareto_file")):
        draft.set(f"output.{ours}", in_run_directory(draft, _file_name(draft, key)), key)
    if reading.has("run_directory"):
        draft.note("run_directory", f"all else goes to the run folder {draft.document['output']['directory']}")
    for key, ours in (
        ("print_parameter_importance", "parameter_importance"),
        ("print_posterior_best", "posterior_best"),
    ):
        if reading[key]:
            draft.set(f"output.{ours}", True, key)


def translate_black_box(draft: Draft) -> None:
    """Translate who evaluates, and the verdict on feasibility."""
    reading, mode = draft.reading, draft.reading["hypermapper_mode.mode"]
    key = "hypermapper_mode.mode"
    draft.places["$.evaluator"] = f"$.{key}"
    if mode == "client-server":
        draft.set("evaluator.type", "client_server", key)
    elif mode == "exhaustive":
        file = reading["hypermapper_mode.exhaustive_search_file"]
        if file is None:
            problem = "the key 'exhaustive_search_file' is missing"
            raise ScenarioError("$.hypermapper_mode", problem, allowed="a CSV file", hint="Name the table.")
        draft.set("evaluator.type", "exhaustive", key)
        draft.set("evaluator.file", draft.file(file), "hypermapper_mode.exhaustive_search_file")
    elif mode != "default":
        hint = "From Python, hypermap_lite.Optimizer has ask and tell."
        raise ScenarioError(f"$.{key}", f"there is no mode '{mode}' here", allowed=MODES, hint=hint)
    if mode != "exhaustive":
        draft.unused(("hypermapper_mode.exhaustive_search_file",), "without the mode exhaustive")
    _translate_feasibility(draft)


def _translate_feasibility(draft: Draft) -> None:
    reading = draft.reading
    names = ("name", "true_value", "false_value")
    if not reading["feasible_output.enable_feasible_predictor"]:
        for name in names:
            draft.unused((f"feasible_output.{name}",), "without enable_feasible_predictor")
        return
    # HyperMapper's defaults change their case as soon as the file has the object.
    implied = {"name": "Valid", "true_value": "true", "false_value": "false"}
    for name in names:
        key = f"feasible_output.{name}"
        draft.set(key, reading.given.get(key, implied[name]), key)
    missing = [name for name in names[1:] if f"feasible_output.{name}" not in reading.given]
    if missing:
        texts = " and ".join(f'{name} is "{implied[name]}"' for name in missing)
        draft.note("feasible_output", f"{texts}, in lower case: HyperMapper's default where the object leaves it out")


def earlier_rows(draft: Draft) -> Table | None:
    """Return the table that a run resumes from; None if it begins anew.

    Raises
    ------
    ScenarioError
        If there is no such table.
    """
    reading = draft.reading
    if not reading["resume_optimization"]:
        return None
    key, file = resumed_file(draft)
    path = draft.find(file)
    if path is None:
        hint = "Set resume_optimization to false to begin anew."
        raise ScenarioError(f"$.{key}", f"there is no file '{file}'", allowed="a CSV file of an earlier run", hint=hint)
    try:
        return read_table(path, file)
    except ScenarioError as error:
        raise error.below(f"$.{key}") from None


def n_usable(table: Table) -> int:
    """Return how many rows of a table a run takes over: all but those that a ``history.csv`` says have failed."""
    states = table.column("state") if "state" in table.header else []
    return len(table.records) - sum(state in FAILED for state in states)


def resumed_file(draft: Draft) -> tuple[str, str]:
    """Return the key that names the table a run resumes from, and the file."""
    reading = draft.reading
    newer = reading["resume_optimization_file"]
    key = "resume_optimization_data" if newer is None else "resume_optimization_file"
    file = reading[key]
    if file == FILE_DEFAULTS["output_data_file"]:
        file = f"{reading['application_name']}_{file}"
    return key, file


def in_run_directory(draft: Draft, file: str) -> str:
    """Return a file or folder as seen from the working directory."""
    directory = draft.reading["run_directory"]
    return file if directory in (".", "") else os.path.join(directory, file)


def _file_name(draft: Draft, key: str) -> str:
    name: str = draft.reading[key]
    return f"{draft.reading['application_name']}_{name}" if name == FILE_DEFAULTS[key] else name
