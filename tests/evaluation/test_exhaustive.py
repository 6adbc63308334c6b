"""Tests for exhaustive.py."""

import pickle

import numpy as np
import pytest

from hypermap_lite.errors import EvaluationError, ScenarioError
from hypermap_lite.evaluation import table_index
from hypermap_lite.evaluation.exhaustive import Exhaustive
from hypermap_lite.evaluation.outcome import State
from hypermap_lite.objectives import FeasibleOutput
from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, RealParameter, SearchSpace
from tests.evaluation.examples import request

SPACE = SearchSpace(
    (IntegerParameter(name="n", low=1, high=3), CategoricalParameter(name="fast", values=("false", "true")))
)
ROWS = "cost,fast,n,ok,note\n1,False,1,yes,a\n2,False,2.0,no,b\n3,True,1,yes,c\nnan,True,2,yes,d\nbad,True,3,yes,e\n"


def table(folder, content=ROWS, space=SPACE, **options):
    (folder / "table.csv").write_text(content)
    return Exhaustive(file="table.csv", objectives=("cost",), space=space, folders=(folder,), **options)


def look_up(evaluator, folder, **configuration):
    return evaluator(request(folder, **configuration))


def test_row_is_found_whatever_way_it_is_written(tmp_path):
    found = table(tmp_path)
    assert look_up(found, tmp_path, n=2, fast="false").values == {"cost": 2.0}
    assert look_up(found, tmp_path, n=1, fast="true").values == {"cost": 3.0}
    assert look_up(found, tmp_path, n=1, fast="true").metrics == {}


def test_configuration_that_is_not_there_is_an_evaluation_error_that_names_it(tmp_path):
    with pytest.raises(EvaluationError, match=r"table\.csv has no row with n=3, fast=false"):
        look_up(table(tmp_path), tmp_path, n=3, fast="false")


def test_value_that_is_not_finite_fails_and_text_is_an_error_with_its_line(tmp_path):
    found = table(tmp_path)
    assert look_up(found, tmp_path, n=2, fast="true").state is State.FAILED
    with pytest.raises(EvaluationError, match=r"line 6 of table\.csv: 'cost' is 'bad', not a number"):
        look_up(found, tmp_path, n=3, fast="true")


def test_feasibility_is_read_from_its_column(tmp_path):
    found = table(tmp_path, feasible_output=FeasibleOutput(name="ok", true_value="yes", false_value="no"))
    outcome = look_up(found, tmp_path, n=2, fast="false")
    assert (outcome.state, outcome.values) == (State.INFEASIBLE, {"cost": 2.0})
    assert look_up(found, tmp_path, n=1, fast="false").state is State.COMPLETED


def test_column_of_feasibility_must_be_there(tmp_path):
    with pytest.raises(ScenarioError, match="has no column 'Valid'"):
        table(tmp_path, feasible_output=FeasibleOutput())


def test_first_of_rows_that_repeat_each_other_counts(tmp_path):
    found = table(tmp_path, "n,fast,cost\n1,true,5\n1.0,TRUE,5.0\n2,true,6\n")
    assert look_up(found, tmp_path, n=1, fast="true").values == {"cost": 5.0}
    assert "1 rows of the table repeat earlier ones, and are left out." in found.warnings()


def test_rows_of_one_configuration_with_different_answers_are_refused(tmp_path):
    with pytest.raises(ScenarioError, match=r"lines 2 and 4 of .* but 'cost' is 5 in one and 7 in the other"):
        table(tmp_path, "n,fast,cost\n1,true,5\n2,true,6\n1.0,True,7\n")


def test_real_parameters_are_found_by_their_value(tmp_path):
    space = SearchSpace((RealParameter(name="x", low=0.0, high=1.0), OrdinalParameter(name="o", values=(1, 10))))
    found = table(tmp_path, "x,o,cost\n0.3,1.0,5\n1e-3,10,6\n", space)
    assert look_up(found, tmp_path, x=0.1 + 0.2, o=1).values == {"cost": 5.0}
    assert look_up(found, tmp_path, x=0.001, o=10.0).values == {"cost": 6.0}
    assert list(found.warnings()) == [
        "the table holds 2 configurations of an infinite number; any other is a failed evaluation."
    ]


def test_warnings_say_how_much_the_table_covers(tmp_path):
    found = table(tmp_path, "n,fast,cost\n1,true,5\n2,true,6\n9,true,6\n1,maybe,6\n")
    assert list(found.warnings()) == [
        "the table holds 2 configurations of 6 (33.3 %); any other is a failed evaluation.",
        "2 rows of the table are no configurations of the search space, and are left out.",
    ]


def test_full_table_gives_no_warning(tmp_path):
    rows = "".join(f"{n},{fast},1\n" for n in (1, 2, 3) for fast in ("true", "false"))
    assert list(table(tmp_path, f"n,fast,cost\n{rows}").warnings()) == []


def test_file_is_looked_for_in_its_folders_in_order(tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    table(tmp_path / "b")
    found = Exhaustive(file="table.csv", objectives=("cost",), space=SPACE, folders=(tmp_path / "a", tmp_path / "b"))
    assert found.n_known == 5
    assert pickle.loads(pickle.dumps(found)).n_known == 5


def test_values_of_many_digits_are_found_by_the_configurations_they_are_rounded_to(tmp_path):
    space = SearchSpace((RealParameter(name="x", low=0.05, high=2),))
    values = np.random.default_rng(0).uniform(0.05, 2, 2000)
    found = table(tmp_path, "x,cost\n" + "".join(f"{x!r},{i}\n" for i, x in enumerate(values.tolist())), space)
    asked = space.decode(space.encode([{"x": x} for x in values.tolist()]))
    assert [look_up(found, tmp_path, **c).values["cost"] for c in asked] == [*range(2000)]


def test_of_a_large_table_each_text_of_a_column_is_read_once_and_a_look_up_reads_none(tmp_path, monkeypatch):
    sizes = [2**i for i in range(20)]
    space = SearchSpace(
        (
            IntegerParameter(name="a", low=1, high=100),
            OrdinalParameter(name="b", values=tuple(sizes)),
            IntegerParameter(name="c", low=0, high=9),
            CategoricalParameter(name="d", values=("false", "true")),
        )
    )
    lines = [
        f"{a},{b},{c},{d},{a * b}" for a in range(1, 101) for b in sizes for c in range(10) for d in ("false", "true")
    ]
    read = []
    value_of = table_index.value_of
    monkeypatch.setattr(table_index, "value_of", lambda p, text: read.append((p.name, text)) or value_of(p, text))
    found = table(tmp_path, "a,b,c,d,cost\n" + "\n".join(lines) + "\n", space)
    assert look_up(found, tmp_path, a=7, b=1024.0, c=3, d="true").values == {"cost": 7168.0}
    assert found.n_known == 40_000
    assert len(read) == len(set(read)) == 100 + 20 + 10 + 2
