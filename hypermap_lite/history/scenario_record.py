"""The scenario a run folder belongs to: written beside the results, compared before they are added to."""

from __future__ import annotations

import json
import logging
import platform
import re
from collections.abc import Iterable, Iterator, Mapping
from importlib import metadata
from pathlib import Path
from typing import Any, Final

from hypermap_lite import __version__
from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.added_later import ADDED_LATER
from hypermap_lite.history.files import write_atomically
from hypermap_lite.history.processor import processor_in_use

logger = logging.getLogger(__name__)

MAY_DIFFER: Final = (
    "$.application_name",
    "$.budget.confirm_front",
    "$.budget.evaluations",
    "$.budget.minutes",
    "$.evaluator.max_consecutive_failures",
    "$.evaluator.timeout_seconds",
    "$.evaluator.workers",
    "$.output.*",
    "$.description",
    "$.input_parameters.*.description",
    "$.objectives[*].description",
    "$.priors[*].file",
)
"""Parts of a scenario that may change between a run and its continuation: they do not change what a row means.

A star stands for one key or index. The name matters only where it names the folder, and then it leads to another one.
The file of a prior has been read: its points count.
"""


MAY_MOVE: Final = ("$.earlier_evaluations",)
"""Files that have been read into the history: another path is no difference, but one where there was none is."""


def _pattern(places: Iterable[str]) -> re.Pattern[str]:
    return re.compile("|".join(re.escape(place).replace(r"\*", r"[^.\[\]]+") for place in places))


_FREE: Final = _pattern(MAY_DIFFER)

MEASURES: Final = ("$.objectives[*].reference_point",)
"""Parts of a scenario that decide how a finished run is measured; in a running one they also guide the search."""

LIBRARIES: Final = ("numpy", "scipy", "scikit-learn", "moocore")
"""Packages whose version can change the last bits of a suggestion."""

MISSING: Final = "nothing"
OWN_EVALUATOR: Final = "the scenario's own evaluator"
SHOWN_DIFFERENCES: Final = 8
SHOWN_CHARACTERS: Final = 60
"""Of a value; of a longer one, such as the points of a prior, only the surroundings of the difference."""


ADVICE: Final = "Choose another folder with --output-dir, or --fresh to start anew (the old folder is kept aside)."


def check_scenario(
    path: Path,
    canonical: Mapping[str, Any],
    function: str | None = None,
    *,
    is_finished: bool = False,
    advice: str = ADVICE,
) -> None:
    """Make sure that a run folder's ``scenario.json``, if there is one, is the scenario about to be run.

    If the run is finished, its `MEASURES` may differ too. A library of another version is only warned of, and so is
    another `function` passed in place of the evaluator.

    Raises
    ------
    RunFolderError
        If the scenarios differ in more than `MAY_DIFFER` (each difference is named), or the file cannot be read.
    """
    if not path.exists():
        return
    recorded = _read(path)
    versions = recorded.pop("versions", None)
    measures = _pattern(MEASURES)
    differences = [
        difference
        for difference in differing(recorded, _plain(canonical))
        if not (is_finished and measures.fullmatch(difference[0]))
    ]
    if differences:
        shown = [
            f"  {place}: {old} there, {new} now"
            for place, *values in differences[:SHOWN_DIFFERENCES]
            for old, new in [_around_difference(*values)]
        ]
        if len(differences) > len(shown):
            shown.append(f"  ... and {len(differences) - len(shown)} more")
        raise RunFolderError(
            f"{path.parent}: holds the results of another scenario\n" + "\n".join(shown) + f"\n  hint: {advice}"
        )
    _compare_versions(versions if isinstance(versions, dict) else {}, versions_in_use(function))


def is_of_scenario(path: Path, canonical: Mapping[str, Any]) -> bool:
    """Tell, without a word, whether a run folder's ``scenario.json`` passes `check_scenario`; True if there is none."""
    if not path.exists():
        return True
    try:
        recorded = _read(path)
    except RunFolderError:
        return False
    recorded.pop("versions", None)
    return not any(differing(recorded, _plain(canonical)))


def _around_difference(old: str, new: str) -> tuple[str, str]:
    """Cut two long texts to what surrounds the first character in which they differ."""
    common = next((i for i, (a, b) in enumerate(zip(old, new, strict=False)) if a != b), min(len(old), len(new)))
    start = max(common - SHOWN_CHARACTERS // 2, 0)
    old, new = (
        text
        if len(text) <= SHOWN_CHARACTERS
        else "... " * (start > 0) + text[start : start + SHOWN_CHARACTERS] + " ..."
        for text in (old, new)
    )
    return old, new


def _compare_versions(before: Mapping[str, Any], now: Mapping[str, str]) -> None:
    """Warn of each version that differs, and of the function; records without versions are not compared."""
    names = [*before, *(["function"] if before and "function" in now and "function" not in before else [])]
    for name in names:
        absent = OWN_EVALUATOR if name == "function" else None
        old, new = before.get(name, absent), now.get(name, absent)
        if old != new:
            what = "the function called" if name == "function" else name
            logger.warning("%s was %s before and is %s now; rows may differ", what, old, new)


def write_scenario(path: Path, canonical: Mapping[str, Any], function: str | None = None) -> None:
    """Write the effective scenario and the versions in use, unless the file says exactly that already.

    Parameters
    ----------
    path
        The file.
    canonical
        The scenario as JSON.
    function
        Name of the Python function that is called in place of the scenario's evaluator, if one was passed.
    """
    versions = versions_in_use(function)
    text = json.dumps({**_plain(canonical), "versions": versions}, indent=2, ensure_ascii=False) + "\n"
    if not path.exists() or path.read_text(encoding="utf-8", errors="replace") != text:
        write_atomically(path, text)


def differing(old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    """Yield place, old and new value (as JSON) of each difference between two scenarios that matters."""
    before, after = dict(_leaves("$", old)), dict(_leaves("$", new))
    for place in [*before, *(p for p in after if p not in before)]:
        values = before.get(place, ADDED_LATER.get(place, MISSING)), after.get(place, MISSING)
        # What is null is by default, what is false is off, and no items are none: an option that an older version did
        # not have yet
        is_new = MISSING in values and {*values} <= {MISSING, "null", "false", "[]"}
        is_moved = place in MAY_MOVE and not {MISSING, "null"} & set(values)
        if not (is_moved or is_new or _FREE.fullmatch(place) or values[0] == values[1]):
            yield place, *values
    names = [list(scenario.get("input_parameters", ())) for scenario in (old, new)]
    if names[0] != names[1] and set(names[0]) == set(names[1]):
        first, second = (json.dumps(order, ensure_ascii=False) for order in names)
        yield "$.input_parameters", f"the order {first}", f"{second}"


def versions_in_use(function: str | None = None) -> dict[str, str]:
    """Return `installed_versions`, with the name of the function that was passed, if any."""
    return installed_versions() | ({} if function is None else {"function": function})


def installed_versions() -> dict[str, str]:
    """Return the versions of this package, of Python and of the libraries that do the arithmetic, and the processor."""
    versions = {"hypermap_lite": __version__, "python": platform.python_version()}
    for name in LIBRARIES:
        try:
            versions[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return {**versions, "processor": processor_in_use()}


def _leaves(place: str, value: Any) -> Iterator[tuple[str, str]]:
    """Yield each innermost object entry with its place; a list without objects counts as one value."""
    if isinstance(value, dict) and value:
        for key, inner in value.items():
            yield from _leaves(f"{place}.{key}", inner)
    elif isinstance(value, list) and any(isinstance(item, dict) for item in value):
        for i, inner in enumerate(value):
            yield from _leaves(f"{place}[{i}]", inner)
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
