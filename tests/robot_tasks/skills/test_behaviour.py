"""Tests for behaviour.py."""

from robot_tasks.skills import Condition
from tests.robot_tasks.skills.scripted import FAILURE, IDLE, RUNNING, SUCCESS, Scripted, context, ticks


def test_a_behaviour_starts_runs_and_ends_once():
    behaviour = Scripted(RUNNING, RUNNING, SUCCESS)
    assert ticks(behaviour, 3) == [RUNNING, RUNNING, SUCCESS]
    assert behaviour.diary == ["start", "update", "update", "update", "success"]


def test_a_finished_behaviour_starts_again_when_ticked():
    behaviour = Scripted(FAILURE, RUNNING)
    ticks(behaviour, 2)
    assert behaviour.diary == ["start", "update", "failure", "start", "update"]


def test_halting_ends_a_running_behaviour_as_idle():
    behaviour = Scripted(RUNNING)
    behaviour.tick(context())
    behaviour.halt(context())
    assert behaviour.status is IDLE
    assert behaviour.diary == ["start", "update", "idle"]


def test_halting_leaves_a_behaviour_that_is_not_running_alone():
    fresh, finished = Scripted(RUNNING), Scripted(SUCCESS)
    finished.tick(context())
    fresh.halt(context())
    finished.halt(context())
    assert fresh.diary == []
    assert finished.status is SUCCESS


def test_a_condition_answers_without_a_life_cycle():
    class Asked(Condition):
        def _initialise(self, context):
            raise AssertionError

        _terminate = _initialise

        def _update(self, context):
            return SUCCESS

    condition = Asked()
    assert condition.tick(context()) is SUCCESS
    condition.halt(context())
    assert condition.status is SUCCESS
