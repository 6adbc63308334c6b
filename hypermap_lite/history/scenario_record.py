"""The scenario a run folder belongs to: written beside the results, compared before they are added to."""

from __future__ import annotations

import json
import logging
import platform
from collections.abc import Iterator, Mapping
from importlib import metadata
from pathlib import Path
from typing import Any, Final

from hypermap_lite import __version__
from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.files import write_atomically

logger = logging.getLogger(__name__)

MAY_DIFFER: Final = (
    "$.budget.evaluations",
    "$.budget.minutes",
    "$.evaluator.workers",
    "$.evaluator.timeout_seconds",
    "$.output",
    "$.description",
)
"""Parts of a scenario that may change between a run and its continuation: they do not change what a row means."""

LIBRARIES: Final = ("numpy", "scipy", "scikit-learn", "moocore")
"""Packages whose version can change the last bits of a suggestion."""

MISSING: Final = "nothing"
SHOWN_DIFFERENCES: Final = 8


def check_scenario(path: Path, canonical: Mapping[str, Any]) -> None:
    """Make sure that a run folder's ``scenario.json``, if there is one, is the scenario about to be run.

    A library of another version is only warned of.

    Raises
    ------
    RunFolderError
        If the scenarios differ in more than `MAY_DIFFER` (each difference is named), or the file cannot be read.
    """
    if not path.exists():
        return
    recorded = _read(path)
    versions = recorded.pop("versions", {})
    differences = list(differing(recorded, _plain(canonical)))
    if differences:
        shown = [f"  {place}: {old} there, {new} now" for place, old, new in differences[:SHOWN_DIFFERENCES]]
        if len(differences) > len(shown):
            shown.append(f"  ... and {len(differences) - len(shown)} more")
        raise RunFolderError(
            f"{path.parent}: holds the results of another scenario\n" + "\n".join(shown) + "\n"
            "  hint: Choose another folder with --output-dir, or --fresh to start anew (the old folder is kept aside)."
        )
    for name, version in versions.items():
        now = installed_versions().get(name)
        if now != version:
            logger.warning("%s was %s when this run began and is %s now; rows may differ", name, version, now)


def write_scenario(path: Path, canonical: Mapping[str, Any]) -> None:
    """Write the effective scenario and the versions in use, unless the file says exactly that already."""
    text = json.dumps({**_plain(canonical), "versions": installed_versions()}, indent=2, ensure_ascii=False) + "\n"
    if not path.exists() or path.read_text(encoding="utf-8", errors="replace") != text:
        write_atomically(path, text)


def differing(old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    """Yield place, old and new value (as JSON) of each difference between two scenarios that matters."""
    before, after = dict(_leaves("$", old)), dict(_leaves("$", new))
    for place in [*before, *(p for p in after if p not in before)]:
        is_free = any(place == free or place.startswith(f"{free}.") for free in MAY_DIFFER)
        if not is_free and before.get(place, MISSING) != after.get(place, MISSING):
            yield place, before.get(place, MISSING), after.get(place, MISSING)


def installed_versions() -> dict[str, str]:
    """Return the versions of this package, of Python and of the libraries that do the arithmetic."""
    versions = {"hypermap_lite": __version__, "python": platform.python_version()}
    for name in LIBRARIES:
        try:
            versions[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return versions


def _leaves(place: str, value: Any) -> Iterator[tuple[str, str]]:
    """Yield each innermost object entry with its place; lists count as one value."""
    if isinstance(value, dict) and value:
        for key, inner in value.items():
            yield from _leaves(f"{place}.{key}", inner)
    else:
        yield place, json.dumps(_whole_as_int(value), sort_keys=True, ensure_ascii=False)


def _whole_as_int(value: Any) -> Any:
    """Write 2.0 as 2, in lists and objects too: the same number in JSON."""
    if isinstance(value, float) and value.is_integer():
        return int(value)
    if isinstance(value, list):
        return [_whole_as_int(v) for v in value]
    if isinstance(value, dict):
        return {k: _whole_as_int(v) for k, v in value.items()}
    return value


def _plain(canonical: Mapping[str, Any]) -> dict[str, Any]:
    """Return the scenario as it comes back from JSON (lists for tuples)."""
    plain: dict[str, Any] = json.loads(json.dumps(canonical))
    return plain


def _read(path: Path) -> dict[str, Any]:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise RunFolderError(f"{path}: cannot be read: {error}\n  hint: Start anew with --fresh.") from error
    if not isinstance(content, dict):
        raise RunFolderError(f"{path}: is not a scenario\n  hint: Start anew with --fresh.")
    return content
