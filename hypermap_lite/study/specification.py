"""From a study's file to one frozen `Study`, or one clear error."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from hypermap_lite.assembly import build_space, validate
from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.history.scenario_record import check_scenario
from hypermap_lite.objectives import Objective
from hypermap_lite.scenario import Scenario, load_scenario
from hypermap_lite.scenario.defaults import fill
from hypermap_lite.scenario.messages import check_document, enumerate_names
from hypermap_lite.scenario.reading import read_json
from hypermap_lite.scenario.schemas import STUDY, study_schema
from hypermap_lite.study.folder import is_finished

OWN_KEYS: Final = {
    "seed": "See first_seed.",
    "output": "See the study's output.",
    "output.directory": "See the study's output.",
}
"""Keys of the scenarios that a study sets for each run itself, and what to change instead."""

UNSHARED: Final = ("samples_file", "pareto_file")
"""Files of a scenario's output that a study leaves out: all its runs would write the same one."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Variant:
    """One of the things that are compared."""

    name: str
    label: str
    """What tables and legends call it."""

    scenario: Path
    """Its scenario file."""

    overrides: tuple[str, ...]
    """Changes to the scenario, as in ``budget.evaluations=30``."""

    effective: Scenario
    """The scenario with these changes."""

    n_evaluations: int
    """Evaluations of a whole run: its budget, or all configurations of its space if these are fewer."""

    def validate(self) -> None:
        """Build all its parts once, so that every mistake shows before the first evaluation.

        Raises
        ------
        ScenarioError
            For the first mistake found; the message names the file.
        """
        try:
            validate(self.effective)
        except ScenarioError as error:
            raise self.effective.located(error).within(str(self.scenario)) from error


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Run:
    """One repetition of one variant."""

    variant: Variant
    seed: int
    folder: Path

    @property
    def overrides(self) -> tuple[str, ...]:
        """Changes to the variant's scenario, those of this run included."""
        own = (f"seed={self.seed}", f"output.directory={json.dumps(str(self.folder))}")
        return (*self.variant.overrides, *(f"output.{key}=null" for key in UNSHARED), *own)

    @property
    def canonical(self) -> Mapping[str, Any]:
        """The effective scenario as JSON."""
        scenario = self.variant.effective.canonical
        output = {**scenario["output"], "directory": str(self.folder), **dict.fromkeys(UNSHARED)}
        return {**scenario, "seed": self.seed, "output": output}

    def check_folder(self) -> None:
        """Make sure that the folder, if there is one, is that of this run.

        Raises
        ------
        RunFolderError
            If it holds the results of another scenario.
        """
        advice = "Choose another folder with --output-dir, or move this one away."
        ended = is_finished(self.folder, self.variant.n_evaluations)
        check_scenario(self.folder / "scenario.json", self.canonical, is_finished=ended, advice=advice)

    def __str__(self) -> str:
        return f"{self.variant.name}/{self.folder.name}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """Variants of an experiment, each to be run several times."""

    name: str
    description: str
    variants: tuple[Variant, ...]
    repetitions: int
    first_seed: int
    baseline: Variant
    """The variant that the others are compared with."""

    metrics: Mapping[str, str]
    """How extra numbers of the evaluator are added up over a run: ``mean``, ``sum`` or ``max``, by name."""

    reference_front: Path | None
    """CSV with the front whose hypervolume is 1; None for that of all runs together."""

    folder: Path
    canonical: Mapping[str, Any]
    """The file's content with every default filled in and the changes made on the command line."""

    @property
    def objectives(self) -> tuple[Objective, ...]:
        """The objectives, the same for all variants."""
        return self.baseline.effective.objectives

    def runs(self) -> Iterator[Run]:
        """Yield all runs, the first repetition of every variant first, so that a stopped study compares all of them."""
        for seed in range(self.first_seed, self.first_seed + self.repetitions):
            for variant in self.variants:
                # two digits whatever the number of repetitions: folders keep their names when more are added
                folder = self.folder / "runs" / variant.name / f"{seed:02d}"
                yield Run(variant=variant, seed=seed, folder=folder)


def load_study(
    file: str | Path,
    *,
    is_quick: bool = False,
    repetitions: int | None = None,
    only: Sequence[str] = (),
    overrides: Sequence[str] = (),
    output: str | Path | None = None,
) -> Study:
    """Read and check a study's file and the scenarios it names.

    Parameters
    ----------
    file
        A JSON file, as ``scenario_schemas/study.schema.json`` describes it.
    is_quick
        Whether its quick form is wanted.
    repetitions
        Runs per variant, instead of the file's.
    only
        Names of the variants to run; all if empty. The baseline is always among them.
    overrides
        Changes to the scenarios of all variants on top of the file's, as in ``budget.evaluations=30``.
    output
        Folder of the study, instead of the file's.

    Raises
    ------
    ScenarioError
        If the file or a scenario is not valid, or the variants measure different things; the message names the file
        and the place in it.
    """
    path = Path(file)
    document = read_json(path)
    try:
        check_document(document, STUDY)
        complete = fill(study_schema(), document)
        complete = _quick_form(complete) if is_quick else {**complete, "quick": None}
        complete = _changed(complete, repetitions=repetitions, only=only, overrides=overrides, output=output)
        variants = tuple(_variant(complete, name, path.parent) for name in complete["variants"])
        _check_labels(variants)
        _check_objectives(variants)
    except ScenarioError as error:
        raise error.within(str(path)) from None
    front = complete["reference_front"]
    if front is not None and not _beside(path.parent, front).is_file():
        allowed = "a CSV file, relative to the folder of this file"
        raise ScenarioError("$.reference_front", f'there is no file "{front}"', allowed=allowed, file=str(path))
    return Study(
        name=complete["name"],
        description=complete["description"],
        variants=variants,
        repetitions=complete["repetitions"],
        first_seed=complete["first_seed"],
        baseline=next(v for v in variants if v.name == complete["baseline"]),
        metrics=complete["metrics"],
        reference_front=None if front is None else _beside(path.parent, front),
        folder=Path(os.path.expanduser(complete["output"])),
        canonical=complete,
    )


def _quick_form(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return the document of a study's quick form: fewer repetitions, a folder of its own; `_variant` does the rest."""
    folder = None if document["output"] is None else f"{document['output'].rstrip('/')}_quick"
    repetitions = min(document["quick"]["repetitions"], document["repetitions"])
    name = f"{document['name']}_quick"
    return {**document, "name": name, "repetitions": repetitions, "output": folder}


def _changed(
    document: Mapping[str, Any],
    *,
    repetitions: int | None,
    only: Sequence[str],
    overrides: Sequence[str],
    output: str | Path | None,
) -> dict[str, Any]:
    """Return the document with the changes of the command line."""
    variants = document["variants"]
    baseline = document["baseline"] or next(iter(variants))
    for path, name in [("$.baseline", baseline), *(("--only", name) for name in only)]:
        if name not in variants:
            allowed, hint = enumerate_names(variants), nearest(name, variants)
            raise ScenarioError(path, f"there is no variant '{name}'", allowed=allowed, hint=hint)
    kept = {name: v for name, v in variants.items() if not only or name in only or name == baseline}
    changed = {**document, "variants": kept, "baseline": baseline}
    if repetitions is not None:
        changed["repetitions"] = repetitions
    folder = document["output"] or f"outputs/studies/{document['name']}"
    changed["output"] = folder if output is None else str(output)
    for override in overrides:
        _refuse_own(f"--set {override}", override.partition("=")[0].strip())
    changed["overrides"] = list(overrides)
    return changed


def _variant(document: Mapping[str, Any], name: str, directory: Path) -> Variant:
    """Load one variant's scenario with all changes to it."""
    entry, path = document["variants"][name], f"$.variants.{name}"
    file = _scenario_file(directory, entry["scenario"], f"{path}.scenario")
    changes = _changes(document, name)
    overrides = (*(override for _, override in changes), *document["overrides"])
    try:
        effective = load_scenario(file, overrides=overrides)
        n_configurations = _count_configurations(effective)
    except ScenarioError as error:
        raise _at_home(error, {override: place for place, override in changes}) from None
    if effective.budget.minutes is not None:
        problem = f"its runs would end after {effective.budget.minutes:g} minutes, wherever they are then"
        hint = 'Add "budget.minutes": null to its set.'
        raise ScenarioError(path, problem, allowed="a budget of evaluations alone", hint=hint)
    if effective.evaluator.is_client:
        problem, allowed = "its runs would each need a client of their own", "an evaluator that a study can call"
        raise ScenarioError(path, problem, allowed=allowed)
    return Variant(
        name=name,
        label=entry["label"] or name.replace("_", " "),
        scenario=file,
        overrides=overrides,
        effective=effective,
        n_evaluations=int(min(effective.budget.evaluations, n_configurations)),
    )


def _scenario_file(directory: Path, name: str, path: str) -> Path:
    """Return the scenario file that a variant names at some place of the study's file."""
    file = _beside(directory, name)
    if not file.exists():
        hint = nearest(file.name, [other.name for other in file.parent.glob("*.json")])
        allowed = "a path relative to the folder of this file"
        raise ScenarioError(path, f'there is no file "{name}"', allowed=allowed, hint=hint)
    return file


def _changes(document: Mapping[str, Any], name: str) -> list[tuple[str, str]]:
    """Return the changes that a study's file makes to a variant's scenario, each with its place, the last ones win."""
    sets = [("$.set", document["set"]), (f"$.variants.{name}.set", document["variants"][name]["set"])]
    sets += [("$.quick.set", document["quick"]["set"])] if document["quick"] else []
    for place, changes in sets:
        for key in changes:
            _refuse_own(f"{place}.{key}", key)
    return [(place, f"{key}={json.dumps(value)}") for place, changes in sets for key, value in changes.items()]


def _count_configurations(scenario: Scenario) -> float:
    try:
        return build_space(scenario).n_configurations
    except ScenarioError as error:
        raise scenario.located(error) from None


def _refuse_own(path: str, key: str) -> None:
    """Raise a `ScenarioError` if a study sets a key itself."""
    if key in OWN_KEYS:
        raise ScenarioError(path, "a study sets this for each run itself", hint=OWN_KEYS[key])


def _at_home(error: ScenarioError, places: Mapping[str, str]) -> ScenarioError:
    """Return an error at the place in the study's file that it comes from, if it does, by the overrides made of it."""
    place = places.get(error.file.removeprefix("--set "))
    if place is None:
        return error
    return ScenarioError(place, f"{error.path}: {error.problem}", allowed=error.allowed, hint=error.hint)


def _beside(directory: Path, name: str) -> Path:
    """Return a path that is relative to the folder of the study's file."""
    return directory / Path(os.path.expanduser(name))


def _check_labels(variants: Sequence[Variant]) -> None:
    """Raise a `ScenarioError` if two variants could not be told apart in tables and pictures."""
    names: dict[str, str] = {}
    for variant in variants:
        if variant.label in names:
            problem = f"'{names[variant.label]}' has the label '{variant.label}' too"
            raise ScenarioError(f"$.variants.{variant.name}.label", problem, allowed="a label of its own")
        names[variant.label] = variant.name


def _check_objectives(variants: Sequence[Variant]) -> None:
    """Raise a `ScenarioError` unless all variants have the same objectives and reference point."""
    first = variants[0]
    for variant in variants:
        if variant.effective.objectives != first.effective.objectives:
            ours, theirs = (_describe(v.effective.objectives) for v in (variant, first))
            problem = f"its objectives are {ours}; those of '{first.name}' are {theirs}"
            raise ScenarioError(f"$.variants.{variant.name}", problem, allowed="the same objectives in all variants")


def _describe(objectives: Sequence[Objective]) -> str:
    """Return objectives for a message: ``f (minimize, reference point 3)``."""
    points = ("" if o.reference_point is None else f", reference point {o.reference_point:g}" for o in objectives)
    return ", ".join(f"{o.name} ({o.goal.value}{point})" for o, point in zip(objectives, points, strict=True))
