"""Tests for rows.py."""

import csv
import io
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypermap_lite.errors import RunFolderError
from hypermap_lite.evaluation.outcome import Evaluation, Outcome, Replicate, State, Suggestion
from hypermap_lite.history.csv_format import format_record
from hypermap_lite.history.rows import PRIOR_COLUMNS, EvaluationsFormat, HistoryFormat, read_history
from hypermap_lite.objectives import FeasibleOutput
from tests.history.examples import OBJECTIVES, SPACE, evaluation, replicate

HISTORY = HistoryFormat(SPACE, OBJECTIVES)

finite = st.floats(allow_nan=False, allow_infinity=False)
configurations = st.fixed_dictionaries(
    {
        "force": st.floats(-20, 1e6),
        "turns": st.integers(-3, 2000),
        "gain": st.sampled_from((0.5, 2, 1e-7)),
        "tool": st.sampled_from(SPACE.parameters[3].values),
    }
)
suggestions = st.builds(
    Suggestion,
    trial=st.integers(0, 10_000),
    configuration=configurations,
    phase=st.sampled_from(["default", "design", "model"]),
    prior_weight=st.none() | finite,
    acquisition_value=st.none() | finite,
    seconds=st.integers(0, 10**6).map(lambda n: n / 64),
)
evaluations = st.one_of(
    st.builds(
        Evaluation,
        suggestion=suggestions,
        state=st.just(State.COMPLETED),
        values=st.fixed_dictionaries({"reward": finite, "cost": finite}),
        standard_errors=st.fixed_dictionaries({"reward": finite, "cost": finite}),
        replicates=st.integers(1, 9),
        timestamp=st.integers(0, 2**53),
    ),
    st.builds(Evaluation, suggestion=suggestions, state=st.just(State.FAILED), error=st.text()),
    st.builds(Evaluation, suggestion=suggestions, state=st.just(State.INFEASIBLE), error=st.text()),
    st.builds(
        Evaluation,
        suggestion=suggestions,
        state=st.just(State.INFEASIBLE),
        values=st.fixed_dictionaries({"cost": finite}),
        standard_errors=st.fixed_dictionaries({"cost": finite}),
        error=st.text(),
    ),
)
FLAG = FeasibleOutput(name="fits", true_value="yes, it does", false_value="0")
calls = st.builds(
    Replicate,
    trial=st.integers(0, 10_000),
    replicate=st.integers(0, 9),
    seed=st.integers(0, 2**31 - 1),
    configuration=configurations,
    outcome=st.builds(
        Outcome,
        state=st.sampled_from(State),
        values=st.just({}) | st.fixed_dictionaries({"reward": finite, "cost": finite}),
        metrics=st.dictionaries(st.sampled_from(["seconds", "force", "result.x", "a,b", "é"]), finite),
        error=st.text(),
    ),
    seconds=st.integers(0, 10**6).map(lambda n: n / 64),
)


def fields_of(record: str) -> list[str]:
    return next(csv.reader(io.StringIO(record, newline="")))


@given(evaluations, st.sampled_from([HISTORY, HistoryFormat(SPACE, OBJECTIVES, FLAG)]))
def test_evaluations_round_trip_exactly(row, form):
    assert form.parse(fields_of(form.format(row))) == row


@given(evaluations, st.sampled_from([1.0, 0.5, 0.0, None]), st.sampled_from(["reward", ""]))
def test_what_is_said_of_priors_round_trips_exactly(row, trust, name):
    row = replace(row, suggestion=replace(row.suggestion, prior_trust=trust, prior_of=name))
    form = HistoryFormat(SPACE, OBJECTIVES, None, PRIOR_COLUMNS)
    assert form.parse(fields_of(form.format(row))) == row


def test_columns_of_priors_follow_the_weight_and_are_there_if_asked_for():
    columns = HistoryFormat(SPACE, OBJECTIVES, None, ("prior_of", "prior_trust")).columns
    assert columns[columns.index("prior_weight") :][:4] == (
        *("prior_weight", "prior_trust", "prior_of", "acquisition_value"),
    )
    assert "prior_of" not in HistoryFormat(SPACE, OBJECTIVES, None, ("prior_trust",)).columns


@pytest.mark.parametrize("shown", [(), ("prior_trust",), ("prior_of",), ("prior_trust", "prior_of")])
def test_a_history_is_read_with_the_columns_of_priors_that_it_has(tmp_path, shown):
    form = HistoryFormat(SPACE, OBJECTIVES, None, shown)
    row = evaluation(0)
    row = replace(row, suggestion=replace(row.suggestion, prior_weight=0.5, prior_trust=0.25, prior_of="cost"))
    (tmp_path / "history.csv").write_text(format_record(form.columns) + form.format(row))
    (found,) = read_history(tmp_path, SPACE, OBJECTIVES)
    assert found.suggestion.prior_weight == 0.5
    assert found.suggestion.prior_trust == (0.25 if "prior_trust" in shown else None)
    assert found.suggestion.prior_of == ("cost" if "prior_of" in shown else "")


@given(calls, st.sampled_from([None, FLAG]))
def test_replicates_round_trip_exactly(row, flag):
    form = EvaluationsFormat(SPACE, OBJECTIVES, tuple(row.outcome.metrics), feasible_output=flag)
    assert form.parse(fields_of(form.format(row))) == row
    assert form.metrics_in(form.columns) == form.metrics
    assert len(set(form.columns)) == len(form.columns)


def test_history_columns_begin_as_hypermapper_wrote_them():
    assert HISTORY.columns[:7] == ("force", "turns", "gain", "tool", "reward", "cost", "Timestamp")
    assert HISTORY.columns[7:] == (
        *("trial", "phase", "state", "replicates", "reward_sem", "cost_sem", "prior_weight", "acquisition_value"),
        *("suggest_seconds", "evaluate_seconds", "error"),
    )


def test_feasibility_stands_between_the_objectives_and_the_time():
    form = HistoryFormat(SPACE, OBJECTIVES, FeasibleOutput())
    assert form.columns[4:8] == ("reward", "cost", "Valid", "Timestamp")
    calls = EvaluationsFormat(SPACE, OBJECTIVES, ("speed",), feasible_output=FeasibleOutput())
    assert calls.columns[-6:] == ("reward", "cost", "Valid", "speed", "seconds", "error")
    rows = [evaluation(0), replace(evaluation(1), state=State.INFEASIBLE), evaluation(2, None)]
    assert [fields_of(form.format(row))[6] for row in rows] == ["True", "False", ""]


def test_feasibility_that_is_not_that_of_the_state_is_an_error(tmp_path):
    form = HistoryFormat(SPACE, OBJECTIVES, FeasibleOutput())
    record = form.format(evaluation(0)).replace("True", "False")
    (tmp_path / "history.csv").write_text(format_record(form.columns) + record)
    with pytest.raises(RunFolderError, match="record 2 cannot be read: Valid is 'False', but the state is completed"):
        read_history(tmp_path, SPACE, OBJECTIVES, FeasibleOutput())


def test_history_without_the_column_of_the_feasibility_is_read_all_the_same(tmp_path):
    rows = [evaluation(0), replace(evaluation(1), state=State.INFEASIBLE)]
    (tmp_path / "history.csv").write_text(format_record(HISTORY.columns) + "".join(map(HISTORY.format, rows)))
    back = read_history(tmp_path, SPACE, OBJECTIVES, FeasibleOutput())
    assert [(row.state, row.values) for row in back] == [(row.state, row.values) for row in rows]


def test_standard_error_of_one_replicate_is_an_empty_field():
    row = HISTORY.parse(fields_of(HISTORY.format(evaluation(0))))
    assert str(row.standard_errors["reward"]) == "nan"
    assert ",,0.1," in HISTORY.format(evaluation(0))


def test_metric_named_like_a_column_gets_a_prefix():
    form = EvaluationsFormat(SPACE, OBJECTIVES, ("seconds", "speed", "force"))
    assert form.columns[-5:] == ("result.seconds", "speed", "result.force", "seconds", "error")


def test_metric_that_a_call_lacks_is_an_empty_field():
    form = EvaluationsFormat(SPACE, OBJECTIVES, ("speed",))
    assert form.parse(fields_of(form.format(replicate(0)))).outcome.metrics == {}


def test_history_reads_back_from_its_folder_and_its_file(tmp_path):
    rows = [evaluation(0, 1.0), evaluation(1, None)]
    path = tmp_path / "history.csv"
    path.write_text(format_record(HISTORY.columns) + HISTORY.format(rows[0]) + HISTORY.format(rows[1]))
    for place in (tmp_path, path):
        back = read_history(place, SPACE, OBJECTIVES)
        assert [row.state for row in back] == [State.COMPLETED, State.FAILED]
        assert [row.configuration for row in back] == [row.configuration for row in rows]


def test_history_that_does_not_exist_is_empty(tmp_path):
    assert read_history(tmp_path, SPACE, OBJECTIVES) == []


def test_history_with_a_gap_is_refused(tmp_path):
    (tmp_path / "history.csv").write_text(format_record(HISTORY.columns) + HISTORY.format(evaluation(1)))
    with pytest.raises(RunFolderError, match="record 2 is trial 1, but trial 0 was expected"):
        read_history(tmp_path, SPACE, OBJECTIVES)


def test_history_with_other_columns_is_refused(tmp_path):
    (tmp_path / "history.csv").write_text("x,y\n1,2\n")
    with pytest.raises(RunFolderError, match=r'columns are not those(.|\n)*found: +\["x", "y"\]'):
        read_history(tmp_path, SPACE, OBJECTIVES)
