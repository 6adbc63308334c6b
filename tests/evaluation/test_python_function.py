"""Tests for python_function.py."""

import pickle

import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.evaluation.outcome import State
from hypermap_lite.evaluation.python_function import PythonFunction, accepted_extras
from tests.evaluation import black_boxes
from tests.evaluation.examples import function, request


def test_function_is_called_by_its_import_name(tmp_path):
    outcome = function("sphere")(request(tmp_path, x=2.0))
    assert outcome.values == {"f": 4.0 + 11e-12, "g": 1.0}


@pytest.mark.parametrize(
    ("candidate", "extras"),
    [
        (lambda c: 0, ()),
        (lambda c, seed: 0, ("seed",)),
        (lambda c, *, trial, replicate=0: 0, ("replicate", "trial")),
        (lambda c, **kwargs: 0, ("seed", "replicate", "trial")),
        (lambda seed: 0, ()),
        (dict, ("seed", "replicate", "trial")),
        (min, ()),
    ],
)
def test_function_gets_only_the_facts_it_takes(candidate, extras):
    accepted = accepted_extras(candidate)
    assert accepted == extras or candidate in (dict, min)


def test_facts_are_those_of_the_request(tmp_path):
    seen = []
    evaluator = PythonFunction(function=lambda c, **facts: seen.append(facts) or 1.0, objectives=("f",))
    evaluator(request(tmp_path, trial=4, replicate=2))
    assert seen == [{"seed": 11, "replicate": 2, "trial": 4}]


def test_function_cannot_change_the_configuration(tmp_path):
    asked = request(tmp_path, x=1.0)
    evaluator = PythonFunction(function=lambda c: c.update(x=9) or 1.0, objectives=("f",))
    assert evaluator(asked).state is State.COMPLETED
    assert asked.configuration == {"x": 1.0}


def test_named_function_survives_pickling(tmp_path):
    evaluator = pickle.loads(pickle.dumps(function("sphere")))
    assert evaluator == function("sphere")
    assert evaluator(request(tmp_path)).state is State.COMPLETED


def test_given_function_survives_pickling(tmp_path):
    evaluator = pickle.loads(pickle.dumps(PythonFunction(function=black_boxes.sphere, objectives=("f", "g"))))
    assert evaluator(request(tmp_path)).state is State.COMPLETED


def test_module_is_found_in_the_search_path(tmp_path, monkeypatch):
    (tmp_path / "my_black_box.py").write_text("class Box:\n    @staticmethod\n    def f(c): return 5.0\n")
    monkeypatch.setattr("sys.path", __import__("sys").path[:])
    evaluator = PythonFunction(function="my_black_box:Box.f", objectives=("f",), search_path=(str(tmp_path),))
    assert evaluator(request(tmp_path)).values == {"f": 5.0}


BOXES = "tests.evaluation.black_boxes"


@pytest.mark.parametrize(
    ("name", "message"),
    [
        pytest.param("branin", "'branin' does not name a function\n  allowed: 'module:function'", id="no colon"),
        pytest.param(":f", "does not name a function", id="no module"),
        pytest.param(
            "no_such_module:f",
            "importing 'no_such_module' failed: ModuleNotFoundError: No module named 'no_such_module'\n"
            "  hint: It was looked for in ",
            id="no such module",
        ),
        pytest.param(
            "no_such_box.py:move",
            "\n  hint: A module is named without .py: 'no_such_box:move'.",
            id="a file's name",
        ),
        pytest.param(f"{BOXES}:spere", f"'{BOXES}' has no 'spere'\n  hint: Did you mean 'sphere'", id="misspelt"),
        pytest.param(f"{BOXES}:NOT_CALLABLE", "is int, not a function", id="not callable"),
    ],
)
def test_name_that_leads_nowhere_is_a_scenario_error(name, message):
    with pytest.raises(ScenarioError) as caught:
        PythonFunction(function=name, objectives=("f",))
    assert caught.value.path == "$.function"
    assert message in str(caught.value)


def test_import_error_within_the_module_is_shown(tmp_path, monkeypatch):
    (tmp_path / "broken_box.py").write_text("import math\nraise OSError('no robot on port 7')\n")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(ScenarioError, match="importing 'broken_box' failed: OSError: no robot on port 7"):
        PythonFunction(function="broken_box:f", objectives=("f",))


def test_what_an_import_prints_goes_to_stderr(tmp_path, monkeypatch, capfd):
    (tmp_path / "noisy_box.py").write_text(
        "import os\nprint('loud')\nos.write(1, b'from C\\n')\ndef f(c): return 1.0\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    PythonFunction(function="noisy_box:f", objectives=("f",))
    print("after")
    out, err = capfd.readouterr()
    assert out == "after\n"
    assert sorted(err.splitlines()) == ["from C", "loud"]
