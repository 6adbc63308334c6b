"""How far a study is, what went wrong in it, and how whoever watches it gets word."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field

from hypermap_lite.study.specification import Run


@dataclass(frozen=True, slots=True, kw_only=True)
class Failure:
    """A run that did not come to its end."""

    run: Run
    exit_status: int
    """As in the command line's help."""

    message: str
    """What it said last."""

    @property
    def headline(self) -> str:
        """The line of the message that says most: the first, or the last of a traceback."""
        lines = self.message.splitlines()
        return lines[-1] if lines[0].startswith("Traceback") else lines[0]


class StudyObserver:
    """Gets word of a study's steps; this one ignores them. Override what is of interest."""

    def on_start(self, progress: Progress) -> None:
        """Begin, or go on."""

    def on_progress(self, progress: Progress) -> None:
        """Take note of an evaluation that was finished in some run."""

    def on_run_start(self, run: Run) -> None:
        """Take note of a run that begins or goes on."""

    def on_run_end(self, run: Run, progress: Progress, failure: Failure | None) -> None:
        """Take note of a run that ended."""


@dataclass(slots=True)
class Progress:
    """How far a study is, and how long the rest will take."""

    total_runs: int
    total: dict[str, int]
    """Evaluations by variant."""

    n_workers: int
    done_runs: int = 0
    done: dict[Run, int] = field(default_factory=dict)
    """Evaluations of each run that has any."""

    running: list[Run] = field(default_factory=list)
    failed: list[Run] = field(default_factory=list)
    """Runs that gave up in this session."""

    _seconds: defaultdict[str, float] = field(init=False, default_factory=lambda: defaultdict(float))
    """Time spent on runs of each variant in this session [s]."""

    _made: Counter[str] = field(init=False, default_factory=Counter)
    """Evaluations made in that time."""

    @property
    def runs_left(self) -> int:
        """Runs that are under way or have yet to begin."""
        return self.total_runs - self.done_runs - len(self.failed)

    @property
    def done_evaluations(self) -> int:
        """Evaluations that are finished."""
        return sum(self.done.values())

    @property
    def total_evaluations(self) -> int:
        """Evaluations of the whole study."""
        return sum(self.total.values())

    @property
    def seconds_left(self) -> float | None:
        """Estimated time to the end [s]; None before the first evaluation of this session.

        Each variant is taken to go on as fast as it went; one that has not begun, as fast as the others on average.
        Runs that failed are not waited for.
        """
        n_made = sum(self._made.values())
        if not n_made:
            return None
        average = sum(self._seconds.values()) / n_made
        left = Counter(self.total)
        for run, n_done in self.done.items():
            left[run.variant.name] -= n_done
        for run in self.failed:
            left[run.variant.name] -= run.variant.n_evaluations - self.done.get(run, 0)
        n_parallel = max(min(self.n_workers, self.runs_left), 1)
        per_variant = {v: self._seconds[v] / self._made[v] if self._made[v] else average for v in left}
        return sum(max(n, 0) * per_variant[v] for v, n in left.items()) / n_parallel

    def advance(self, run: Run, n_done: int, seconds: float) -> None:
        """Note how many evaluations a run has now, and the time since it last said so [s]."""
        self._made[run.variant.name] += max(n_done - self.done.get(run, 0), 0)  # failures set aside are no progress
        self._seconds[run.variant.name] += seconds
        self.done[run] = n_done
