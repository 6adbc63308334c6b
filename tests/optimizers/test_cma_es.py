"""CMA-ES on the black box."""

import sys

import numpy as np
import pytest

from hypermap_lite.assembly import build_optimizer, validate
from hypermap_lite.errors import ScenarioError
from hypermap_lite.maximizers.evolution_strategy import EvolutionStrategy
from hypermap_lite.optimizers import CmaEs, cma_es
from hypermap_lite.optimizers.cma_es import finite
from hypermap_lite.scenario.loader import load_scenario
from tests.optimizers.problems import MIXED, ORDERED, mixed
from tests.optimizers.runs import configurations, evaluate, fail, run, scenario_of

SPHERE = {f"x{i}": {"parameter_type": "real", "values": [-1, 1]} for i in range(4)}


def sphere(c: dict) -> dict[str, float]:
    return {"y": sum((v - 0.3) ** 2 for v in c.values())}


def test_it_converges_on_a_sphere() -> None:
    scenario = scenario_of(input_parameters=SPHERE, objectives=[{"name": "y"}], optimizer="cma_es")
    optimizer = run(scenario, 120, batch=8, function=sphere)
    values = [e.values["y"] for e in optimizer.history]
    assert np.median(values[-16:]) < 0.1 * np.median(values[5:21])
    assert {e.suggestion.phase for e in list(optimizer.history)[8:]} == {"cma_es"}


def test_integers_and_ordinals_are_rounded_and_never_repeated() -> None:
    optimizer = run({**ORDERED, "optimizer": "cma_es"}, 60, function=mixed)
    assert len({tuple(c.items()) for c in configurations(optimizer)}) == 60
    assert min(e.values["y"] for e in optimizer.history) < 0.05


def test_a_batch_larger_than_a_generation_resumes_as_it_ran() -> None:
    scenario = scenario_of(optimizer="cma_es")
    whole = run(scenario, 50, batch=15)
    again = build_optimizer(load_scenario(scenario), whole.history)
    assert [s.configuration for s in again.ask(15)] == [s.configuration for s in whole.ask(15)]


def test_one_parameter_is_enough() -> None:
    scenario = scenario_of(input_parameters={"x": SPHERE["x0"]}, objectives=[{"name": "y"}], optimizer="cma_es")
    assert min(e.values["y"] for e in run(scenario, 40, function=sphere).history) < 1e-3


def test_when_it_has_converged_it_starts_again_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cma_es, "CONVERGED", 0.02)
    scenario = scenario_of(input_parameters={"x": SPHERE["x0"]}, objectives=[{"name": "y"}], optimizer="cma_es")
    late = configurations(run(scenario, 100, batch=10, function=sphere))[50:]
    assert np.ptp([c["x"] for c in late]) > 0.2


def test_objectives_that_never_change_and_failures_are_no_trouble() -> None:
    optimizer = build_optimizer(load_scenario(scenario_of(optimizer="cma_es")))
    while len(optimizer.history) < 40:
        suggestions = optimizer.ask(5)
        optimizer.tell(
            [fail(s) if s.trial % 3 else evaluate(s, lambda c: {"near": 1.0, "far": 1.0}) for s in suggestions]
        )
    assert len(optimizer.history) == 40


def test_what_is_not_usable_is_worse_than_all_else() -> None:
    fitness = np.array([3.0, np.inf, -1.0])
    assert finite(fitness, np.array([0, 1])).tolist() == [3.0, 8.0]


def test_categories_are_refused_with_another_way() -> None:
    with pytest.raises(ScenarioError, match=r"\$\.optimizer\.type: 'c' has no order(.|\n)*evolutionary"):
        validate(load_scenario({**MIXED, "optimizer": "cma_es"}))


def test_a_missing_package_is_named_with_its_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cma", None)
    for section in ("optimizer", "maximizer"):
        message = rf"\$\.{section}\.type: it needs the package cma(.|\n)*hypermap-lite\[cma\]"
        with pytest.raises(ScenarioError, match=message):
            validate(load_scenario(scenario_of(**{section: "cma_es"})))


@pytest.mark.parametrize("options", [{"sigma": 0}, {"weights": [0.0]}])
def test_impossible_options_are_refused(options: dict) -> None:
    with pytest.raises(ScenarioError, match=next(iter(options))):
        CmaEs(**options)


@pytest.mark.parametrize("smallest", [None, 0.01])
@pytest.mark.parametrize("seed", range(3))
def test_a_single_axis_may_have_its_optimum_at_a_bound(seed: int, smallest: float | None) -> None:
    steps = None if smallest is None else np.array([smallest])
    strategy = EvolutionStrategy(np.array([0.3]), 0.2, np.random.default_rng(seed), smallest_steps=steps)
    for _ in range(30):
        X = strategy.ask(strategy.population)
        strategy.tell(X, (X[:, 0] - 1.0) ** 2)
    assert X.max() > 0.98


def test_it_starts_from_the_same_point_all_along_though_the_design_gave_nothing() -> None:
    optimizer = build_optimizer(load_scenario(scenario_of(optimizer="cma_es") | {"budget": {"evaluations": 40}}))
    starts = []
    while len(optimizer.history) < 40:
        (suggestion,) = optimizer.ask()
        optimizer.tell([fail(suggestion) if suggestion.trial < 7 else evaluate(suggestion)])
        state = optimizer._state(len(optimizer.history))
        if "cma_es" in state.phases:
            starts.append(optimizer._search._start(state, state.fitness(state.Y)).tolist())
    assert len(starts) > 20
    assert all(start == starts[0] for start in starts)
