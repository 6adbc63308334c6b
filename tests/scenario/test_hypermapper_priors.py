"""HyperMapper's priors in our form, and that they are the densities it draws from."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors import PRIORS
from hypermap_lite.scenario.hypermapper import translate
from hypermap_lite.space import IntegerParameter, RealParameter
from tests.scenario.hypermapper_scenarios import (
    CATEGORICAL,
    INTEGER,
    ORDINAL,
    REAL,
    at,
    note_on,
    parameter,
    scenario,
    translated,
    write_rows,
)

SMALL_INTEGER = {"parameter_type": "integer", "values": [0, 3]}


def prior(entry: dict[str, Any], value: Any, **keys: Any) -> Any:
    return parameter(entry, prior=value, **keys).get("prior")


@pytest.mark.parametrize("entry", [REAL, INTEGER, ORDINAL], ids=["real", "integer", "ordinal"])
@pytest.mark.parametrize("shape", ["gaussian", "decay", "exponential"])
def test_named_priors_are_beta_shapes(entry: dict[str, Any], shape: str) -> None:
    assert prior(entry, shape) == {"type": "beta", "shape": shape}


@pytest.mark.parametrize("entry", [REAL, INTEGER, ORDINAL, CATEGORICAL], ids=lambda entry: entry["parameter_type"])
def test_uniform_is_no_prior(entry: dict[str, Any]) -> None:
    assert prior(entry, "uniform") is None


@pytest.mark.parametrize(
    ("entry", "numbers", "expected"),
    [
        (REAL, [1, 2, 3, 2, 1], {"type": "piecewise", "knots": [1, 2, 3, 2, 1]}),
        (REAL, [1], None),
        (SMALL_INTEGER, [0.1, 0.2, 0.3, 0.4], {"type": "weights", "weights": [0.1, 0.2, 0.3, 0.4]}),
        (ORDINAL, [0.1, 0.2, 0.3, 0.4], {"type": "weights", "weights": [0.1, 0.2, 0.3, 0.4]}),
        (CATEGORICAL, [0.5, 0.25, 0.25], {"type": "weights", "weights": [0.5, 0.25, 0.25]}),
    ],
)
def test_a_list_is_knots_or_a_probability_per_level(entry: dict[str, Any], numbers: list[float], expected: Any) -> None:
    assert prior(entry, numbers) == expected


def test_numbers_of_an_ordinal_are_those_of_its_sorted_levels() -> None:
    entry = parameter({"parameter_type": "ordinal", "values": [8, 1, 4]}, prior=[0.7, 0.2, 0.1])
    assert entry["values"] == [1, 4, 8]
    assert entry["prior"]["weights"] == [0.7, 0.2, 0.1]


def test_probabilities_that_do_not_sum_to_one_are_scaled() -> None:
    translation = translate(scenario(input_parameters={"p": {**SMALL_INTEGER, "prior": [1, 1, 1, 1]}}))
    assert "sum to 4" in note_on(translation, "input_parameters.p.prior")


def test_several_gaussians_are_a_mixture_of_equal_weights() -> None:
    own = {"custom_gaussian_prior_means": [0, 5], "custom_gaussian_prior_stds": [1, -1]}
    components = [{"mean": 0, "std": 1}, {"mean": 5, "std": 7.5}]
    assert prior(REAL, "custom_gaussian", **own) == {"type": "mixture", "components": components}


def test_gaussians_for_all_have_a_number_per_parameter() -> None:
    entries = {"u": REAL, "p": {**REAL, "prior": "custom_gaussian"}, "n": {**INTEGER, "prior": "custom_gaussian"}}
    document = translated(
        input_parameters=entries, custom_gaussian_prior_means=[0, 1, 2], custom_gaussian_prior_stds=[1, -1, 3]
    )
    assert at(document, "input_parameters.p.prior") == {"type": "gaussian", "mean": 1, "std": 7.5}
    assert at(document, "input_parameters.n.prior") == {"type": "gaussian", "mean": 2, "std": 3}


def test_what_is_said_of_several_parameters_is_one_line() -> None:
    entries = {name: {**REAL, "prior": "custom_gaussian"} for name in "abc"}
    (line,) = translate(scenario(input_parameters=entries)).brief()
    assert line.startswith("input_parameters.a.prior, input_parameters.b.prior, input_parameters.c.prior: cut off")


def test_the_gaussian_of_version_3_has_parameters() -> None:
    assert prior(REAL, "gaussian", prior_parameters=[3, 0.5]) == {"type": "gaussian", "mean": 3, "std": 0.5}


@pytest.mark.parametrize(
    ("entry", "keys", "path", "says"),
    [
        pytest.param(REAL, {"prior": "gausian"}, "p.prior", "Did you mean 'gaussian'", id="slip"),
        pytest.param(CATEGORICAL, {"prior": "decay"}, "p.prior", "a categorical parameter has no decay", id="category"),
        pytest.param(ORDINAL, {"prior": "custom_gaussian"}, "p.prior", "Give it a list", id="ordinal gaussian"),
        pytest.param(SMALL_INTEGER, {"prior": [1, 2]}, "p.prior", "2 numbers for the 4 values", id="too few"),
        pytest.param(REAL, {"prior": [1, -1]}, "p.prior", "the list has -1 in it", id="negative"),
        pytest.param(REAL, {"prior": [0, 0]}, "p.prior", "all zero", id="zero"),
        pytest.param(
            REAL,
            {
                "prior": "custom_gaussian",
                "custom_gaussian_prior_means": [1, 2],
                "custom_gaussian_prior_stds": [1, 2, 3],
            },
            "p.custom_gaussian_prior_stds",
            "2 means and 3 standard deviations",
            id="lengths",
        ),
        pytest.param(
            REAL,
            {"prior": "custom_gaussian", "custom_gaussian_prior_stds": [0]},
            "p.custom_gaussian_prior_stds",
            "-1 for half the range",
            id="no width",
        ),
    ],
)
def test_a_mistake_is_named_where_it_stands(entry: dict[str, Any], keys: dict[str, Any], path: str, says: str) -> None:
    with pytest.raises(ScenarioError, match=says) as caught:
        parameter(entry, **keys)
    assert caught.value.path == f"$.input_parameters.{path}"


def test_only_those_that_ask_are_estimated_each_by_itself() -> None:
    entries = {
        "p": {**REAL, "prior": "estimate"},
        "q": {**REAL, "prior": "decay"},
        "n": {**INTEGER, "prior": "estimate"},
    }
    (estimate,) = translated(input_parameters=entries)["priors"]
    assert estimate == {
        "type": "kde",
        "file": "samples.csv",
        "rows": "best",
        "quantile": 0.1,
        "independent": True,
        "parameters": ["p", "n"],
    }


def test_a_joint_estimate_takes_the_place_of_the_real_parameters_priors() -> None:
    entries = {"p": {**REAL, "prior": "decay"}, "q": REAL, "n": {**INTEGER, "prior": "decay"}}
    document = translated(input_parameters=entries, estimate_multivariate_priors=True)
    assert document["priors"][0]["parameters"] == ["p", "q"]
    assert not document["priors"][0]["independent"]
    assert "prior" not in document["input_parameters"]["p"]
    assert "prior" in document["input_parameters"]["n"]


def test_a_bandwidth_of_the_file_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_rows(tmp_path, "samples.csv", 80)
    entries = {"x1": {**REAL, "prior": "estimate"}}
    document = translated(input_parameters=entries, bandwidth_n_factor=2, bandwidth_parameter=3)
    n = 8  # a tenth of 80 rows; HyperMapper's factor over Scott's
    assert document["priors"][0]["bandwidth_factor"] == pytest.approx((2 * n) ** (-1 / 4) / n ** (-1 / 5))


@pytest.mark.parametrize("objectives", [["a"], ["a", "b"]])
def test_a_prior_weights_the_acquisition_with_any_number_of_objectives(objectives: list[str]) -> None:
    translation = translate(
        scenario(optimization_objectives=objectives, input_parameters={"p": {**REAL, "prior": "decay"}})
    )
    assert at(translation.document, "acquisition.prior_weighting.method") == "pibo"
    assert at(translation.document, "design_of_experiment.type") == "prior_sampling"
    assert bool(note_on(translation, "input_parameters")) == (len(objectives) > 1)


def masses_of(entry: dict[str, Any], n: int) -> np.ndarray:
    options = dict(entry["prior"])
    parameter = IntegerParameter(name="p", low=entry["values"][0], high=entry["values"][1])
    density = PRIORS[options.pop("type")](**options).on(parameter)
    return np.exp(density.log_density((np.arange(n) + 0.5) / n)) / n


def test_an_integers_named_prior_has_the_masses_that_hypermapper_samples() -> None:
    # equal bins of the beta distribution: gaussian on four values, from its distribution function
    assert masses_of(parameter(SMALL_INTEGER, prior="gaussian"), 4) == pytest.approx(
        [0.104, 0.396, 0.396, 0.104], abs=1e-3
    )


def test_a_translated_custom_gaussian_integrates_to_one() -> None:
    options = dict(prior(REAL, "custom_gaussian", custom_gaussian_prior_means=[-5], custom_gaussian_prior_stds=[1]))
    density = PRIORS[options.pop("type")](**options).on(RealParameter(name="p", low=-5, high=10))
    u = np.linspace(0, 1, 20001)
    assert np.trapezoid(np.exp(density.log_density(u)), u) == pytest.approx(1, abs=1e-4)
