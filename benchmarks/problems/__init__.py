"""Problems with published formulas and known answers, on which optimizers are compared."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from .base import Problem
from .constrained import CONSTRAINED
from .plateau import PLATEAU
from .several import SEVERAL
from .single import SINGLE

__all__ = ["CONSTRAINED", "PROBLEMS", "SEVERAL", "SINGLE", "SKILLS", "Problem"]

SKILLS: Mapping[str, Problem] = {"plateau": PLATEAU, "plateau_noisy": replace(PLATEAU, noise=0.1)}

PROBLEMS: Mapping[str, Problem] = {**SINGLE, **SEVERAL, **CONSTRAINED, **SKILLS}
