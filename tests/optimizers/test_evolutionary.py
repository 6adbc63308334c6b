"""Evolution."""

from collections import Counter

import numpy as np
import pytest

from hypermap_lite.assembly import build_optimizer
from hypermap_lite.errors import ScenarioError
from hypermap_lite.optimizers import Evolution
from hypermap_lite.optimizers.evolutionary import best_first
from hypermap_lite.pareto.hypervolume import hypervolume
from hypermap_lite.scenario.loader import load_scenario
from tests.optimizers.problems import MIXED, mixed
from tests.optimizers.runs import configurations, evaluate, fail, run, scenario_of


def evolution(**options: object) -> dict:
    return {"type": "evolutionary", "population_size": 8, "tournament_size": 3, **options}


def state_of(optimizer):
    return optimizer._state(len(optimizer.history))


def test_the_first_population_is_the_design() -> None:
    optimizer = run({**MIXED, "optimizer": evolution()}, 12, function=mixed)
    assert [e.suggestion.phase for e in optimizer.history] == ["design"] * 8 + ["evolution"] * 4


def test_a_regularized_population_is_the_latest_evaluations() -> None:
    optimizer = run({**MIXED, "optimizer": evolution(regularized=True)}, 30, function=mixed)
    assert optimizer._search.population(state_of(optimizer)).tolist() == list(range(22, 30))


def test_otherwise_the_best_ever_stays_alive() -> None:
    optimizer = run({**MIXED, "optimizer": evolution()}, 40, function=mixed)
    members = optimizer._search.population(state_of(optimizer))
    values = [e.values["y"] for e in optimizer.history]
    assert len(members) == 8
    assert int(np.argmin(values)) in members
    assert np.mean([values[i] for i in members]) < np.mean(values)


@pytest.mark.parametrize("rate", [1, 2, 3])
def test_a_mutation_changes_so_many_parameters(rate: int) -> None:
    optimizer = run({**MIXED, "optimizer": evolution(mutation_rate=rate)}, 8, function=mixed)
    state = state_of(optimizer)
    parent = state.X[0]
    space = state.space
    for seed in range(40):
        child = space.snap(optimizer._search.mutated(parent, state, np.random.default_rng(seed))[None])[0]
        assert (child != parent).sum() == rate


def test_crossover_mixes_two_parents() -> None:
    parameters = {f"p{i}": {"parameter_type": "integer", "values": [0, 9]} for i in range(6)}
    scenario = scenario_of(
        input_parameters=parameters,
        objectives=[{"name": "y"}],
        optimizer=evolution(population_size=2, tournament_size=2, crossover=True),
        design_of_experiment={"number_of_samples": 2},
    )
    optimizer = run(scenario, 2, function=lambda c: {"y": sum(c.values())})
    (first, second), (child,) = configurations(optimizer), [s.configuration for s in optimizer.ask()]
    inherited = Counter(
        "both" if first[k] == second[k] == v else "first" if v == first[k] else "second" if v == second[k] else "new"
        for k, v in child.items()
    )
    assert inherited["new"] <= 1
    assert inherited["first"] >= 1
    assert inherited["second"] >= 1


def test_several_objectives_are_sorted_by_front_and_loneliness() -> None:
    Y = np.array([[2.0, 2.0], [0.0, 1.0], [0.4, 0.6], [0.5, 0.5], [1.0, 0.0], [np.inf, np.inf]])
    order = best_first(Y)
    assert set(order[:2]) == {1, 4}
    assert order[4:].tolist() == [0, 5]


def test_several_objectives_evolve_along_the_front() -> None:
    def volume(kind: object) -> float:
        runs = [run(scenario_of(optimizer=kind, seed=seed, budget={"evaluations": 50}), 50) for seed in range(5)]
        return float(np.median([hypervolume(r.history.Y(), np.array([0.6, 0.6])) for r in runs]))

    assert volume(evolution()) > volume("random_search")


def test_failures_are_the_worst_and_die_first() -> None:
    optimizer = build_optimizer(load_scenario({**MIXED, "optimizer": evolution()}))
    while len(optimizer.history) < 40:
        optimizer.tell([fail(s) if s.trial % 2 else evaluate(s, mixed) for s in optimizer.ask(2)])
    members = optimizer._search.population(state_of(optimizer))
    assert sum(i % 2 for i in members) <= 2


def test_a_mutation_of_more_parameters_than_there_are_is_refused() -> None:
    with pytest.raises(ScenarioError, match=r"\$\.optimizer\.mutation_rate: a mutation changes 5 parameters"):
        build_optimizer(load_scenario({**MIXED, "optimizer": evolution(mutation_rate=5)}))


@pytest.mark.parametrize(
    "options", [{"population_size": 1}, {"tournament_size": 1}, {"tournament_size": 99}, {"mutation_rate": 0}]
)
def test_impossible_options_are_refused(options: dict) -> None:
    with pytest.raises(ScenarioError, match=next(iter(options))):
        Evolution(**options)
