"""Local search on the black box."""

import numpy as np
import pytest

from hypermap_lite.assembly import build_optimizer
from hypermap_lite.errors import ScenarioError
from hypermap_lite.evaluation.outcome import Evaluation, State
from hypermap_lite.optimizers import HillClimbing
from hypermap_lite.scenario.loader import load_scenario
from tests.optimizers.problems import BRANIN, MIXED, mixed
from tests.optimizers.runs import configurations, evaluate, fail, run, scenario_of, two_objectives

LINE = {"n": {"parameter_type": "integer", "values": [0, 15]}}


def search(**options: object) -> dict:
    return {"type": "local_search", **options}


def on_a_line(values: dict[int, float], **options: object):
    """Return the run over the integers 0 to 15 with given values, all others 9, and 1 first point."""
    scenario = scenario_of(
        input_parameters={"n": {**LINE["n"], "parameter_default": 8}},
        objectives=[{"name": "y"}],
        optimizer=search(random_points=1, **options),
        design_of_experiment={"number_of_samples": 1},
    )
    return run(scenario, 16, function=lambda c: {"y": values.get(c["n"], 9.0)})


@pytest.mark.parametrize(
    ("scale", "bounds", "seed"),
    [("linear", [(0.1, 1 / 3), (1e-5, 0.7), (3, 71)], 8), ("log", [(0.05, 2), (0.25, 1.3), (2, 15)], 16)],
)
def test_no_point_is_climbed_to_twice_however_its_digits_are_rounded(scale: str, bounds: list, seed: int) -> None:
    parameters = {
        f"x{j}": {"parameter_type": "real", "values": list(pair), "scale": scale} for j, pair in enumerate(bounds)
    }

    def bowl(configuration):
        shares = [(configuration[f"x{j}"] - low) / (high - low) for j, (low, high) in enumerate(bounds)]
        return {"f": sum((share - 0.6) ** 2 for share in shares)}

    scenario = {"input_parameters": parameters, "objectives": [{"name": "f"}], "optimizer": search(), "seed": seed}
    history = run({**scenario, "budget": {"evaluations": 80}}, 80, function=bowl).history
    assert len({tuple(e.configuration.values()) for e in history}) == 80


def test_the_first_points_are_the_random_points() -> None:
    phases = [
        e.suggestion.phase
        for e in run({**BRANIN, "optimizer": search(random_points=7)}, 9, function=branin_like).history
    ]
    assert phases == ["design"] * 7 + ["climb"] * 2
    design = {"number_of_samples": 4}
    fewer = run(
        {**BRANIN, "optimizer": search(random_points=7), "design_of_experiment": design}, 9, function=branin_like
    )
    assert [e.suggestion.phase for e in fewer.history] == ["design"] * 4 + ["random"] * 3 + ["climb"] * 2


def branin_like(c: dict) -> dict[str, float]:
    return {"y": (c["x1"] - 3) ** 2 + (c["x2"] - 2) ** 2}


def test_best_improvement_tries_every_neighbour_before_it_moves() -> None:
    tried = [c["n"] for c in configurations(on_a_line({8: 5.0, 3: 1.0}, improvement="best"))]
    assert sorted(tried) == list(range(16))
    assert tried[0] == 8


def test_climbing_reaches_the_best_level_and_repeats_no_evaluation() -> None:
    optimizer = run({**MIXED, "optimizer": search()}, 60, function=mixed)
    assert min(e.values["y"] for e in optimizer.history) < 0.01
    assert len({tuple(c.items()) for c in configurations(optimizer)}) == 60


def test_a_local_optimum_sends_it_to_the_next_best_of_the_first_points() -> None:
    parameters = {"a": {"parameter_type": "ordinal", "values": list(range(40))}}
    peaks = {5: 0.0, 30: 0.5}

    def two_wells(c: dict) -> dict[str, float]:
        return {"y": min(level + abs(c["a"] - place) for place, level in peaks.items())}

    scenario = scenario_of(input_parameters=parameters, objectives=[{"name": "y"}], optimizer=search(random_points=4))
    tried = {c["a"] for c in configurations(run(scenario, 36, function=two_wells))}
    assert {5, 30} <= tried


def test_failures_and_infeasible_points_are_never_climbed_from() -> None:
    optimizer = build_optimizer(load_scenario({**BRANIN, "optimizer": search(random_points=6)}))
    while len(optimizer.history) < 40:
        (suggestion,) = optimizer.ask()
        c = suggestion.configuration
        if c["x1"] > 4:
            optimizer.tell([Evaluation(suggestion=suggestion, state=State.INFEASIBLE)])
        elif suggestion.trial % 7 == 0:
            optimizer.tell([fail(suggestion)])
        else:
            optimizer.tell([evaluate(suggestion, lambda c: {"y": -c["x1"] + abs(c["x2"] - 3)})])
    best = min((e for e in optimizer.history.completed), key=lambda e: e.values["y"])
    assert best.configuration["x1"] > 3.5


def test_nothing_but_failures_is_answered_with_draws() -> None:
    optimizer = build_optimizer(load_scenario({**BRANIN, "optimizer": search(random_points=3)}))
    for _ in range(8):
        optimizer.tell([fail(s) for s in optimizer.ask()])
    assert [e.suggestion.phase for e in optimizer.history] == ["design"] * 3 + ["random"] * 5


def test_weights_choose_the_trade_off() -> None:
    near, far = (
        run(scenario_of(optimizer=search(random_points=5, weights=weights)), 60).history for weights in ([1, 0], [0, 3])
    )
    assert min(e.values["near"] for e in near) < 1e-3
    assert max(e.values["far"] for e in far) > -1e-3
    assert min(two_objectives(c)["near"] for c in (e.configuration for e in far)) > 1e-3


def test_weights_must_fit_the_objectives() -> None:
    with pytest.raises(ScenarioError, match=r"\$\.optimizer\.weights: there are 3 weights for 2 objectives"):
        build_optimizer(load_scenario(scenario_of(optimizer=search(weights=[1, 1, 2]))))


def test_a_batch_is_of_different_neighbours() -> None:
    optimizer = run({**BRANIN, "optimizer": search(random_points=5)}, 12, batch=4, function=branin_like)
    batch = optimizer.ask(4)
    assert {s.phase for s in batch} == {"climb"}
    assert len({tuple(s.configuration.values()) for s in batch}) == 4


@pytest.mark.parametrize("options", [{"random_points": 0}, {"improvement": "worst"}, {"weights": [-1.0]}])
def test_impossible_options_are_refused(options: dict) -> None:
    with pytest.raises(ScenarioError, match=next(iter(options))):
        HillClimbing(**options)


def test_several_objectives_are_compared_by_the_chosen_scalarization() -> None:
    acquisition = {"scalarization": "linear"}
    optimizer = run(scenario_of(optimizer=search(random_points=5), acquisition=acquisition), 40)
    sums = [e.values["near"] - e.values["far"] for e in optimizer.history]
    assert np.argmin(sums) > 5
