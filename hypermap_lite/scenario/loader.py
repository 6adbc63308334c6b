"""From a scenario file, or the same as a Python mapping, to one frozen `Scenario`, or one clear error."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.building import build_scenario
from hypermap_lite.scenario.consistency import check_consistency
from hypermap_lite.scenario.defaults import fill, fill_derived, fill_implied, has_priors
from hypermap_lite.scenario.hypermapper import Note, Translation, hypermappers_key, is_hypermapper, translate
from hypermap_lite.scenario.merging import apply_override, bases_of, merge, merge_layers, read_layers
from hypermap_lite.scenario.messages import check_document
from hypermap_lite.scenario.model import Scenario
from hypermap_lite.scenario.presets import PRESETS
from hypermap_lite.scenario.prior_from import replace_priors
from hypermap_lite.scenario.prior_points import with_points
from hypermap_lite.scenario.reading import parse_json
from hypermap_lite.scenario.recorded import with_old_defaults
from hypermap_lite.scenario.schemas import root_schema
from hypermap_lite.scenario.sources import Layer, located


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadScenario:
    """A scenario put together from its files and the changes on top, not checked yet."""

    document: Mapping[str, Any]
    """All of it merged, in our form."""

    layers: tuple[Layer, ...]
    """What it was put together from, the most basic first."""

    directory: Path
    """Folder of the scenario file."""

    notes: tuple[str, ...]
    """What was changed that the user did not spell out, a sentence each."""

    hypermappers_notes: tuple[Note, ...]
    """All that means something else than in HyperMapper, or nothing."""


def load_scenario(
    source: str | Path | Mapping[str, Any], *, overrides: Sequence[str] = (), prior_from: str | Path | None = None
) -> Scenario:
    """Read, merge, check and complete a scenario.

    Parameters
    ----------
    source
        Path of a JSON file, or its content as a mapping; then files it extends are relative to the working directory.
    overrides
        Changes on top, as in ``budget.evaluations=30``: a dotted path and a value in JSON, or else a string.
    prior_from
        Run folder or CSV file whose good configurations replace all priors of the scenario; before the overrides.

    Raises
    ------
    ScenarioError
        If anything is wrong with it; the message names the file, the place in it, and what would be right.
    """
    read = read_scenario(source, overrides=overrides, prior_from=prior_from)
    try:
        complete = with_points(complete_document(read.document), read.layers, read.directory)
        return build_scenario(complete, directory=read.directory, layers=read.layers, notes=read.notes)
    except ScenarioError as error:
        raise located(hypermappers_key(error), read.layers) from None


def read_scenario(
    source: str | Path | Mapping[str, Any], *, overrides: Sequence[str] = (), prior_from: str | Path | None = None
) -> ReadScenario:
    """Read and merge a scenario, as `load_scenario` does before it checks and completes it."""
    if isinstance(source, Mapping):
        directory, written = Path(), _layers_of(source)
    else:
        directory, written = Path(source).parent, read_layers(Path(source))
    translations = [_translation_of(layer) for layer in written]
    layers = [_translated(layer, t) for layer, t in zip(written, translations, strict=True)]
    notes = [note for translation in translations if translation for note in translation.brief()]
    document = merge_layers(layers)
    if prior_from is not None:
        document, layer, dropped = replace_priors(document, str(prior_from))
        layers.append(layer)
        notes += dropped
    for override in overrides:
        document, layer = apply_override(document, override)
        layers.append(layer)
    return ReadScenario(
        document=document,
        layers=tuple(layers),
        directory=directory,
        notes=tuple(notes),
        hypermappers_notes=tuple(note for translation in translations if translation for note in translation.notes),
    )


def _translation_of(layer: Layer) -> Translation | None:
    """Return the translation of a layer in HyperMapper's form; None for any other."""
    if not is_hypermapper(layer.document):
        return None
    try:
        return translate(layer.document, layer.directory or Path())
    except ScenarioError as error:
        raise error.within(layer.name) from None


def _translated(layer: Layer, translation: Translation | None) -> Layer:
    if translation is None:
        return layer
    return replace(layer, document=translation.document, places=translation.places)


def complete_document(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return a merged document with preset and defaults filled in, checked as far as JSON goes.

    Raises
    ------
    ScenarioError
        If the document breaks the schemas, or its sections contradict each other.
    """
    check_document(document)
    if document.get("preset"):
        preset = PRESETS[document["preset"]](has_priors=has_priors(document))
        document = merge(root_schema(), preset, document)
    complete = fill_derived(fill(root_schema(), fill_implied(with_old_defaults(document))))
    check_consistency(complete)
    return complete


def _layers_of(source: Mapping[str, Any]) -> list[Layer]:
    try:
        document = parse_json(json.dumps(source, default=_plain_value), "")
    except (TypeError, ValueError, RecursionError) as error:
        if isinstance(error, ScenarioError):
            raise
        raise ScenarioError("$", f"this is not JSON: {error}", allowed="JSON values only") from None
    return [*(layer for base in bases_of(document, "") for layer in read_layers(Path(base))), Layer("", document)]


def _plain_value(value: object) -> object:
    """Return a NumPy number or array as what JSON has for it."""
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    raise TypeError(f"Object of type {type(value).__name__} is not JSON serializable")
