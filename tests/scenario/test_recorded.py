"""Tests for recorded.py."""

import copy
from typing import Any

from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.recorded import with_old_defaults
from tests.scenario.bad_scenarios import GOOD

PRIORS = [{"type": "mixture", "components": [{"mean": {"x": 1}, "std": {"x": 2}}]}]
VERSIONS = {"hypermap_lite": "0.1.0"}
NEW = {"prior_weighting": ("make_up", "prior_free", "safeguard"), "weights": ("ends", "redraws")}


def old(**changes: Any) -> dict[str, Any]:
    """Return the scenario of a run folder that knew nothing of later options."""
    document = copy.deepcopy(dict(load_scenario(copy.deepcopy(GOOD) | {"priors": PRIORS} | changes).canonical))
    for section, keys in NEW.items():
        for key in keys:
            document["acquisition"][section].pop(key, None)
    document["design_of_experiment"].pop("uniform_share", None)
    return document


def test_a_recorded_scenario_goes_on_as_before_there_was_a_choice() -> None:
    scenario = load_scenario(old() | {"versions": VERSIONS})
    weighting = scenario.acquisition.prior_weighting
    assert weighting is not None
    assert (weighting.options["prior_free"], weighting.options["safeguard"]) == (0, False)
    assert scenario.design.options == {"uniform_share": 0}


def test_a_scenario_that_nobody_recorded_gets_the_defaults_of_today() -> None:
    weighting = load_scenario(old()).acquisition.prior_weighting
    assert weighting is not None
    assert (weighting.options["prior_free"], weighting.options["safeguard"]) == (0.25, True)


def test_what_a_recorded_scenario_says_stays() -> None:
    document = old() | {"versions": VERSIONS}
    document["acquisition"]["prior_weighting"] |= {"prior_free": 0.5}
    assert with_old_defaults(document)["acquisition"]["prior_weighting"]["prior_free"] == 0.5


def test_options_of_other_kinds_are_not_added() -> None:
    document = old(acquisition={"prior_weighting": "none"}, design_of_experiment="grid") | {"versions": VERSIONS}
    recorded = with_old_defaults(document)
    assert recorded["acquisition"]["prior_weighting"] == {"method": "none"}
    assert "uniform_share" not in recorded["design_of_experiment"]


def test_a_section_that_is_no_object_is_left_alone_and_a_missing_one_is_as_it_was() -> None:
    document = with_old_defaults({"versions": VERSIONS, "acquisition": "expected_improvement"})
    assert document["acquisition"] == "expected_improvement"
    assert document["surrogate"]["restart"] is True
