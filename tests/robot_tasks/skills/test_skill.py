"""Tests for skill.py: conditions around a scripted tree."""

import pytest

from robot_tasks.skills.skill import Skill, SkillDescription
from tests.robot_tasks.skills.scripted import FAILURE, RUNNING, SUCCESS, Scripted, context


class Answer:
    """A relation that answers from a script, the last answer for ever."""

    def __init__(self, name, *answers):
        self.name, self.answers = name, list(answers)

    def holds(self, world):
        return self.answers.pop(0) if len(self.answers) > 1 else self.answers[0]

    def __str__(self):
        return self.name


def make(body, **conditions):
    description = SkillDescription(name="lift", description="Lift.", parameters=(), **conditions)
    return Skill(description, body)


def test_without_conditions_a_skill_answers_what_its_tree_answers():
    skill = make(Scripted(RUNNING, SUCCESS))
    assert [skill.tick(context()) for _ in range(2)] == [RUNNING, SUCCESS]
    assert skill.label == "Skill lift"


@pytest.mark.parametrize("kind", ["preconditions", "holdconditions"])
def test_a_condition_that_does_not_hold_at_the_start_keeps_the_tree_from_starting(kind):
    body = Scripted(RUNNING)
    skill = make(body, **{kind: (Answer("yes", True), Answer("no", False))})
    assert skill.tick(context()) is FAILURE
    assert body.diary == []
    assert str(skill.violated) == "no"


def test_preconditions_are_asked_only_at_the_start():
    skill = make(Scripted(RUNNING), preconditions=(Answer("empty hand", True, False),))
    assert [skill.tick(context()) for _ in range(3)] == [RUNNING] * 3


def test_a_hold_condition_that_breaks_halts_the_tree():
    body = Scripted(RUNNING)
    skill = make(body, holdconditions=(Answer("in hand", True, True, False),))
    assert [skill.tick(context()) for _ in range(3)] == [RUNNING, RUNNING, FAILURE]
    assert body.diary == ["start", "update", "update", "idle"]


@pytest.mark.parametrize(("answer", "status"), [(True, SUCCESS), (False, FAILURE)])
def test_a_success_counts_only_with_its_postconditions(answer, status):
    assert make(Scripted(SUCCESS), postconditions=(Answer("lifted", answer),)).tick(context()) is status


def test_postconditions_are_not_asked_of_a_running_or_failed_tree():
    skill = make(Scripted(RUNNING, FAILURE), postconditions=(Answer("lifted", False),))
    assert [skill.tick(context()) for _ in range(2)] == [RUNNING, FAILURE]
    assert skill.violated is None


def test_a_skill_that_is_started_again_asks_its_preconditions_again():
    skill = make(Scripted(SUCCESS), preconditions=(Answer("empty hand", True, False),))
    assert [skill.tick(context()) for _ in range(2)] == [SUCCESS, FAILURE]


def test_the_tree_is_the_only_child():
    body = Scripted(RUNNING)
    assert make(body).children == (body,)
