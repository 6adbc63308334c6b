"""Bayesian optimization."""

from dataclasses import replace

import numpy as np
import pytest

from hypermap_lite.acquisition import ACQUISITIONS, UpperConfidenceBound
from hypermap_lite.assembly import build_optimizer
from hypermap_lite.design import DESIGNS
from hypermap_lite.maximizers import MAXIMIZERS
from hypermap_lite.maximizers.base import MaximizationProblem, Maximum
from hypermap_lite.optimizers.models import milestones
from hypermap_lite.pareto.hypervolume import hypervolume
from hypermap_lite.scalarization import SCALARIZATIONS, WEIGHTS
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.surrogates import SURROGATES
from tests.optimizers.runs import configurations, evaluate, fail, resumed, run, scenario_of
from tests.slow import slow_after

GAUSSIANS = {
    "a": {"parameter_type": "real", "values": [0, 1], "prior": {"type": "gaussian", "mean": 0.5, "std": 0.2}},
    "b": {"parameter_type": "real", "values": [-5, 5], "prior": {"type": "gaussian", "mean": 1, "std": 2}},
}


ALWAYS_GUIDED = {"prior_free": 0, "safeguard": False}
"""Prior weighting that is the same in every step."""


@pytest.mark.parametrize(
    "changes",
    [
        *[pytest.param({"acquisition": name}, id=name) for name in ACQUISITIONS],
        *[pytest.param({"surrogate": name}, id=name) for name in SURROGATES],
        *[pytest.param({"maximizer": name}, id=name) for name in MAXIMIZERS],
        *[pytest.param({"design_of_experiment": {"type": name, "number_of_samples": 5}}, id=name) for name in DESIGNS],
        *[pytest.param({"acquisition": {"scalarization": name}}, id=name) for name in SCALARIZATIONS],
        pytest.param(
            {"acquisition": {"weights": {"type": "bounding_box", "limits": {"near": [0, 0.2], "far": [-0.5, 0]}}}},
            id="bounding_box",
        ),
        pytest.param({"preset": "paper", "input_parameters": GAUSSIANS}, id="paper"),
    ],
)
def test_every_member_of_every_family_drives_a_run(changes: dict) -> None:
    optimizer = run(scenario_of(**changes), 8, batch=2)
    assert len(optimizer.history) == 8
    phases = [e.suggestion.phase for e in optimizer.history]
    n_design = phases.count("design")
    assert phases == ["design"] * n_design + ["model"] * (8 - n_design)
    assert all(np.isfinite(e.suggestion.acquisition_value) for e in list(optimizer.history)[n_design:])


def phases(optimizer) -> list[str]:
    return [evaluation.suggestion.phase for evaluation in optimizer.history]


def test_epsilon_is_the_share_of_uniform_draws_after_the_design() -> None:
    changes = {"design_of_experiment": {"type": "sobol", "number_of_samples": 4}, "seed": 3}
    always = run(scenario_of(**changes, optimizer={"epsilon": 1}), 12, batch=2)
    assert phases(always) == ["design"] * 4 + ["random"] * 8
    sometimes = run(scenario_of(**changes, optimizer={"epsilon": 0.4}), 24, batch=2)
    assert 2 <= phases(sometimes).count("random") <= 14
    assert len({str(c) for c in configurations(sometimes)}) == 24


def test_epsilon_of_zero_is_the_run_without_it_and_draws_depend_on_the_trial_alone() -> None:
    plain = run(scenario_of(), 9)
    assert configurations(run(scenario_of(optimizer={"epsilon": 0}), 9)) == configurations(plain)
    scenario = scenario_of(optimizer={"epsilon": 0.5})
    whole = run(scenario, 12)
    for stop in range(5, 12):
        (suggestion,) = resumed(scenario, list(whole.history)[:stop]).ask()
        assert suggestion.configuration == whole.history[stop].configuration


def test_weight_samplings_are_covered_above() -> None:
    assert set(WEIGHTS) == {"dirichlet", "bounding_box"}


MIXED = {
    "a": GAUSSIANS["a"],
    "n": {"parameter_type": "integer", "values": [1, 1000], "scale": "log"},
    "c": {
        "parameter_type": "categorical",
        "values": ["x", "y", "z"],
        "prior": {"type": "weights", "weights": [1, 2, 3]},
    },
}


def mixed_objectives(c: dict) -> dict[str, float]:
    return {"near": (c["a"] - 0.3) ** 2 + ("xyz".index(c["c"])) / 3, "far": -abs(np.log10(c["n"]) - 1) - c["a"]}


@pytest.mark.parametrize(
    "changes",
    [
        pytest.param({}, id="default"),
        pytest.param({"surrogate": "random_forest"}, id="random_forest", marks=pytest.mark.slow),
        pytest.param({"acquisition": "thompson_sampling"}, id="thompson_sampling", marks=pytest.mark.slow),
        pytest.param({"preset": "paper"}, id="paper", marks=pytest.mark.slow),
    ],
)
def test_a_resumed_run_with_priors_and_failures_goes_on_past_several_milestones(changes: dict) -> None:
    scenario = scenario_of(input_parameters=MIXED, budget={"evaluations": 22}, **changes)
    whole = build_optimizer(load_scenario(scenario))
    while len(whole.history) < 20:
        suggestions = whole.ask(2)
        whole.tell([fail(s) if s.trial % 5 == 3 else evaluate(s, mixed_objectives) for s in suggestions])
    again = resumed(scenario, list(whole.history))
    expected, found = whole.ask(2), again.ask(2)
    assert [replace(s, seconds=0) for s in found] == [replace(s, seconds=0) for s in expected]
    assert found[0].prior_weight is not None


@pytest.mark.parametrize("value", slow_after(1, [-3e200, 0.0, 5.0]))
@pytest.mark.parametrize(
    "changes",
    [
        {"preset": "paper"},
        {"acquisition": "noisy_expected_improvement"},
        {"acquisition": {"type": "expected_improvement", "scalarization": "linear"}},
        {"acquisition": "upper_confidence_bound"},
        {"acquisition": "thompson_sampling"},
        {"surrogate": "random_forest"},
        {"surrogate": "random_forest", "acquisition": {"scalarization": "linear"}},
    ],
    ids=str,
)
def test_objectives_that_never_change_are_no_trouble(changes: dict, value: float) -> None:
    optimizer = run(scenario_of(**changes), 8, function=lambda c: {"near": value, "far": value})
    assert all(np.isfinite(e.suggestion.acquisition_value) for e in list(optimizer.history)[5:])


def test_thirty_parameters_are_no_trouble() -> None:
    parameters = {f"x{i}": {"parameter_type": "real", "values": [0, 1]} for i in range(30)}
    scenario = scenario_of(input_parameters=parameters, objectives=[{"name": "y"}])
    optimizer = run(scenario, 8, function=lambda c: {"y": sum((v - 0.5) ** 2 for v in c.values())})
    assert len(optimizer.history) == 8


@pytest.mark.parametrize("n_objectives", [1, 2])
def test_rescaling_a_parameter_changes_no_suggestion(n_objectives: int) -> None:
    def scenario(factor: float) -> dict:
        length = {"parameter_type": "real", "values": [0, 0.08 * factor]}
        length["prior"] = {"type": "gaussian", "mean": 0.02 * factor, "std": 0.03 * factor}
        objectives = [{"name": "y"}, {"name": "z"}][:n_objectives]
        return scenario_of(input_parameters={"length": length, "b": GAUSSIANS["b"]}, objectives=objectives)

    def function(factor: float):
        return lambda c: {"y": (c["length"] / factor - 0.05) ** 2 * 1e3, "z": (c["b"] - 1) ** 2}

    metres = configurations(run(scenario(1.0), 10, function=function(1.0)))
    millimetres = configurations(run(scenario(1000.0), 10, function=function(1000.0)))
    assert [c["length"] * 1000 for c in metres] == pytest.approx([c["length"] for c in millimetres], rel=1e-6)
    assert [c["b"] for c in metres] == pytest.approx([c["b"] for c in millimetres], rel=1e-6)


def test_the_prior_decays_with_the_number_of_model_based_suggestions() -> None:
    acquisition = {"prior_weighting": {"method": "pibo", "beta": 6.0, **ALWAYS_GUIDED}}
    optimizer = run(scenario_of(input_parameters=GAUSSIANS, acquisition=acquisition), 9, batch=2)
    weights = [e.suggestion.prior_weight for e in optimizer.history]
    assert weights == [1.0, 1.0, 1.0, 1.0, 0.0, 6.0, 3.0, 2.0, 1.5]


@pytest.mark.parametrize("changes", [{}, {"objectives": [{"name": "near"}]}, {"surrogate": "random_forest"}], ids=str)
def test_bopro_runs_with_categories_batches_and_failures_and_counts_its_suggestions(changes: dict) -> None:
    acquisition = {"prior_weighting": {"method": "bopro", "model_weight": 6.0, **ALWAYS_GUIDED}}
    scenario = scenario_of(input_parameters=MIXED, acquisition=acquisition, **changes)
    whole = build_optimizer(load_scenario(scenario))
    while len(whole.history) < 10:
        suggestions = whole.ask(2)
        whole.tell([fail(s) if s.trial == 3 else evaluate(s, mixed_objectives) for s in suggestions])
    assert [e.suggestion.prior_weight for e in whole.history][5:] == [6.0, 3.0, 2.0, 1.5, 1.2]
    again = resumed(scenario, list(whole.history)[:8])
    assert [s.configuration for s in again.ask(2)] == configurations(whole)[8:]


def test_bopro_goes_where_the_prior_points_until_the_model_knows_better() -> None:
    acquisition = {"prior_weighting": {"method": "bopro", "model_weight": 4.0, **ALWAYS_GUIDED}}
    wrong = {"a": {"parameter_type": "real", "values": [0, 1], "prior": {"type": "gaussian", "mean": 0.9, "std": 0.05}}}
    design = {"type": "prior_sampling", "uniform_share": 0, "number_of_samples": 5}
    scenario = scenario_of(
        input_parameters=wrong,
        acquisition=acquisition,
        objectives=[{"name": "near"}],
        design_of_experiment=design,
    )
    optimizer = run(scenario, 25, function=lambda c: {"near": (c["a"] - 0.2) ** 2})
    a = [c["a"] for c in configurations(optimizer)]
    assert a[5] > 0.7
    assert min(np.abs(np.array(a) - 0.2)) < 0.02


@pytest.mark.parametrize(("batch", "expected"), [(1, [1, 2, 3, 4]), (2, [1, 1, 2, 2])])
def test_a_logarithmic_bound_counts_batches(batch: int, expected: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[int] = []
    width = UpperConfidenceBound.width
    monkeypatch.setattr(UpperConfidenceBound, "width", lambda self, t: seen.append(t) or width(self, t))
    bound = {"type": "upper_confidence_bound", "beta": "logarithmic"}
    design = {"type": "sobol", "number_of_samples": 4}
    budget = {"evaluations": 8, "batch_size": batch}
    run(scenario_of(acquisition=bound, design_of_experiment=design, budget=budget), 8, batch=batch)
    assert seen == expected


def test_without_prior_there_is_no_prior_weight() -> None:
    assert all(e.suggestion.prior_weight is None for e in run(scenario_of(), 7).history)


def test_prior_weighting_can_be_switched_off() -> None:
    off = scenario_of(input_parameters=GAUSSIANS, acquisition={"prior_weighting": {"method": "none"}})
    assert all(e.suggestion.prior_weight is None for e in list(run(off, 7).history)[5:])


def test_a_strong_prior_pulls_the_suggestions() -> None:
    strong = {"prior_weighting": {"method": "pibo", "beta": 1000.0, "floor": 1e-6, **ALWAYS_GUIDED}}
    narrow = {
        **GAUSSIANS,
        "a": {"parameter_type": "real", "values": [0, 1], "prior": {"type": "gaussian", "mean": 0.9, "std": 0.02}},
    }
    optimizer = run(scenario_of(input_parameters=narrow, acquisition=strong), 9)
    assert [c["a"] for c in configurations(optimizer)[5:]] == pytest.approx([0.9] * 4, abs=0.03)


@pytest.mark.slow
def test_it_spreads_along_a_front_better_than_random_search() -> None:
    def volumes(kind: str) -> list[float]:
        runs = [run(scenario_of(optimizer=kind, seed=seed, budget={"evaluations": 25}), 25) for seed in range(5)]
        return [hypervolume(r.history.Y(), np.array([0.6, 0.6])) for r in runs]

    assert np.median(volumes("bayesian")) > max(volumes("random_search"))


@pytest.mark.slow
def test_a_front_flat_but_for_numerical_dust_does_not_blind_the_search() -> None:
    def with_penalty(c: dict) -> dict[str, float]:
        far = -((c["a"] - 0.8) ** 2) - (c["b"] / 5 - 0.5) ** 2
        return {"near": 10 * (c["b"] < -2.5) + 1e-9 * np.sin(40 * c["a"] + 3.4 * c["b"]), "far": far}

    finals = []
    for seed in range(3):
        optimizer = run(scenario_of(seed=seed, budget={"evaluations": 20}), 20, function=with_penalty)
        finals.append(max(e.values["far"] for e in optimizer.history))
    assert np.median(finals) > -0.01


def test_milestones_depend_on_nothing_but_the_count() -> None:
    assert list(milestones(8, 1.5)) == []
    assert list(milestones(30, 1.5)) == [8, 12, 18, 27]
    assert list(milestones(20, 1.2)) == [8, 9, 11, 13, 16, 19]


REDRAWN = {"weights": {"type": "dirichlet", "ends": 0.3, "redraws": 3}}


def test_a_trade_off_drawn_again_in_vain_loses_no_suggestion() -> None:
    class Once:
        n_calls = 0

        def maximize(self, problem: MaximizationProblem) -> Maximum | None:
            self.n_calls += 1
            return Maximum(x=problem.incumbents[0], score=-99.0) if self.n_calls == 1 else None

    optimizer = run(scenario_of(acquisition=REDRAWN), 8)
    maximizer = Once()
    optimizer._method = replace(optimizer._method, maximizer=maximizer)
    optimizer._promise = lambda *_: -np.inf
    assert [s.phase for s in optimizer.ask()] == ["model"]
    assert maximizer.n_calls == 2


def test_a_reference_point_of_one_objective_alone_is_kept_to() -> None:
    objectives = [{"name": "near", "reference_point": 0.2}, {"name": "far"}]

    def trade_off(c: dict) -> dict[str, float]:
        return {"near": c["a"] + 0.1 * abs(c["b"]), "far": 1 - np.sqrt(c["a"]) + 0.1 * abs(c["b"])}

    parameters = {n: {"parameter_type": "real", "values": [0, 1]} for n in ("a", "b")}
    scenario = scenario_of(input_parameters=parameters, objectives=objectives, budget={"evaluations": 20})
    optimizer = run(scenario, 20, function=trade_off)
    chosen = [e.values["near"] for e in optimizer.history if e.suggestion.phase == "model"]
    assert np.mean([value < 0.25 for value in chosen]) > 0.8


@pytest.mark.parametrize("separation", [0.1, 0.2])
def test_a_batch_keeps_its_distance_where_a_few_draws_choose_the_candidates(separation: float) -> None:
    def parabolas(c: dict) -> dict[str, float]:
        return {"near": (c["a"] - 0.4) ** 2, "far": -((c["a"] - 0.5) ** 2)}

    scenario = scenario_of(
        input_parameters={"a": {"parameter_type": "real", "values": [0, 1]}},
        optimizer={"separation": separation},
        budget={"evaluations": 17, "batch_size": 3},
    )
    rows = list(run(scenario, 17, batch=3, function=parabolas).history)
    for start in range(6, 15, 3):
        a = sorted(row.configuration["a"] for row in rows[start : start + 3])
        assert min(a[1] - a[0], a[2] - a[1]) >= separation - 1e-9
