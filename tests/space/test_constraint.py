"""What a constraint means, and what is no constraint."""

import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypermap_lite.errors import ScenarioError
from hypermap_lite.space import CategoricalParameter, Constraint, IntegerParameter, OrdinalParameter, RealParameter

PARAMETERS = (
    RealParameter(name="x1", low=-5, high=10),
    RealParameter(name="x2", low=0, high=15),
    IntegerParameter(name="n", low=0, high=9),
    OrdinalParameter(name="size", values=(0.1, 0.2, 0.3)),
    CategoricalParameter(name="optimizer", values=("adam", "sgd", "it's")),
    RealParameter(name="learning-rate", low=0, high=1),
    IntegerParameter(name="2nd", low=0, high=1),
    IntegerParameter(name="lambda", low=1, high=2),
)

COLUMNS = {
    "x1": np.array([0.0, 1.0, -2.0]),
    "x2": np.array([3.0, 4.0, 5.0]),
    "n": np.array([0.0, 1.0, 2.0]),
    "size": np.array([0.1, 0.2, 0.3]),
    "optimizer": np.array(["adam", "sgd", "it's"], dtype=object),
    "learning-rate": np.array([0.1, 0.2, 0.3]),
    "2nd": np.array([0.0, 1.0, 1.0]),
    "lambda": np.array([1.0, 2.0, 1.0]),
}
"""Three points."""


def holds(text: str) -> list[bool]:
    return Constraint(text, PARAMETERS).holds(COLUMNS, 3).tolist()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        pytest.param("x1 <= 0", [True, False, True], id="at most"),
        pytest.param("x1 < 0", [False, False, True], id="less"),
        pytest.param("x1**2 + x2**2 <= 17", [True, True, False], id="circle"),
        pytest.param("x1 - 3*x2 + 10 <= 0", [False, True, True], id="line"),
        pytest.param("0 < x2 - x1 <= 3", [True, True, False], id="chain"),
        pytest.param("n == 1", [False, True, False], id="equal"),
        pytest.param("n != 1", [True, False, True], id="different"),
        pytest.param("n in [0, 2]", [True, False, True], id="in"),
        pytest.param("n not in (0, 2)", [False, True, False], id="not in"),
        pytest.param("x1 + n in {2}", [False, True, False], id="expression in"),
        pytest.param("n // 2 == 1", [False, False, True], id="floor division"),
        pytest.param("x1 % 3 == 1", [False, True, True], id="modulo has the sign of the divisor"),
        pytest.param("-x1 > +1", [False, False, True], id="signs"),
        pytest.param("-2**2 == n - 4", [True, False, False], id="powers first"),
        pytest.param("not x1 > 0 and n < 2", [True, False, False], id="not, and"),
        pytest.param("x1 > 0 or n == 0 and x2 > 9", [False, True, False], id="and before or"),
        pytest.param("(x1 >= 0) & (n > 0) | (x2 == 5)", [False, True, True], id="& and |"),
        pytest.param("optimizer == 'adam'", [True, False, False], id="text"),
        pytest.param("'sgd' != optimizer", [True, False, True], id="text on the left"),
        pytest.param('optimizer in ["sgd", "it\'s"]', [False, True, True], id="texts"),
        pytest.param("optimizer == 'adam' or `learning-rate` < 0.25", [True, True, False], id="backticks"),
        pytest.param("`2nd` + `lambda` == 2", [False, False, True], id="names that Python does not have"),
        pytest.param("min(x1, n, 1) < max(x1, 0)", [False, False, True], id="min, max"),
        pytest.param("abs(x1) == 2 or sqrt(x2) == 2", [False, True, True], id="abs, sqrt"),
        pytest.param("exp(x1) > 2 and log2(x2) == 2 and log10(n) == 0", [False, True, False], id="exp, logs"),
        pytest.param("log(exp(n)) == n", [True, True, True], id="natural logarithm"),
        pytest.param("floor(x2 / 2) == 2 and ceil(x2 / 2) == 3", [False, False, True], id="floor, ceil"),
        pytest.param("round(x2 / 2) == 2", [True, True, True], id="round to even"),
        pytest.param("round(size + 0.2, 6) == 0.3", [True, False, False], id="round to digits"),
        pytest.param("1/x1 > -9", [False, True, True], id="division by zero"),
        pytest.param("1/x1 < 9", [False, True, True], id="division by zero the other way"),
        pytest.param("not 1/x1 < 9", [False, False, False], id="not a division by zero"),
        pytest.param("x1 == 0 or 1/x1 > 0", [True, True, False], id="division by zero where it does not matter"),
        pytest.param("1/(1/x1) == x1", [False, True, True], id="what is not finite stays so"),
        pytest.param("(1/x1)**0 == 1", [False, True, True], id="not to the power of zero either"),
        pytest.param("sqrt(x1) >= 0", [True, True, False], id="root of a negative number"),
        pytest.param("exp(1000 * x2) > 0", [False, False, False], id="overflow"),
        pytest.param("9**9**9**9 > x1", [False, False, False], id="huge powers cost nothing"),
        pytest.param("x1 in [1/n, 0]", [True, True, False], id="a list with a division by zero"),
        pytest.param(" x1\n <=\t0 ", [True, False, True], id="blanks"),
    ],
)
def test_a_constraint_holds_where_it_is_true(text: str, expected: list[bool]) -> None:
    assert holds(text) == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        pytest.param("x1 + x2", "column 1 of 'x1 [+] x2': it is a number, not a condition", id="number"),
        pytest.param("optimizer", "it is a text, not a condition", id="text"),
        pytest.param("3 < 4", "it speaks of no parameter", id="no parameter"),
        pytest.param("", "the expression has 0 characters", id="empty"),
        pytest.param("x1 <= 3 and optimiser == 1", "column 13 .*no parameter 'optimiser'(.|\n)*'optimizer'", id="name"),
        pytest.param("sqr(x1) < 1", "there is no function 'sqr'(.|\n)*Did you mean 'sqrt'", id="function name"),
        pytest.param("exp < 1", "there is no parameter 'exp'(.|\n)*is a function", id="function without call"),
        pytest.param("x1(2) < 1", "there is no function 'x1'", id="parameter as function"),
        pytest.param("learning-rate < 1", "Write `learning-rate` in backticks", id="hyphen"),
        pytest.param("2nd < 1", "Write `2nd` in backticks", id="digit first"),
        pytest.param("lambda < 1", "Write `lambda` in backticks", id="keyword"),
        pytest.param(
            "`learning-rat` < 1", "no parameter 'learning-rat'(.|\n)*Did you mean 'learning-rate'", id="quoted"
        ),
        pytest.param("x1 = 3", "this is no expression(.|\n)*Write '==' instead of '='", id="assignment"),
        pytest.param("x1 < 1 && x2 < 1", "Write 'and' instead of '&&'", id="ampersands"),
        pytest.param("x1 ^ 2 < 1", r"Powers are written \*\*", id="caret"),
        pytest.param("x1 > 0 & x2 < 3", "'0' is a number(.|\n)*bind more tightly", id="loose &"),
        pytest.param("x1 and x2 < 1", "'x1' is a number\n  allowed: a condition", id="number as condition"),
        pytest.param("(x1 < 1) + 2 < 3", "'x1 < 1' is a condition\n  allowed: a number", id="condition as number"),
        pytest.param("x1 < 'a'", "a number and a text are compared by <", id="number and text"),
        pytest.param("optimizer < 'sgd'", "a text and a text are compared by <", id="order of texts"),
        pytest.param("optimizer == 'adm'", "no value is 'adm'(.|\n)*Did you mean 'adam'", id="no such category"),
        pytest.param("optimizer in ['sgd', 'adm']", "column 22 .*no value is 'adm'", id="no such category in a list"),
        pytest.param("x1 in n", "'n' is no list of values", id="in a number"),
        pytest.param("x1 in []", "is no list of values", id="in nothing"),
        pytest.param("x1 is 1", "Write '=='", id="is"),
        pytest.param("abs(x1, x2) < 1", "'abs' is given 2 arguments\n  allowed: 1 number$", id="too many"),
        pytest.param("max(x1) < 1", "'max' is given 1 argument\n  allowed: 2 or more numbers", id="too few"),
        pytest.param("round(x1, 1, 2) < 1", "allowed: 1 or 2 numbers", id="one or two"),
        pytest.param("x1 < True", "'True' is no number", id="truth value"),
        pytest.param("x1 < 1e999", "'1e999' is no number", id="infinite"),
        pytest.param("x1 < 1j", "'1j' is no number", id="complex"),
        pytest.param("x1 < 1 # so", "column 8 .*no comments", id="comment"),
    ],
)
def test_what_is_no_constraint_is_refused_with_a_reason(text: str, message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        Constraint(text, PARAMETERS)


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os').system('true') == 0",
        "x1.__class__.__base__ == 1",
        "(lambda: x1)() < 1",
        "[x for x in (1, 2)] == 1",
        "{x: 1 for x in (1, 2)} == 1",
        "x1 if n else x2",
        "(y := x1) < 1",
        "f'{x1}' == 'a'",
        "abs(*[x1]) < 1",
        "abs(x=x1) < 1",
        "max(**{'a': 1}) < 1",
        "open('/etc/passwd') == 1",
        "eval('x1') < 1",
        "abs.__self__ == 1",
        "x1[0] < 1",
        "[x1][0] < 1",
        "await x1",
        "yield x1",
        "x1 < 1; import os",
        "x1 < 1\nimport os",
        "x1 @ x2 < 1",
        "x1 << 99999 < 1",
        "~n < 1",
        "b'a' == optimizer",
        "... < x1",
        "None == x1",
        "x1 < " + "9" * 400,
        "9" * 5000 + " < x1",
        "(" * 300 + "x1" + ")" * 300 + " < 1",
        "-" * 1900 + "x1 < 1",
        "not " * 400 + "x1 < 1",
        "x1 < 1" + " and x1 < 1" * 1000,
        "abs(" * 90 + "x1" + ")" * 90 + " < 1",
        "x1\x00 < 1",
        "é < 1",
        "`",
        "'",
    ],
    ids=lambda text: text[:25],
)
def test_what_could_harm_is_refused(text: str) -> None:
    with pytest.raises(ScenarioError):
        Constraint(text, PARAMETERS)


@given(st.text(alphabet="x1n2 +-*/%()<>=!&|,.'\"[]{}`#:;andorti_\\\n", max_size=60))
def test_any_text_is_a_constraint_or_a_scenario_error(text: str) -> None:
    try:
        values = holds(text)
    except ScenarioError:
        return
    assert len(values) == 3


def test_a_long_expression_is_shown_around_the_mistake() -> None:
    text = " and ".join(["x1 < 1"] * 30) + " and x9 < 1 and " + " and ".join(["x1 < 1"] * 30)
    with pytest.raises(ScenarioError) as caught:
        Constraint(text, PARAMETERS)
    assert "column 331 of '... " in caught.value.problem
    assert "x9 < 1 and x1 < 1" in caught.value.problem
    assert len(caught.value.problem) < 150


def test_it_knows_the_parameters_it_speaks_of() -> None:
    assert Constraint("x1 + `learning-rate` <= 1", PARAMETERS).names == {"x1", "learning-rate"}


def test_it_can_be_pickled() -> None:
    constraint = Constraint("x1 <= 0", PARAMETERS)
    again = pickle.loads(pickle.dumps(constraint))
    assert again == constraint
    assert again.holds(COLUMNS, 3).tolist() == [True, False, True]
