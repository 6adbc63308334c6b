"""Tests for contacts.py, with the tool placed at chosen heights over the table."""

import mujoco
import numpy as np
import pytest

from robot_tasks.contacts import Clearance, ContactMonitor
from robot_tasks.control import ImpedanceController
from robot_tasks.episode import ContactRecord, ForceRecord
from robot_tasks.errors import SimulationError
from robot_tasks.geometry import Pose
from robot_tasks.simulation import TICK

HIGH = (0.48, 1.52, -0.30, -0.74, 1.46, 1.35, -1.15)


@pytest.fixture
def tool_over_table(simulation):
    """Raise the table until its top is a given distance below the tool's end."""

    def place(height: float):
        simulation.reset()
        simulation.place_arm(HIGH)
        lowest = simulation.site_position("tool_tip")[2] - 0.0225 * np.sin(np.radians(0.12))
        simulation.shift_body("table", (0.0, 0.0, lowest - height - 0.6))
        simulation.place_arm(HIGH)
        return simulation

    return place


def settle(simulation, n_ticks=1):
    """Hold the tool where it is, watched from now on, for some ticks of ten steps."""
    monitor = ContactMonitor(simulation)
    controller, pose = ImpedanceController(simulation), simulation.pose_of("tool_tip")
    for _ in range(n_ticks):
        controller.update(pose, TICK)
        mujoco.mj_step(simulation.model, simulation.data, 10)
        monitor.observe()
    return monitor


def test_a_far_geom_is_not_touched(tool_over_table):
    monitor = settle(tool_over_table(0.01), n_ticks=3)
    assert monitor.touch_record() == ContactRecord()
    assert monitor.tool_record() == ForceRecord()


def test_a_monitor_that_has_seen_no_tick_reports_nothing(simulation):
    monitor = ContactMonitor(simulation)
    monitor.check()
    assert monitor.touch_record() == ContactRecord()
    assert monitor.tool_record() == ForceRecord()


def test_an_overlap_is_a_touch_with_force_and_depth(tool_over_table):
    monitor = settle(tool_over_table(-0.001))
    record = monitor.touch_record()
    assert record.touches == 1
    assert 0.002 <= record.seconds <= 0.02
    assert record.peak_force > 1.0
    assert record.deepest_penetration == pytest.approx(0.001, abs=2e-4)


def test_a_tool_pulled_onto_the_table_presses_with_the_force_of_the_spring(tool_over_table):
    simulation = tool_over_table(0.0)
    controller, (position, quaternion) = ImpedanceController(simulation), simulation.pose_of("tool_tip")
    below = Pose((position[0], position[1], position[2] - 0.02), quaternion)  # 20 mm x 400 N/m = 8 N
    for _ in range(200):
        controller.update(below, TICK)
        mujoco.mj_step(simulation.model, simulation.data, 10)
    monitor = ContactMonitor(simulation)
    monitor.observe()
    assert monitor.tool_record().mean == pytest.approx(8.0, rel=0.02)
    assert monitor.tool_record().impulse == pytest.approx(8.0 * 0.02, rel=0.02)
    assert monitor.tool_record().seconds == pytest.approx(0.02)


def test_contacts_close_in_time_are_one_touch_and_later_ones_another(tool_over_table):
    simulation = tool_over_table(-0.001)
    monitor = ContactMonitor(simulation)
    readings = simulation.sensor_history("touch_table")
    simulation.sensor_history("deepest")[:] = -0.001
    for tick in range(1, 18):
        readings[:, 3] = -0.001 if tick in {1, 4, 8, 17} else 0.001  # the last after 160 ms without contact
        monitor.observe()
    assert monitor.touch_record().touches == 2
    assert monitor.touch_record().seconds == pytest.approx(4 * 0.02)


def test_only_a_present_contact_is_prolonged(tool_over_table):
    simulation = tool_over_table(-0.001)
    touch, force = simulation.sensor_history("touch_table"), simulation.sensor_history("tool_force")
    touch[:, 3], force[:] = -0.001, (0.0, 3.0, 4.0)
    simulation.sensor_history("deepest")[:] = -0.001
    monitor = ContactMonitor(simulation)
    monitor.observe()
    assert monitor.touch_record(held=2.0).seconds == pytest.approx(2.02)
    assert monitor.tool_record(held=2.0).impulse == pytest.approx(5.0 * 2.02)
    assert monitor.tool_record(held=2.0).seconds == pytest.approx(2.02)
    touch[:, 3], force[:] = 0.001, 0.0
    simulation.sensor_history("deepest")[:] = 0.001
    monitor.observe()
    assert monitor.touch_record(held=2.0).seconds == pytest.approx(0.02)
    assert monitor.tool_record(held=2.0).impulse == pytest.approx(5.0 * 0.02)
    assert monitor.tool_record(held=2.0).seconds == pytest.approx(0.02)


def test_records_hold_the_extremes_of_all_steps_and_all_things_touched(tool_over_table):
    simulation = tool_over_table(0.1)
    table, engine = (simulation.sensor_history(f"touch_{name}") for name in ("table", "engine"))
    deepest, force = simulation.sensor_history("deepest"), simulation.sensor_history("tool_force")
    table[:, 3] = engine[:, 3] = 0.001
    table[3], engine[7] = (30.0, 0.0, 0.0, -0.0002), (50.0, 0.0, 0.0, -0.0001)
    deepest[:], force[:] = -0.0002, 0.0
    force[3] = (0.0, 0.0, 30.0)
    monitor = ContactMonitor(simulation)
    simulation.data.time = 0.02
    monitor.observe()
    record = monitor.touch_record()
    assert (record.touches, record.peak_force, record.deepest_penetration) == (1, 50.0, 0.0002)
    assert record.seconds == pytest.approx(2 * 0.002)
    assert monitor.tool_record().peak == 30.0
    assert monitor.tool_record().mean == pytest.approx(30.0)


def test_the_load_is_the_mean_over_the_last_tick_of_the_larger_of_tool_and_touch(tool_over_table):
    simulation = tool_over_table(0.1)
    simulation.sensor_history("deepest")[:] = -0.001
    force, touch = simulation.sensor_history("tool_force"), simulation.sensor_history("touch_table")
    touch[:, 3], force[:] = 0.001, 0.0
    monitor = ContactMonitor(simulation)
    force[:5] = (0.0, 6.0, 8.0)
    monitor.observe()
    assert monitor.load == pytest.approx(5.0)
    touch[:8] = (20.0, 0.0, 0.0, -0.001)
    monitor.observe()
    assert monitor.load == pytest.approx(16.0)
    touch[:, 3], force[:] = 0.001, 0.0
    monitor.observe()
    assert monitor.load == 0.0


@pytest.mark.parametrize("n_ticks_after", [0, 5])
def test_bodies_that_were_inside_each_other_are_an_error(tool_over_table, n_ticks_after):
    simulation = tool_over_table(-0.03)
    monitor = ContactMonitor(simulation)
    mujoco.mj_step(simulation.model, simulation.data, 10)
    monitor.observe()
    for _ in range(n_ticks_after):
        simulation.sensor_history("deepest")[:] = 0.001
        simulation.data.time += TICK
        monitor.observe()
    message = r"simulation at t = 0.0\d\d s: two bodies overlap by \d\d\.\d mm, 10 at most mean anything"
    with pytest.raises(SimulationError, match=message):
        monitor.check()


def test_bodies_that_overlap_little_are_no_error(tool_over_table):
    settle(tool_over_table(-0.001), n_ticks=3).check()


def test_clearance_is_the_distance_of_the_nearest_part(tool_over_table):
    clearance = Clearance(tool_over_table(0.03), "table")
    clearance.observe()
    assert clearance.smallest == pytest.approx(0.03, abs=1e-4)


def test_clearance_stops_looking_at_its_reach(tool_over_table):
    clearance = Clearance(tool_over_table(0.03), "robot_table", reach=0.02)
    clearance.observe()
    assert clearance.smallest == 0.02
