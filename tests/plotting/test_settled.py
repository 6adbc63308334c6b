"""Tests for settled.py."""

import csv

import numpy as np
import pytest

from hypermap_lite.evaluation.aggregation import mean, standard_error
from hypermap_lite.pareto import hypervolume_trace
from hypermap_lite.plotting.hypervolume import plot_hypervolume
from hypermap_lite.plotting.pareto import plot_pareto
from hypermap_lite.plotting.runs import load_run
from hypermap_lite.plotting.settled import beginning, settled, trace, trial_of, volume_trace
from tests.plotting.run_folders import write_run

LUCKY, OTHER, AGAIN = [4.0, 4.0], [3.0, 3.0], [0.0, 2.0]
"""Maximized; the first row is the best by far until its configuration is evaluated again, as often."""


def write_confirmed(folder, *, phase="confirm", Y=(LUCKY, OTHER, AGAIN), sem=None):
    configurations = [["1.0"], ["2.0"], ["1.0"]]
    write_run(folder, Y, configurations=configurations, sem=sem)
    with (folder / "history.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    rows[2]["phase"] = phase
    with (folder / "history.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return folder


def test_confirmed_rows_become_one_with_their_mean(tmp_path):
    samples = [[3.0, 5.0] * 3 + [4.0], [0.0, 1.0, -1.0, 0.0, 1.0, -1.0, 0.0]]
    sem = np.full((3, 2), np.nan)
    sem[[0, 2], 0] = [standard_error(sample) for sample in samples]
    run = settled(load_run(write_confirmed(tmp_path, sem=sem)))
    assert run.values.tolist() == [[2.0, 3.0], [3.0, 3.0]]
    assert run.standard_errors[0, 0] == pytest.approx(standard_error([*samples[0], *samples[1]]))
    assert run.values[0, 0] == pytest.approx(mean([*samples[0], *samples[1]]))
    assert (run.rows[0]["performance"], run.rows[0]["replicates"], run.rows[0]["trial"]) == ("2.0", "14", "0")
    assert run.is_front.tolist() == [False, True]


def test_run_without_confirmations_is_settled_as_it_is(tmp_path):
    run = load_run(write_confirmed(tmp_path, phase="earlier"))
    assert settled(run) is run


def test_confirmation_that_failed_takes_its_configuration_away(tmp_path):
    run = settled(load_run(write_confirmed(tmp_path, Y=(LUCKY, OTHER, [np.nan, np.nan]))))
    assert run.states == ["failed", "completed"]
    assert run.is_front.tolist() == [False, True]
    assert trial_of(run, 0) == 2


def test_volume_falls_when_a_lucky_draw_is_found_out(tmp_path):
    run = load_run(write_confirmed(tmp_path))
    assert volume_trace(run, np.zeros(2)).tolist() == [16.0, 16.0, 9.0]
    assert trace(run, lambda Y: np.fmin.accumulate(Y, axis=0)).tolist() == [[-4, -4], [-4, -4], [-3, -3]]
    assert volume_trace(beginning(run, 2), np.zeros(2)).tolist() == [16.0, 16.0]


def test_trace_without_confirmations_is_the_measure_itself(tmp_path):
    run = load_run(write_confirmed(tmp_path, phase="model"))
    assert volume_trace(run, np.zeros(2)).tolist() == hypervolume_trace(run.Y, np.zeros(2)).tolist()


def test_pictures_show_the_settled_front_and_the_volume_after_each_row(tmp_path):
    write_confirmed(tmp_path / "run")
    zero = {"performance": 0.0, "safety": 0.0}
    files = plot_pareto([tmp_path / "run"], tmp_path / "p.png", data=True, reference_point=zero)
    with files[-1].open(newline="") as file:
        points = [(row["evaluation"], row["on_front"], row["performance"]) for row in csv.DictReader(file)]
    assert points == [("1", "False", "2.0"), ("2", "True", "3.0")]
    files = plot_hypervolume([tmp_path / "run"], tmp_path / "h.png", data=True, reference_point=zero)
    with files[-1].open(newline="") as file:
        assert [float(row["hypervolume"]) for row in csv.DictReader(file)] == [16.0, 16.0, 9.0]
