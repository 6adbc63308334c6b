"""Placeholders in the arguments of a command: ``{Force}``, ``{seed}``, ``{params_file}``."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable, Iterator, Mapping

BUILT_IN = ("params_json", "params_file", "result_file", "seed", "trial", "replicate", "trial_dir", "python")
"""Placeholders every command may use; the rest are the names of its parameters."""

_PATTERN = re.compile(r"\{\{(?P<literal>[^{}\s]*)\}\}|(?<!\$)\{(?P<name>[^{}\s\"':;,$]+)\}")
"""``{name}``, or ``{{name}}`` for the text ``{name}``; other braces (JSON, ``${VARIABLE}``, awk) are left alone."""


def placeholders_in(text: str) -> Iterator[str]:
    """Yield the names of the placeholders in one argument."""
    for match in _PATTERN.finditer(text):
        if match["name"] is not None:
            yield match["name"]


def fill(text: str, values: Mapping[str, str], *, quote: bool = False) -> str:
    """Return an argument with its placeholders replaced, each value quoted for a shell on demand.

    Raises
    ------
    KeyError
        If a placeholder has no value.
    """

    def replacement(match: re.Match[str]) -> str:
        if match["name"] is None:
            return "{" + match["literal"] + "}"
        value = values[match["name"]]
        return shlex.quote(value) if quote else value

    return _PATTERN.sub(replacement, text)


def unknown_placeholders(arguments: Iterable[str], parameters: Iterable[str]) -> Iterator[tuple[int, str]]:
    """Yield position and name of each placeholder that is neither built in nor a parameter."""
    known = {*BUILT_IN, *parameters}
    for position, argument in enumerate(arguments):
        for name in placeholders_in(argument):
            if name not in known:
                yield position, name
