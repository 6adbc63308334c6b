"""The whole program as the child of a client: what it says, to the byte, and how it takes what the client says."""

from __future__ import annotations

import csv
import signal
import subprocess
import time

import pytest

from tests.cli.clients import MODULE, Forked, converse, environment, good, history, table, value, write_scenario

FILES = ("history.csv", "evaluations.csv", "pareto.csv")


def test_exchange_is_to_the_letter(tmp_path):
    said = converse(write_scenario(tmp_path), command=MODULE)
    lines = said.heard.decode().splitlines()
    rows = history(tmp_path / "run")
    texts = [",".join(row[name] for name in ("x", "n", "o", "c")) for row in rows]
    assert lines[:7] == ["Request 4", "x,n,o,c", *texts[:4], "Request 1"]
    expected = [f"Request 4\nx,n,o,c\n{''.join(text + chr(10) for text in texts[:4])}"]
    expected += [f"Request 1\nx,n,o,c\n{text}\n" for text in texts[4:]]
    assert said.heard.decode() == "".join(expected) + "End of HyperMapper\n"
    assert lines[2] == "0.0,3,1,green"
    assert said.status == 0


def test_all_else_goes_to_stderr(tmp_path):
    said = converse(write_scenario(tmp_path), options=())
    assert "served: 7 evaluations: 7 completed; the run ended because the budget" in said.stderr
    assert "hypervolume" in said.stderr
    assert "history.csv" in said.stderr
    assert "pareto.png" in said.stderr


def test_answers_are_what_the_history_holds(tmp_path):
    converse(write_scenario(tmp_path))
    for row in history(tmp_path / "run"):
        assert {name: float(text) for name, text in value(row).items()} == {name: float(row[name]) for name in "fg"}


def test_batches_after_the_design_have_the_batch_size(tmp_path):
    said = converse(write_scenario(tmp_path, budget={"evaluations": 9, "batch_size": 2}))
    assert [len(rows) for rows in said.requests] == [4, 2, 2, 1]


def test_bayesian_optimization_hears_nothing_but_real_values(tmp_path):
    budget = {"evaluations": 8, "batch_size": 2}
    said = converse(write_scenario(tmp_path, optimizer="bayesian", budget=budget))
    assert [len(rows) for rows in said.requests] == [4, 2, 2]
    assert [row["state"] for row in history(tmp_path / "run")] == ["completed"] * 8


def any_order(number, rows):
    full = [{**row, **value(row), "time": "1.5", "note": "hm"} for row in rows]
    return table(full[::-1], ["note", "g", "c", "o", "f", "n", "time", "x"])


def rounded(number, rows):
    return table([{**row, **value(row), "x": f"{float(row['x']):.6g}"} for row in rows], [*rows[0], "f", "g"])


@pytest.mark.parametrize("reply", [any_order, rounded], ids=["any order and more columns", "rounded echoes"])
def test_form_of_the_reply_does_not_matter(tmp_path, reply):
    for name in ("plain", "other"):
        (tmp_path / name).mkdir()
    converse(write_scenario(tmp_path / "plain"))
    said = converse(write_scenario(tmp_path / "other"), reply)
    assert said.status == 0
    assert history(tmp_path / "other" / "run") == history(tmp_path / "plain" / "run")


def spoilt(spoil, at=1):
    """Return a client that spoils the text of its reply to one request."""
    return lambda number, rows: spoil(good(number, rows)) if number == at else good(number, rows)


def cut(text):
    return "".join(text.splitlines(keepends=True)[:-1])


@pytest.mark.parametrize(
    ("reply", "says", "kept"),
    [
        pytest.param(spoilt(lambda t: ""), "closed its output before the header of its reply", 4, id="no reply"),
        pytest.param(spoilt(lambda t: t.replace("f", "F"), 0), "no column 'f'. Did you mean 'F'?", 0, id="column"),
        pytest.param(spoilt(lambda t: t[:-1] + ",1\n", 0), "has 7 fields, its header 6", 3, id="fields"),
        pytest.param(
            lambda number, rows: table([{**row, "f": "no", "g": "1"} for row in rows], [*rows[0], "f", "g"]),
            "'f' is 'no', not a number",
            0,
            id="number",
        ),
        pytest.param(
            spoilt(lambda t: t.replace("red", "blue").replace("green", "blue")), "c is blue, asked for", 4, id="echo"
        ),
    ],
)  # fmt: skip
def test_wrong_reply_ends_the_run_with_what_was_finished(tmp_path, reply, says, kept):
    scenario = write_scenario(tmp_path)
    said = converse(scenario, reply)
    assert said.status == 5
    assert said.stderr.count("error: ") == 1  # in full with its advice; the log has its own line
    assert says in said.stderr
    assert b"End of HyperMapper" not in said.heard
    assert says.split(".")[0] in (tmp_path / "run" / "run.log").read_text()
    assert len(history(tmp_path / "run")) == kept
    again = converse(scenario)
    assert sum(map(len, again.requests)) == 7 - kept
    assert again.status == 0


def test_rows_before_a_torn_reply_are_kept_and_not_asked_for_again(tmp_path):
    scenario = write_scenario(tmp_path)

    def leave(number, rows):
        return cut(cut(good(number, rows)))

    first = converse(
        scenario, lambda number, rows: leave(number, rows), options=["--set", "evaluator.timeout_seconds=1"]
    )
    assert first.status == 5
    assert "was not complete within its time limit of 1 s" in first.stderr
    assert len(history(tmp_path / "run")) == 2
    second = converse(scenario)
    assert [len(rows) for rows in second.requests] == [2, 1, 1, 1]
    (tmp_path / "whole").mkdir()
    converse(write_scenario(tmp_path / "whole"))
    for name in FILES:
        assert history(tmp_path / "run", name) == history(tmp_path / "whole" / "run", name)


def test_silent_client_is_waited_for_no_longer_than_the_time_limit(tmp_path):
    scenario = write_scenario(tmp_path, evaluator={"type": "client_server", "timeout_seconds": 0.5})
    said = converse(scenario, lambda number, rows: "\n")
    assert said.status == 5
    assert "was not complete within its time limit of 0.5 s" in said.stderr


@pytest.mark.parametrize("until", [0, 1, 3])
def test_killed_run_asks_for_what_is_missing_and_ends_the_same(tmp_path, until):
    for name in ("whole", "killed"):
        (tmp_path / name).mkdir()
    budget = {"evaluations": 9, "batch_size": 2}
    converse(write_scenario(tmp_path / "whole", budget=budget))
    killed = converse(write_scenario(tmp_path / "killed", budget=budget), until=until)
    assert killed.status == -signal.SIGKILL
    went_on = converse(tmp_path / "killed" / "scenario.json")
    assert went_on.requests[0] == killed.requests[-1]
    assert sum(map(len, killed.requests[:-1])) + sum(map(len, went_on.requests)) == 9
    for name in FILES:
        assert history(tmp_path / "killed" / "run", name) == history(tmp_path / "whole" / "run", name)


def test_finished_run_asks_for_nothing_more(tmp_path):
    scenario = write_scenario(tmp_path)
    converse(scenario)
    said = converse(scenario)
    assert (said.heard, said.status) == (b"End of HyperMapper\n", 0)


def test_client_that_leaves_before_the_end_is_heard_out(tmp_path):
    scenario = write_scenario(tmp_path, budget={"evaluations": 4})
    with (tmp_path / "stderr.txt").open("w") as stderr, Forked([str(scenario)], tmp_path, stderr.fileno()) as process:
        header = [process.stdout.readline().decode().strip().split(",") for _ in range(2)]
        texts = [process.stdout.readline().decode().strip().split(",") for _ in range(4)]
        process.stdout.close()
        process.stdin.write(good(0, [dict(zip(header[1], row, strict=True)) for row in texts]).encode())
    assert process.returncode == 0
    assert len(history(tmp_path / "run")) == 4


def test_client_that_does_not_read_at_all_is_an_error(tmp_path):
    with (tmp_path / "stderr.txt").open("w") as stderr:
        process = Forked([str(write_scenario(tmp_path))], tmp_path, stderr.fileno())
        process.stdout.close()
        with process:
            pass
    assert process.returncode == 5
    assert "the client no longer reads what it is sent" in (tmp_path / "stderr.txt").read_text()


def test_values_that_are_not_finite_are_failed_evaluations_and_the_run_goes_on(tmp_path):
    def with_holes(number, rows):
        text = ["nan", "inf", "1"]
        full = [{**row, "f": text[(number + i) % 3], "g": "2"} for i, row in enumerate(rows)]
        return table(full, [*rows[0], "f", "g"])

    said = converse(write_scenario(tmp_path), with_holes)
    assert said.status == 0
    rows = history(tmp_path / "run")
    assert [row["state"] for row in rows] == [
        "failed",
        "failed",
        "completed",
        "failed",
        "failed",
        "completed",
        "failed",
    ]
    assert rows[0]["error"] == "'f' is nan, not a finite number"
    assert said.heard.endswith(b"End of HyperMapper\n")


def test_client_that_never_has_a_value_ends_the_run_for_failures(tmp_path):
    said = converse(
        write_scenario(tmp_path),
        lambda number, rows: table([{**row, "f": "nan", "g": "nan"} for row in rows], [*rows[0], "f", "g"]),
    )
    assert said.status == 4
    assert len(history(tmp_path / "run")) == 5


def test_run_without_a_usable_value_says_so_and_ends_the_exchange(tmp_path):
    budget = {"evaluations": 4}
    said = converse(
        write_scenario(tmp_path, budget=budget),
        lambda number, rows: table([{**row, "f": "nan", "g": "nan"} for row in rows], [*rows[0], "f", "g"]),
    )
    assert said.status == 3
    assert said.heard.endswith(b"End of HyperMapper\n")


def test_ctrl_c_lets_the_client_finish_its_reply(tmp_path):
    scenario = write_scenario(tmp_path)

    def interrupt(number, rows):
        if number == 1:
            pid = (tmp_path / "run" / ".lock").read_text().strip()
            subprocess.run(["kill", "-INT", pid], check=True)
            time.sleep(0.3)
        return good(number, rows)

    said = converse(scenario, interrupt)
    assert said.status == 130
    assert len(history(tmp_path / "run")) == 5
    assert b"End" not in said.heard
    assert "To go on:" in said.stderr


def test_ctrl_c_that_stops_the_client_too_is_no_error_of_the_client(tmp_path):
    def interrupt(number, rows):
        if number == 0:
            return good(number, rows)
        subprocess.run(["kill", "-INT", (tmp_path / "run" / ".lock").read_text().strip()], check=True)
        time.sleep(0.3)
        return ""

    said = converse(write_scenario(tmp_path), interrupt)
    assert said.status == 130
    assert "To go on:" in said.stderr


def test_black_box_prints_of_a_library_do_not_reach_the_client(tmp_path):
    (tmp_path / "sitecustomize.py").write_text(
        "import atexit, os\natexit.register(lambda: print('bye'))\natexit.register(lambda: os.write(1, b'ciao'))\n"
    )
    env = environment(PYTHONPATH=f"{tmp_path}:{environment()['PYTHONPATH']}")
    said = converse(write_scenario(tmp_path), command=MODULE, env=env)
    assert said.heard.endswith(b"End of HyperMapper\n")
    assert "bye" in said.stderr


def test_timestamps_are_milliseconds_since_the_start(tmp_path):
    converse(write_scenario(tmp_path))
    with (tmp_path / "run" / "history.csv").open(newline="") as file:
        times = [int(row["Timestamp"]) for row in csv.DictReader(file)]
    assert times == sorted(times)
    assert times[-1] < 10 * 60 * 1000
