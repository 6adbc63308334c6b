"""Problems with known answers, most with published formulas, on which optimizers are compared."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from .base import Problem
from .constrained import CONSTRAINED
from .emulated import EMULATED
from .failing import FAILING
from .limits import LIMITS
from .many import MANY
from .mixed import MIXED
from .modes import MODES
from .plateau import PLATEAU
from .rough import ROUGH
from .several import SEVERAL
from .single import SINGLE
from .tails import TAILS

__all__ = [
    *("CONSTRAINED", "EMULATED", "FAILING", "LIMITS", "MANY", "MIXED", "MODES", "PROBLEMS", "ROUGH", "SEVERAL"),
    *("SINGLE", "SKILLS", "TAILS", "Problem"),
]

SKILLS: Mapping[str, Problem] = {"plateau": PLATEAU, "plateau_noisy": replace(PLATEAU, noise=0.1), **EMULATED}

PROBLEMS: Mapping[str, Problem] = {
    **SINGLE,
    **SEVERAL,
    **CONSTRAINED,
    **LIMITS,
    **SKILLS,
    **MODES,
    **ROUGH,
    **TAILS,
    **FAILING,
    **MANY,
    **MIXED,
}
