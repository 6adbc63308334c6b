"""Problems of which one evaluation in twenty fails for no reason of its parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from .base import Problem
from .emulated import EMULATED
from .several import SEVERAL
from .single import SINGLE

FAILURES = 0.05

FAILING: Mapping[str, Problem] = {
    name.removesuffix("_emulated") + "_failing": replace(problem, failures=FAILURES)
    for name, problem in {
        "hartmann6": SINGLE["hartmann6"],
        "branin_currin": SEVERAL["branin_currin"],
        "dtlz2": SEVERAL["dtlz2"],
        **EMULATED,
    }.items()
}
