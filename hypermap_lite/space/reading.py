"""Reading the text of a constraint: what of Python's expressions is allowed becomes functions, the rest an error.

Nothing is executed. Python's own parser makes the tree, of which only the nodes named here are accepted.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from hypermap_lite.errors import nearest
from hypermap_lite.space.expressions import (
    FUNCTIONS,
    OPERATORS,
    Condition,
    Number,
    Text,
    all_of,
    any_of,
    applied,
    compared,
    constant,
    element_at,
    negated,
    place_of,
    texts_equal,
    variable,
)
from hypermap_lite.space.listed import ListedParameter
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.space.permutation import PermutationParameter
from hypermap_lite.space.source_text import ALLOWED, MAX_DEPTH, SHOWN, SourceText, is_plain

_SYMBOLS: Final[dict[type, str]] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.FloorDiv: "//",
    ast.Mod: "%",
    ast.Pow: "**",
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}


@dataclass(frozen=True, slots=True)
class Term:
    """Part of an expression, of which exactly one attribute is set."""

    number: Number | None = None
    text: Text | None = None
    condition: Condition | None = None
    levels: tuple[str, ...] = ()
    """All values of a text that is a parameter."""

    literal: str = ""
    """The value of a text that is written out."""

    @property
    def kind(self) -> str:
        """Say in words what it is."""
        return "a condition" if self.condition else "a text" if self.text else "a number"


class ExpressionReader:
    """Reads one expression over some parameters."""

    def __init__(self, text: str, parameters: Sequence[Parameter]) -> None:
        self._parameters = {p.name: p for p in parameters}
        self._source = SourceText(text, list(self._parameters))
        self.names: set[str] = set()
        """Parameters it speaks of; complete once it has been read."""

    def condition(self) -> Condition:
        """Return the condition that the whole text is.

        Raises
        ------
        ScenarioError
            If it is anything else.
        """
        node = self._source.parse()
        term = self._term(node, 0)
        if term.condition is None:
            raise self._source.error(node, f"it is {term.kind}, not a condition", "a comparison, such as x1 + x2 <= 3")
        if not self.names:
            raise self._source.error(node, "it speaks of no parameter", f"conditions on {self._known()}")
        return term.condition

    def _term(self, node: ast.AST, depth: int) -> Term:
        if depth > MAX_DEPTH:
            raise self._source.error(node, "the terms are nested too deeply", f"at most {MAX_DEPTH} terms within terms")
        match node:
            case ast.Constant(value=value):
                return self._literal(node, value)
            case ast.Name():
                return self._parameter(node, self._source.name_at(node))
            case ast.BinOp(op=ast.BitAnd() | ast.BitOr()):
                sides = [self._as_condition(side, depth, "&|") for side in (node.left, node.right)]
                return Term(condition=(all_of if isinstance(node.op, ast.BitAnd) else any_of)(sides))
            case ast.BinOp(op=op) if type(op) in _SYMBOLS:
                numbers = [self._as_number(side, depth) for side in (node.left, node.right)]
                return Term(number=applied(OPERATORS[_SYMBOLS[type(op)]], numbers))
            case ast.BoolOp(op=op, values=values):
                conditions = [self._as_condition(value, depth) for value in values]
                return Term(condition=(all_of if isinstance(op, ast.And) else any_of)(conditions))
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return Term(condition=negated(self._as_condition(operand, depth)))
            case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=operand):
                number = self._as_number(operand, depth)
                return Term(number=applied(np.negative, [number]) if isinstance(node.op, ast.USub) else number)
            case ast.Compare():
                return self._comparison(node, depth)
            case ast.Subscript(value=ast.Name() as inner, slice=index):
                return Term(number=element_at(*self._order_and_number(node, inner, index)))
            case ast.Call(func=ast.Name(id="position"), args=[ast.Name() as inner, index], keywords=[]):
                return Term(number=place_of(*self._order_and_number(node, inner, index)))
            case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
                return self._call(node, name, arguments, depth)
        hint = "Powers are written **." if isinstance(node, ast.BinOp) and isinstance(node.op, ast.BitXor) else ""
        raise self._source.error(node, f"{self._source.excerpt(node)} is not allowed here", ALLOWED, hint)

    def _literal(self, node: ast.AST, value: object) -> Term:
        if isinstance(value, str):
            shown = np.array(value, dtype=object)
            return Term(text=lambda columns: shown, literal=value)
        if isinstance(value, int | float) and not isinstance(value, bool):
            try:
                number = float(value)
            except OverflowError:
                number = math.inf
            if math.isfinite(number):
                return Term(number=constant(number))
        raise self._source.error(
            node, f"{self._source.excerpt(node)} is no number to count with", "finite numbers, and texts"
        )

    def _parameter(self, node: ast.AST, name: str) -> Term:
        parameter = self._parameters.get(name)
        if parameter is None:
            hint = self._source.quoting_hint() or nearest(name, self._parameters)
            if name in FUNCTIONS:
                hint = f"'{name}' is a function: {name}(...)."
            raise self._source.error(node, f"there is no parameter '{name[:SHOWN]}'", self._known(), hint)
        if isinstance(parameter, PermutationParameter):
            allowed = f"{name}[0], the element that comes first, and position({name}, 0), the place of element 0"
            raise self._source.error(node, f"'{name}' is a permutation, not a number", allowed)
        self.names.add(name)
        levels = parameter.levels if isinstance(parameter, ListedParameter) else ()
        if levels and all(isinstance(level, str) for level in levels):
            return Term(text=lambda columns: columns[name], levels=tuple(map(str, levels)))
        return Term(number=variable(name))

    def _order_and_number(self, node: ast.AST, inner: ast.Name, index: ast.expr) -> tuple[str, int]:
        """Return the name of a permutation and the place or element that is asked for."""
        name = self._source.name_at(inner)
        parameter = self._parameters.get(name)
        if not isinstance(parameter, PermutationParameter):
            raise self._source.error(node, f"{self._source.excerpt(inner)} is no permutation", ALLOWED)
        number = index.value if isinstance(index, ast.Constant) else None
        if type(number) is not int or number >= parameter.size:
            problem = f"{self._source.excerpt(index)} is no place and no element of '{name}'"
            raise self._source.error(index, problem, f"0 to {parameter.size - 1}")
        self.names.add(name)
        return name, number

    def _call(self, node: ast.AST, name: str, arguments: Sequence[ast.expr], depth: int) -> Term:
        function = FUNCTIONS.get(name)
        if function is None:
            raise self._source.error(
                node, f"there is no function '{name[:SHOWN]}'", ", ".join(FUNCTIONS), nearest(name, FUNCTIONS)
            )
        if len(arguments) < function.least or (function.most is not None and len(arguments) > function.most):
            problem = f"'{name}' is given {len(arguments)} argument{'s' * (len(arguments) != 1)}"
            raise self._source.error(node, problem, function.arguments())
        return Term(number=applied(function.apply, [self._as_number(argument, depth) for argument in arguments]))

    def _comparison(self, node: ast.Compare, depth: int) -> Term:
        operands: list[ast.expr] = [node.left, *node.comparators]
        pairs = zip(operands, node.ops, operands[1:], strict=False)
        return Term(condition=all_of([self._pair(*pair, depth) for pair in pairs]))

    def _pair(self, left: ast.expr, op: ast.cmpop, right: ast.expr, depth: int) -> Condition:
        if isinstance(op, ast.In | ast.NotIn):
            if not isinstance(right, ast.List | ast.Tuple | ast.Set) or not right.elts:
                raise self._source.error(right, f"{self._source.excerpt(right)} is no list of values", "in [1, 2, 4]")
            found = any_of([self._equal(left, "==", item, depth) for item in right.elts])
            return negated(found) if isinstance(op, ast.NotIn) else found
        if type(op) not in _SYMBOLS:
            raise self._source.error(left, "'is' compares no values", ALLOWED, "Write '=='.")
        return self._equal(left, _SYMBOLS[type(op)], right, depth)

    def _equal(self, left: ast.expr, symbol: str, right: ast.expr, depth: int) -> Condition:
        a, b = self._term(left, depth + 1), self._term(right, depth + 1)
        if a.number is not None and b.number is not None:
            return compared(symbol, a.number, b.number)
        if a.text is None or b.text is None or symbol not in ("==", "!="):
            problem = f"{a.kind} and {b.kind} are compared by {symbol}"
            raise self._source.error(left, problem, "numbers by < <= > >= == !=, texts by == != in")
        for node, one, other in ((left, a, b), (right, b, a)):
            if one.literal and other.levels and one.literal not in other.levels:
                hint = nearest(one.literal, other.levels)
                raise self._source.error(node, f"no value is {one.literal!r}", ", ".join(map(repr, other.levels)), hint)
        equal = texts_equal(a.text, b.text)
        return equal if symbol == "==" else negated(equal)

    def _as_number(self, node: ast.expr, depth: int) -> Number:
        term = self._term(node, depth + 1)
        if term.number is None:
            raise self._source.error(node, f"{self._source.excerpt(node)} is {term.kind}", "a number")
        return term.number

    def _as_condition(self, node: ast.expr, depth: int, symbol: str = "") -> Condition:
        term = self._term(node, depth + 1)
        if term.condition is None:
            hint = "& and | bind more tightly than comparisons: write 'and' and 'or'." if symbol else ""
            raise self._source.error(
                node, f"{self._source.excerpt(node)} is {term.kind}", "a condition, such as x1 <= 3", hint
            )
        return term.condition

    def _known(self) -> str:
        return ", ".join(name if is_plain(name) else f"`{name}`" for name in self._parameters)
