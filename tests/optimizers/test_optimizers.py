"""What holds for every optimizer."""

from dataclasses import replace

import pytest

from hypermap_lite.assembly import build_optimizer
from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.outcome import Suggestion
from hypermap_lite.optimizers import OPTIMIZERS
from hypermap_lite.scenario.loader import load_scenario
from tests.optimizers.runs import configurations, evaluate, fail, resumed, run, scenario_of

SMALL = {
    "local_search": {"type": "local_search", "random_points": 5},
    "evolutionary": {"type": "evolutionary", "population_size": 5, "tournament_size": 3},
}
"""Options with which the search itself begins within a few trials."""

every_optimizer = pytest.mark.parametrize("kind", [pytest.param(SMALL.get(kind, kind), id=kind) for kind in OPTIMIZERS])
FINITE = {
    "n": {"parameter_type": "integer", "values": [0, 2]},
    "c": {"parameter_type": "categorical", "values": ["1", "2", "4"]},
}
FINITE_ORDERED = FINITE | {"c": {"parameter_type": "ordinal", "values": [1, 2, 4]}}


def finite_values(configuration: dict) -> dict[str, float]:
    return {"near": float(configuration["n"]), "far": float(configuration["c"])}


@every_optimizer
@pytest.mark.parametrize("batch", [1, 3])
def test_a_resumed_run_goes_on_as_the_uninterrupted_one(kind: str, batch: int) -> None:
    scenario = scenario_of(optimizer=kind)
    whole = run(scenario, 12, batch=batch)
    for stop in (0, 3, 6, 9):
        again = resumed(scenario, list(whole.history)[:stop])
        suggestions = again.ask(batch)
        assert [s.configuration for s in suggestions] == configurations(whole)[stop : stop + batch]
        assert [s.acquisition_value for s in suggestions] == [
            e.suggestion.acquisition_value for e in list(whole.history)[stop : stop + batch]
        ]


@every_optimizer
def test_the_same_seed_gives_the_same_run_and_another_seed_another(kind: str) -> None:
    scenario = scenario_of(optimizer=kind)
    assert configurations(run(scenario, 8)) == configurations(run(scenario, 8))
    assert configurations(run(scenario, 8)) != configurations(run(scenario | {"seed": 4}, 8))


@every_optimizer
def test_asking_one_at_a_time_or_together_is_the_same(kind: str) -> None:
    scenario = scenario_of(optimizer=kind)
    done = list(run(scenario, 6).history)
    together = resumed(scenario, done).ask(3)
    one_by_one = resumed(scenario, done)
    assert [one_by_one.ask()[0].configuration for _ in range(3)] == [s.configuration for s in together]


@every_optimizer
def test_a_batch_holds_different_configurations(kind: str) -> None:
    optimizer = run(scenario_of(optimizer=kind), 6)
    points = [tuple(s.configuration.values()) for s in optimizer.ask(5)]
    assert len(set(points)) == 5


@every_optimizer
def test_a_finite_space_ends_gracefully(kind: str) -> None:
    parameters = FINITE_ORDERED if kind == "cma_es" else FINITE
    scenario = scenario_of(optimizer=kind, input_parameters=parameters, budget={"evaluations": 50})
    optimizer = run(scenario, 50, batch=4, function=finite_values)
    assert len({tuple(c.items()) for c in configurations(optimizer)}) == len(optimizer.history) == 9
    assert optimizer.ask(2) == []


@every_optimizer
def test_a_narrow_prior_does_not_exhaust_a_large_space(kind: str) -> None:
    narrow = {"type": "gaussian", "mean": 5, "std": 0.3}
    parameters = {"n": {"parameter_type": "integer", "values": [0, 1_000_000], "prior": narrow}}
    scenario = scenario_of(optimizer=kind, input_parameters=parameters)
    optimizer = run(scenario, 12, function=lambda c: {"near": abs(c["n"] - 7), "far": -abs(c["n"] - 3)})
    assert len({c["n"] for c in configurations(optimizer)}) == 12


@every_optimizer
def test_a_complete_default_comes_first(kind: str) -> None:
    parameters = {
        "a": {"parameter_type": "real", "values": [0, 1], "parameter_default": 0.25},
        "b": {"parameter_type": "real", "values": [-5, 5], "parameter_default": 1},
    }
    suggestions = build_optimizer(load_scenario(scenario_of(optimizer=kind, input_parameters=parameters))).ask(5)
    assert suggestions[0].configuration == {"a": 0.25, "b": 1}
    assert [s.phase for s in suggestions] == ["default", "design", "design", "design", "design"]


@every_optimizer
def test_failed_evaluations_never_stop_the_suggestions(kind: str) -> None:
    optimizer = build_optimizer(load_scenario(scenario_of(optimizer=kind)))
    for i in range(12):
        (suggestion,) = optimizer.ask()
        optimizer.tell([fail(suggestion) if i < 7 or i % 2 else evaluate(suggestion)])
    assert len(optimizer.history) == 12


@every_optimizer
def test_evaluations_told_out_of_order_wait_for_the_earlier_ones(kind: str) -> None:
    scenario = scenario_of(optimizer=kind)
    optimizer = resumed(scenario, list(run(scenario, 6).history))
    first, second, third = optimizer.ask(3)
    optimizer.tell([evaluate(third)])
    assert [s.trial for s in optimizer.pending] == [6, 7]
    assert [s.trial for s in optimizer.in_flight] == [6, 7, 8]
    assert len(optimizer.history) == 6
    optimizer.tell([evaluate(first), evaluate(second)])
    assert len(optimizer.history) == 9
    assert optimizer.pending == []


@every_optimizer
def test_telling_what_was_not_asked_names_what_is_pending(kind: str) -> None:
    optimizer = build_optimizer(load_scenario(scenario_of(optimizer=kind)))
    (suggestion,) = optimizer.ask()
    optimizer.tell([evaluate(suggestion)])
    with pytest.raises(UsageError, match=r"trial 0 is not pending \(pending: none; call ask\(\) first\)"):
        optimizer.tell([evaluate(suggestion)])


@every_optimizer
def test_a_list_with_a_mistake_tells_nothing(kind: str) -> None:
    optimizer = build_optimizer(load_scenario(scenario_of(optimizer=kind)))
    good = evaluate(optimizer.ask()[0])
    bad = evaluate(Suggestion(trial=9, configuration=good.configuration, phase="design"))
    for mistake in ([good, bad], [good, good]):
        with pytest.raises(UsageError, match=r"trial 9 is not pending|trial 0 is told twice"):
            optimizer.tell(mistake)
        assert [s.trial for s in optimizer.pending] == [0]
    optimizer.tell([good])
    assert len(optimizer.history) == 1


@every_optimizer
def test_only_pending_suggestions_can_be_adopted(kind: str) -> None:
    optimizer = build_optimizer(load_scenario(scenario_of(optimizer=kind)))
    (suggestion,) = optimizer.ask()
    optimizer.adopt(suggestion)
    optimizer.tell([evaluate(suggestion)])
    with pytest.raises(UsageError, match="adopt: trial 0 is not pending"):
        optimizer.adopt(suggestion)


def test_an_ask_that_is_interrupted_leaves_nothing_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    optimizer = build_optimizer(load_scenario(scenario_of(optimizer="random_search")))
    suggest = optimizer._suggest

    def interrupted(trial: int) -> Suggestion | None:
        if trial == 2:
            raise KeyboardInterrupt
        return suggest(trial)

    monkeypatch.setattr(optimizer, "_suggest", interrupted)
    with pytest.raises(KeyboardInterrupt):
        optimizer.ask(3)
    assert optimizer.pending == []
    assert optimizer.ask(2)[0].trial == 0


@every_optimizer
def test_asking_for_nothing_is_an_error(kind: str) -> None:
    with pytest.raises(UsageError, match="at least 1"):
        build_optimizer(load_scenario(scenario_of(optimizer=kind))).ask(0)


@pytest.mark.parametrize("asynchronous", [False, True])
def test_a_result_that_does_not_fit_leaves_everything_pending(asynchronous: bool) -> None:
    optimizer = build_optimizer(load_scenario(scenario_of(budget={"asynchronous": asynchronous})))
    good, bad = (evaluate(suggestion) for suggestion in optimizer.ask(2))
    with pytest.raises(UsageError, match="trial 1 has no value of the objective 'far'"):
        optimizer.tell([good, replace(bad, values={"near": 1.0})])
    assert len(optimizer.history) == 0
    assert [s.trial for s in optimizer.pending] == [0, 1]
    optimizer.tell([good, bad])
    assert [e.trial for e in optimizer.history] == [0, 1]
