"""The text of an expression: Python's parser makes the tree, and messages name the place in the text."""

from __future__ import annotations

import ast
import keyword
import re
import warnings
from collections.abc import Sequence
from typing import Final

from hypermap_lite.errors import ScenarioError
from hypermap_lite.space.expressions import FUNCTIONS

MAX_LENGTH: Final = 2000
"""Characters of an expression."""

MAX_DEPTH: Final = 60
"""Terms within terms."""

SHOWN: Final = 60
"""Characters of an expression that a message shows."""

ALLOWED: Final = "comparisons of numbers (< <= > >= == !=), and, or, not, + - * / // % **, " + ", ".join(FUNCTIONS)

_QUOTED: Final = re.compile(r"'[^']*'|\"[^\"]*\"|`([^`]*)`")
"""Texts, which are left alone, and names in backticks."""

_BLANKS: Final = str.maketrans("\n\r\t\f\v", "     ")


class SourceText:
    """One expression over parameters of some names, as text and as a tree."""

    def __init__(self, text: str, names: Sequence[str]) -> None:
        self._text = text.translate(_BLANKS).strip()
        self._names = names
        self._quoted: dict[int, str] = {}

    def parse(self) -> ast.expr:
        """Return the tree of the text, whatever stands in it; nothing is executed.

        Raises
        ------
        ScenarioError
            If it is no expression of Python's, or too long.
        """
        if not self._text or len(self._text) > MAX_LENGTH:
            problem = f"the expression has {len(self._text)} characters"
            raise ScenarioError("$", problem, allowed=f"1 to {MAX_LENGTH} characters")
        source = _QUOTED.sub(self._hide, self._text)
        comment = _QUOTED.sub(lambda match: " " * len(match[0]), self._text).find("#")
        if comment >= 0:
            raise self._error_at(comment + 1, "an expression has no comments", ALLOWED, "Use the description.")
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                return ast.parse(source, mode="eval").body
        except SyntaxError as error:
            raise self._broken(error) from None
        except (ValueError, RecursionError, MemoryError):
            problem = "the expression is nested too deeply, or holds characters that no expression has"
            raise ScenarioError("$", problem, allowed=f"at most {MAX_DEPTH} terms within terms") from None

    def name_at(self, node: ast.Name) -> str:
        """Return the name that stands at a place, in backticks or not."""
        return self._quoted.get(node.col_offset, node.id)

    def _hide(self, match: re.Match[str]) -> str:
        """Put a name of the same length in the place of one in backticks, and remember what stands there."""
        if match[1] is None:
            return match[0]
        self._quoted[len(self._text[: match.start()].encode())] = match[1]
        return "_" * len(match[0].encode())

    def _broken(self, error: SyntaxError) -> ScenarioError:
        hint = self.quoting_hint()
        for wrong, right in (("&&", "and"), ("||", "or"), ("!", "not"), ("=", "==")):
            if not hint and re.search(rf"(?<![=<>!&|]){re.escape(wrong)}(?![=&|])", self._text):
                hint = f"Write '{right}' instead of '{wrong}'."
        column = min(max(error.offset or 1, 1), len(self._text))
        return self._error_at(column, "this is no expression", ALLOWED, hint)

    def quoting_hint(self) -> str:
        """Tell how a parameter's name that is no word of Python's is written, if one stands in the text."""
        for name in self._names:
            if not is_plain(name) and re.search(rf"(?<![\w`-]){re.escape(name)}(?![\w`-])", self._text):
                return f"Write `{name}` in backticks."
        return ""

    def excerpt(self, node: ast.AST) -> str:
        """Return the text of a node in quotes, cut to a length that fits a message."""
        start, end = (getattr(node, f"{which}col_offset") for which in ("", "end_"))
        text = self._text.encode()[start:end].decode(errors="replace")
        return f"'{text if len(text) <= SHOWN else text[: SHOWN - 4] + ' ...'}'"

    def error(self, node: ast.AST, problem: str, allowed: str, hint: str = "") -> ScenarioError:
        """Return an error at a node: its column, what is wrong, what is allowed."""
        offset: int = getattr(node, "col_offset", 0)
        return self._error_at(len(self._text.encode()[:offset].decode(errors="replace")) + 1, problem, allowed, hint)

    def _error_at(self, column: int, problem: str, allowed: str, hint: str) -> ScenarioError:
        start = max(column - SHOWN // 2, 1) if len(self._text) > SHOWN else 1
        shown = self._text[start - 1 :][:SHOWN]
        cut = "... " * (start > 1), " ..." * (start - 1 + SHOWN < len(self._text))
        return ScenarioError(
            "$", f"column {column} of '{cut[0]}{shown}{cut[1]}': {problem}", allowed=allowed, hint=hint
        )


def is_plain(name: str) -> bool:
    """Tell whether a parameter's name can be written without backticks."""
    return name.isidentifier() and not keyword.iskeyword(name)
