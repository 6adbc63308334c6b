"""Hypothesis strategies: parameters, spaces and points."""

from __future__ import annotations

from hypothesis import strategies as st

from hypermap_lite.space import (
    CategoricalParameter,
    IntegerParameter,
    OrdinalParameter,
    Parameter,
    RealParameter,
    SearchSpace,
)

finite = st.floats(-1e6, 1e6, allow_nan=False, allow_subnormal=False)


@st.composite
def reals(draw: st.DrawFn, name: str = "x") -> Parameter:
    log = draw(st.booleans())
    low = draw(st.floats(1e-6, 1e3) if log else finite)
    width = draw(st.floats(1e-3, 1e6))
    return RealParameter(name=name, low=low, high=low + max(width, abs(low) * 1e-6), log=log)


@st.composite
def integers(draw: st.DrawFn, name: str = "x") -> Parameter:
    log = draw(st.booleans())
    low = draw(st.integers(1 if log else -1000, 1000))
    width = draw(st.one_of(st.integers(1, 5000), st.integers(5000, 10**12)))
    return IntegerParameter(name=name, low=low, high=low + width, log=log)


@st.composite
def ordinals(draw: st.DrawFn, name: str = "x") -> Parameter:
    return OrdinalParameter(name=name, values=tuple(draw(st.lists(finite, min_size=2, max_size=9, unique=True))))


@st.composite
def categoricals(draw: st.DrawFn, name: str = "x") -> Parameter:
    return CategoricalParameter(name=name, values=tuple(draw(st.lists(st.text(), min_size=2, max_size=9, unique=True))))


def parameters(name: str = "x") -> st.SearchStrategy[Parameter]:
    return st.one_of(reals(name), integers(name), ordinals(name), categoricals(name))


@st.composite
def spaces(draw: st.DrawFn, max_dimension: int = 5) -> SearchSpace:
    n = draw(st.integers(1, max_dimension))
    return SearchSpace(tuple(draw(parameters(f"x{i}")) for i in range(n)))
