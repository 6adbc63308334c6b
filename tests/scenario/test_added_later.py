"""Options that older scenarios did not have."""

import json
from collections.abc import Mapping
from typing import Any

import pytest

from hypermap_lite.history.added_later import ADDED_LATER
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.recorded import with_old_defaults

SCENARIO: dict[str, Any] = {
    "input_parameters": {"x": {"parameter_type": "real", "values": [0, 1]}},
    "objectives": [{"name": "f"}, {"name": "g"}],
}


def as_in_a_run_folder(canonical: Mapping[str, Any]) -> dict[str, Any]:
    return {**json.loads(json.dumps(canonical)), "versions": {"hypermap_lite": "0.1.0"}}


def recorded(**changes: object) -> dict[str, Any]:
    """Return the effective scenario as a run folder holds it, without the options that came later."""
    document = json.loads(json.dumps(load_scenario({**SCENARIO, **changes}).canonical)) | {
        "versions": {"hypermap_lite": "0.1.0"}
    }
    for place in ADDED_LATER:
        *names, option = place.removeprefix("$.").split(".")
        section = document
        for name in names:
            section = section.get(name, {})
        if option != "method":
            section.pop(option, None)
    return document


def test_a_recorded_scenario_keeps_its_method() -> None:
    scenario = load_scenario(recorded())
    assert scenario.surrogate.options["restart"] is True
    assert scenario.surrogate.options["lengthscale_location"] == pytest.approx(2**0.5)
    assert scenario.surrogate.options["noise_floor"] == 1e-6
    assert scenario.acquisition.function.options["screening"] == 0
    assert scenario.acquisition.feasibility_weighting is not None
    assert scenario.acquisition.feasibility_weighting.options["exponent"] == 1


def test_a_section_that_came_later_is_as_it_was() -> None:
    document = recorded()
    del document["acquisition"]["feasibility_weighting"]
    weighting = load_scenario(document).acquisition.feasibility_weighting
    assert weighting is not None
    assert (weighting.type, weighting.options["exponent"]) == ("probability", 1)


def test_members_without_the_option_do_not_get_it() -> None:
    document = with_old_defaults(
        recorded(surrogate={"type": "random_forest"}, acquisition={"type": "thompson_sampling"})
    )
    assert "restart" not in document["surrogate"]
    assert "screening" not in document["acquisition"]


def test_what_a_run_has_recorded_stays() -> None:
    canonical = load_scenario({**SCENARIO, "surrogate": {"noise_floor": 1e-3}}).canonical
    document = as_in_a_run_folder(canonical)
    assert with_old_defaults(document) == document


def test_a_users_own_scenario_gets_todays_defaults() -> None:
    assert with_old_defaults(SCENARIO) == SCENARIO
    assert load_scenario(SCENARIO).surrogate.options["restart"] is False


def test_every_option_still_exists() -> None:
    acquisition = {"scalarization": "tchebyshev"}  # for the options of its weights
    parameters = {"x": {**SCENARIO["input_parameters"]["x"], "prior": {"type": "gaussian", "mean": 0.5, "std": 0.1}}}
    canonical = load_scenario({**SCENARIO, "input_parameters": parameters, "acquisition": acquisition}).canonical
    for place in ADDED_LATER:
        *names, option = place.removeprefix("$.").split(".")
        section = canonical
        for name in names:
            section = section[name]
        assert option in section, place
