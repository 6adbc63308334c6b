"""Cases of a test that are slow, beside a few that are not."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Final

import pytest

ParameterSet: Final = type(pytest.param())
"""What `pytest.param` returns; pytest 8 has no public name for it."""


def slow_after(n: int, cases: Iterable[Any]) -> list[Any]:
    """Return cases for `pytest.mark.parametrize`, those after the first n marked as slow."""
    return [case if i < n else _slow(case) for i, case in enumerate(cases)]


def slow_unless(is_quick: Callable[..., bool], cases: Iterable[Any]) -> list[Any]:
    """Return cases for `pytest.mark.parametrize`, those marked as slow of whose arguments the function is false."""
    return [case if is_quick(*_arguments(case)) else _slow(case) for case in cases]


def _arguments(case: Any) -> tuple[Any, ...]:
    if isinstance(case, ParameterSet):  # which is a tuple itself
        return tuple(case.values)
    return case if isinstance(case, tuple) else (case,)


def _slow(case: Any) -> Any:
    if isinstance(case, ParameterSet):
        return pytest.param(*case.values, id=case.id, marks=(*case.marks, pytest.mark.slow))
    return pytest.param(*_arguments(case), marks=pytest.mark.slow)
