"""Behaviour trees and skills as text, for a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from robot_tasks.skills.behaviour import Behaviour
from robot_tasks.skills.conditions import Relation
from robot_tasks.skills.skill import Skill, SkillDescription


def draw(behaviour: Behaviour) -> str:
    """Draw a behaviour tree, one line per node; children are ticked from top to bottom.

    Examples
    --------
    >>> from robot_tasks.skills import CoordinateBelow, NoFail, Selector
    >>> print(draw(Selector(CoordinateBelow("y", 0.05), NoFail(CoordinateBelow("z", 0.9)))))
    Selector
    ├─ CoordinateBelow y, 0.05 m
    └─ NoFail
       └─ CoordinateBelow z, 0.9 m
    """
    return "\n".join([behaviour.label, *_branches(behaviour)])


def describe(description: SkillDescription) -> list[str]:
    """Return the lines that tell what a skill is told, needs, keeps and brings about."""
    lines = [f"{description.name}: {description.description}"]
    lines += _block("parameters", _parameters(description))
    lines += _block("pre-conditions, at the start", _conditions(description.preconditions))
    lines += _block("hold-conditions, at every tick", _conditions(description.holdconditions))
    lines += _block("post-conditions, on success", _conditions(description.postconditions))
    return lines


def skills_in(behaviour: Behaviour) -> Iterator[Skill]:
    """Yield every skill of a tree, from the root downwards."""
    if isinstance(behaviour, Skill):
        yield behaviour
    for child in behaviour.children:
        yield from skills_in(child)


def _branches(behaviour: Behaviour) -> Iterator[str]:
    """Yield the lines below a node."""
    for position, child in enumerate(behaviour.children, start=1):
        joint, rest = ("└─ ", "   ") if position == len(behaviour.children) else ("├─ ", "│  ")
        yield joint + child.label
        yield from (rest + line for line in _branches(child))


def _parameters(description: SkillDescription) -> list[str]:
    """Return name, type, unit, kind and meaning of each parameter, in columns."""
    rows = [(p.name, p.value_type.__name__, p.unit, p.kind.value, p.description) for p in description.parameters]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)][:4]
    return ["  ".join(f"{cell:<{width}}" for cell, width in zip(row, [*widths, 0], strict=True)) for row in rows]


def _conditions(relations: Sequence[Relation]) -> list[str]:
    return [str(relation) for relation in relations]


def _block(title: str, lines: Sequence[str]) -> list[str]:
    """Indent lines under a title; nothing if there are none."""
    return [f"  {title}", *(f"    {line}" for line in lines)] if lines else []
