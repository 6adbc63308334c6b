"""Tests for command.py."""

import json
import os
import sys

import pytest

from hypermap_lite.errors import EvaluationError, ScenarioError
from hypermap_lite.evaluation.command import THREAD_CAPS, Command, describe_status
from hypermap_lite.evaluation.evaluator import call
from hypermap_lite.evaluation.outcome import State
from tests.evaluation.examples import request
from tests.evaluation.test_worker import children_of, is_running, wait_for


def shell(script, **options):
    return Command(command=["/bin/sh", "-c", script], objectives=("f",), **options)


def python(code, *arguments, **options):
    return Command(command=["{python}", "-c", code, *arguments], objectives=("f",), **options)


def reason(command, asked):
    record = call(command, asked)
    assert record.outcome.state is State.FAILED
    return record.outcome.error


def test_last_line_that_is_not_empty_is_the_result(tmp_path):
    command = shell(
        """echo progress; echo '{{"f": 3, "steps": 7}}'; echo; echo""".replace("{{", "{").replace("}}", "}")
    )
    outcome = command(request(tmp_path))
    assert (outcome.values, outcome.metrics) == ({"f": 3.0}, {"steps": 7.0})
    assert (tmp_path / "0000" / "replicate_0.stdout.log").read_text().startswith("progress\n")


def test_every_placeholder_reaches_the_program(tmp_path):
    code = "import json, sys; print(json.dumps({'f': 1, 'argv': 0})); print(json.dumps(sys.argv[1:]), file=sys.stderr)"
    names = ["x", "seed", "trial", "replicate", "trial_dir", "params_file", "result_file", "params_json"]
    command = python(code, *(f"{{{name}}}" for name in names))
    command(request(tmp_path, trial=3, replicate=1, x=0.1))
    folder = tmp_path / "0003"
    assert json.loads((folder / "replicate_1.stderr.log").read_text()) == [
        *("0.1", "11", "3", "1", str(folder), str(folder / "parameters.json"), str(folder / "replicate_1.result.json")),
        '{"x": 0.1}',
    ]
    assert json.loads((folder / "parameters.json").read_text()) == {"x": 0.1}


def test_result_may_come_in_a_file_named_in_the_environment(tmp_path):
    command = shell('cp "$HYPERMAP_PARAMS_FILE" "$HYPERMAP_RESULT_FILE"; echo "$HYPERMAP_SEED"', result="file")
    assert command(request(tmp_path, f=4.5)).values == {"f": 4.5}


def test_result_file_of_an_earlier_attempt_does_not_count(tmp_path):
    asked = request(tmp_path)
    asked.directory.mkdir()
    asked.file("result.json").write_text('{"f": 1}')
    assert "the result file is empty, not a JSON object" in reason(shell("true", result="file"), asked)


def test_shell_command_is_joined_and_its_values_quoted(tmp_path):
    command = Command(command=["printf", "'{\"f\": %s}'", "{x}", "|", "tr", "0", "7"], shell=True, objectives=("f",))
    assert command(request(tmp_path, x=10)).values == {"f": 17.0}


@pytest.mark.parametrize(
    ("script", "said"),
    [
        pytest.param("echo oops >&2; exit 3", "exit status 3: oops", id="exit status"),
        pytest.param("kill -SEGV $$", "killed by signal 11 (SIGSEGV)", id="signal"),
        pytest.param("true", "the last line of the output is empty, not a JSON object", id="nothing printed"),
        pytest.param("echo done", "the last line of the output is 'done', not a JSON object", id="no JSON"),
        pytest.param("echo 3.5", "is '3.5', not a JSON object", id="bare number"),
        pytest.param("echo hm >&2; echo '[1]'", "(stderr: hm)", id="list"),
        pytest.param("""echo '{"f": NaN}'""", "'f' is nan, not a finite number", id="nan"),
        pytest.param("""echo '{"g": 1}'""", "the result has no 'f' (it has: g)", id="missing objective"),
    ],
)
def test_failures_are_told_apart(tmp_path, script, said):
    assert said in reason(shell(script), request(tmp_path))


def test_infeasible_result_is_no_failure(tmp_path):
    assert shell("""echo '{"feasible": false}'""")(request(tmp_path)).state is State.INFEASIBLE


def test_program_that_vanished_is_a_failure(tmp_path):
    program = tmp_path / "tool"
    program.write_text("#!/no/such/interpreter\n")
    program.chmod(0o755)
    command = Command(command=["./tool"], objectives=("f",), working_directory=tmp_path)
    assert "the program could not be started" in reason(command, request(tmp_path / "run"))


def test_program_runs_in_its_working_directory(tmp_path):
    (tmp_path / "result.txt").write_text('{"f": 8}')
    assert shell("cat result.txt", working_directory=tmp_path)(request(tmp_path / "run")).values == {"f": 8.0}


def test_thread_limits_of_the_worker_do_not_reach_the_program(tmp_path, monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    monkeypatch.setenv(THREAD_CAPS, "OMP_NUM_THREADS")
    command = shell("""echo "{\\"f\\": ${OMP_NUM_THREADS:-8}}" """)
    assert command(request(tmp_path)).values == {"f": 8.0}


@pytest.mark.parametrize(
    ("command", "path", "message"),
    [
        pytest.param([], "$.command", "a list of at least one string", id="empty"),
        pytest.param("echo", "$.command", "a list of at least one string", id="string"),
        pytest.param(["no_such_program"], "$.command[0]", "'no_such_program' is not on the PATH", id="not found"),
        pytest.param(["./tool"], "$.command[0]", "is not executable\n  hint: chmod +x ", id="not executable"),
        pytest.param(["./none"], "$.command[0]", "there is no program '", id="no file"),
        pytest.param(["tool"], "$.command[0]", "Write './tool' for the file in", id="in the folder"),
        pytest.param(["sh", "{Forse}"], "$.command[1]", "{Forse}\n  allowed: {Force}, {params_json}", id="placeholder"),
    ],
)
def test_command_that_cannot_run_is_a_scenario_error(tmp_path, command, path, message):
    (tmp_path / "tool").write_text("")
    with pytest.raises(ScenarioError) as caught:
        Command(command=command, objectives=("f",), working_directory=tmp_path, parameters=("Force",))
    assert caught.value.path == path
    assert message in str(caught.value)


def test_unknown_placeholder_gets_the_nearest_name():
    with pytest.raises(ScenarioError, match=r"Did you mean 'Force'\? For the text itself, write \{\{Forse\}\}"):
        Command(command=["sh", "{Forse}"], objectives=("f",), parameters=("Force",))


def test_other_place_for_the_result_is_refused():
    with pytest.raises(ScenarioError, match=r"\$.result: the result is 'stderr'"):
        shell("true", result="stderr")


def test_status_is_said_in_words():
    assert [describe_status(s) for s in (2, -9, -250)] == [
        "exit status 2",
        "killed by signal 9 (SIGKILL)",
        "killed by signal 250",
    ]


def test_interpreter_is_the_one_in_use(tmp_path):
    assert "3.9" not in sys.version[:3]
    code = f"import json, sys; print(json.dumps(dict(f=float(sys.executable == {sys.executable!r}))))"
    assert python(code)(request(tmp_path)).values == {"f": 1.0}


def test_reason_is_an_evaluation_error(tmp_path):
    with pytest.raises(EvaluationError, match="exit status 1"):
        shell("false")(request(tmp_path))


def test_line_separator_within_a_string_does_not_end_the_line(tmp_path):
    command = shell("""printf '{"f": 2, "note": "a\\342\\200\\250b"}'""")
    assert command(request(tmp_path)).values == {"f": 2.0}


def test_result_line_that_is_too_long_is_named_as_such(tmp_path):
    code = "import json; print(json.dumps(dict(f=1, path='x' * 2**20)))"
    said = reason(python(code), request(tmp_path))
    assert "is longer than 1 MiB: write the result to {result_file}" in said


def test_what_a_program_leaves_running_ends_with_its_call(tmp_path):
    command = shell("""sleep 60 & echo "{\\"f\\": $!}" """)
    pid = int(command(request(tmp_path)).values["f"])
    wait_for(lambda: not is_running(pid))


def test_failing_program_leaves_nothing_running_either(tmp_path):
    said = reason(shell("sleep 60 & echo $! >&2; exit 3"), request(tmp_path))
    wait_for(lambda: not is_running(int(said.split()[-1])))


def test_interrupt_of_this_process_ends_the_program(tmp_path, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("os.waitid", interrupt)
    with pytest.raises(KeyboardInterrupt):
        shell("echo $$; exec sleep 60")(request(tmp_path))
    assert children_of(os.getpid()) == []


def test_log_of_a_program_is_limited_after_its_result_was_read(tmp_path):
    command = shell("""head -c 4000000 /dev/zero | tr '\\0' x; echo; echo '{"f": 1}'""")
    assert command(request(tmp_path)).values == {"f": 1.0}
    assert (tmp_path / "0000" / "replicate_0.stdout.log").stat().st_size < 2.1 * 2**20
