"""Tests for composites.py: who is ticked, who is halted, who decides."""

import pytest

from robot_tasks.skills import NoFail, ParallelFf, ParallelFs, Selector, SelectorStar, Serial, SerialStar
from tests.robot_tasks.skills.scripted import FAILURE, IDLE, RUNNING, SUCCESS, Scripted, context, ticks

ALL = [Serial, SerialStar, Selector, SelectorStar, ParallelFs, ParallelFf]


@pytest.mark.parametrize("kind", ALL)
@pytest.mark.parametrize("status", [SUCCESS, FAILURE, RUNNING])
def test_a_single_child_decides(kind, status):
    assert kind(Scripted(status)).tick(context()) is status


@pytest.mark.parametrize("kind", ALL)
def test_a_composite_needs_a_child(kind):
    with pytest.raises(ValueError, match=f"{kind.__name__} needs at least one child"):
        kind()


@pytest.mark.parametrize("kind", ALL)
def test_halting_a_composite_halts_its_running_child(kind):
    child = Scripted(RUNNING)
    composite = kind(child)
    composite.tick(context())
    composite.halt(context())
    assert child.diary[-1] == "idle"


def test_serial_ticks_finished_children_again():
    first, second = Scripted(SUCCESS), Scripted(RUNNING)
    assert ticks(Serial(first, second), 3) == [RUNNING] * 3
    assert first.n_updates == 3


def test_serial_preempts_a_later_child_when_an_earlier_one_stops_succeeding():
    first, second = Scripted(SUCCESS, RUNNING), Scripted(RUNNING)
    assert ticks(Serial(first, second), 2) == [RUNNING, RUNNING]
    assert second.status is IDLE


def test_serial_fails_with_the_first_failure_and_does_not_tick_on():
    first, second = Scripted(FAILURE), Scripted(SUCCESS)
    assert ticks(Serial(first, second), 1) == [FAILURE]
    assert second.n_updates == 0


def test_serial_star_remembers_finished_children():
    first, second = Scripted(SUCCESS), Scripted(RUNNING, SUCCESS)
    assert ticks(SerialStar(first, second), 2) == [RUNNING, SUCCESS]
    assert first.n_updates == 1


def test_serial_star_starts_over_after_it_ended():
    first, second = Scripted(SUCCESS), Scripted(FAILURE, SUCCESS)
    assert ticks(SerialStar(first, second), 2) == [FAILURE, SUCCESS]
    assert first.n_updates == 2


def test_serial_star_forgets_when_preempted():
    first, second = Scripted(SUCCESS), Scripted(RUNNING)
    sequence = SerialStar(first, second)
    sequence.tick(context())
    sequence.halt(context())
    sequence.tick(context())
    assert first.n_updates == 2


def test_selector_takes_the_first_child_that_does_not_fail():
    first, second, third = Scripted(FAILURE), Scripted(RUNNING), Scripted(SUCCESS)
    assert ticks(Selector(first, second, third), 1) == [RUNNING]
    assert third.n_updates == 0


def test_selector_preempts_a_later_child_when_an_earlier_one_wants_to_run():
    first, second = Scripted(FAILURE, RUNNING), Scripted(RUNNING)
    assert ticks(Selector(first, second), 2) == [RUNNING, RUNNING]
    assert second.status is IDLE


def test_selector_fails_when_all_children_fail():
    assert ticks(Selector(Scripted(FAILURE), Scripted(FAILURE)), 1) == [FAILURE]


def test_selector_star_does_not_ask_failed_children_again():
    first, second = Scripted(FAILURE), Scripted(RUNNING, SUCCESS)
    assert ticks(SelectorStar(first, second), 2) == [RUNNING, SUCCESS]
    assert first.n_updates == 1


def test_selector_star_fails_when_all_children_have_failed():
    assert ticks(SelectorStar(Scripted(FAILURE), Scripted(RUNNING, FAILURE)), 2) == [RUNNING, FAILURE]


@pytest.mark.parametrize("status", [SUCCESS, FAILURE])
def test_parallel_fs_follows_the_first_child_to_finish_and_halts_the_rest(status):
    first, second, third = Scripted(RUNNING), Scripted(RUNNING, status), Scripted(RUNNING)
    assert ticks(ParallelFs(first, second, third), 2) == [RUNNING, status]
    assert first.status is IDLE
    assert third.status is IDLE
    assert third.n_updates == 1


def test_parallel_ff_waits_for_all_and_ticks_each_to_its_success_once():
    first, second = Scripted(SUCCESS), Scripted(RUNNING, RUNNING, SUCCESS)
    assert ticks(ParallelFf(first, second), 3) == [RUNNING, RUNNING, SUCCESS]
    assert first.n_updates == 1


def test_parallel_ff_stops_all_at_the_first_failure():
    first, second = Scripted(RUNNING), Scripted(RUNNING, FAILURE)
    assert ticks(ParallelFf(first, second), 2) == [RUNNING, FAILURE]
    assert first.status is IDLE


@pytest.mark.parametrize(("status", "answer"), [(FAILURE, SUCCESS), (SUCCESS, SUCCESS), (RUNNING, RUNNING)])
def test_no_fail_turns_failure_into_success(status, answer):
    assert NoFail(Scripted(status)).tick(context()) is answer
