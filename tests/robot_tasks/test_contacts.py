"""Tests for contacts.py, with the tool placed at chosen heights over the table."""

import mujoco
import numpy as np
import pytest

from robot_tasks.contacts import Clearance, ContactMonitor

HIGH = (0.48, 1.52, -0.30, -0.74, 1.46, 1.35, -1.15)


@pytest.fixture
def tool_over_table(simulation):
    """Raise the table until its top is a given distance below the tool's end."""

    def place(height: float):
        simulation.reset()
        simulation.place_arm(HIGH)
        lowest = simulation.site_position("tip")[2] - 0.0225 * np.sin(np.radians(0.12))
        simulation.shift_body("table", (0.0, 0.0, lowest - height - 0.6))
        simulation.place_arm(HIGH)
        return simulation

    return place


def test_a_far_geom_is_not_near(tool_over_table):
    assert not ContactMonitor(tool_over_table(0.05), ["table"]).is_near()


def test_a_geom_within_the_gap_is_near_but_not_touched(tool_over_table):
    monitor = ContactMonitor(tool_over_table(0.01), ["table"])
    assert monitor.is_near()
    monitor.observe()
    assert monitor.record().touches == 0


def test_an_overlap_is_a_touch_with_force_and_depth(tool_over_table):
    monitor = ContactMonitor(tool_over_table(-0.001), ["table"])
    monitor.observe()
    record = monitor.record()
    assert record.touches == 1
    assert record.seconds == 0.002
    assert record.peak_force > 1.0
    assert record.deepest_penetration == pytest.approx(0.001, abs=2e-4)


def test_a_geom_that_may_be_touched_does_not_count(tool_over_table):
    monitor = ContactMonitor(tool_over_table(-0.001), ["engine"])
    monitor.observe()
    assert monitor.record().touches == 0


def test_contacts_close_in_time_are_one_touch_and_later_ones_another(tool_over_table):
    simulation = tool_over_table(-0.001)
    monitor = ContactMonitor(simulation, ["table"])
    for time in (0.0, 0.05, 0.14, 0.3):
        simulation.data.time = time
        monitor.observe()
    assert monitor.record().touches == 2
    assert monitor.record().seconds == pytest.approx(4 * 0.002)


def test_only_a_present_contact_is_prolonged(tool_over_table):
    simulation = tool_over_table(-0.001)
    monitor = ContactMonitor(simulation, ["table"])
    monitor.observe()
    assert monitor.record(held=2.0).seconds == pytest.approx(2.002)
    simulation.shift_body("table", (0.0, 0.0, 0.0))
    mujoco.mj_forward(simulation.model, simulation.data)
    monitor.observe()
    assert monitor.record(held=2.0).seconds == pytest.approx(0.002)


def test_clearance_is_the_distance_of_the_nearest_part(tool_over_table):
    clearance = Clearance(tool_over_table(0.03), "table")
    clearance.observe()
    assert clearance.smallest == pytest.approx(0.03, abs=1e-4)


def test_clearance_stops_looking_at_its_reach(tool_over_table):
    clearance = Clearance(tool_over_table(0.03), "robot_table", reach=0.02)
    clearance.observe()
    assert clearance.smallest == 0.02
