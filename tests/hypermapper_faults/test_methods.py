"""Faults measured in HyperMapper's search methods: each test fails on the faulty behaviour."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hypermap_lite import optimize
from hypermap_lite.acquisition import ACQUISITIONS, AcquisitionContext
from hypermap_lite.assembly import build_optimizer
from hypermap_lite.errors import ScenarioError
from hypermap_lite.maximizers import MAXIMIZERS, MaximizationProblem
from hypermap_lite.maximizers.base import choose_starts
from hypermap_lite.maximizers.neighbours import axis_neighbours
from hypermap_lite.optimizers import OPTIMIZERS
from hypermap_lite.optimizers.fitness import normalized_weights
from hypermap_lite.priors import ProductPrior
from hypermap_lite.scalarization import SCALARIZATIONS, Normalization
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.space import IntegerParameter, RealParameter, SearchSpace
from hypermap_lite.surrogates import SURROGATES
from hypermap_lite.surrogates.base import Conditional, Field, Posterior
from tests.optimizers.runs import configurations, run, scenario_of, two_objectives


class TwoPoints(Posterior):
    """A posterior that predicts the same objectives, 0.9 and 0.1, at any place below and above 0.5."""

    hyperparameters = None
    is_differentiable = False

    def field(self, X: np.ndarray) -> Conditional:
        mean = np.where(X[None, :, :1] < 0.5, [0.9, 0.9], [0.1, 0.1])
        return Conditional(mean=mean, std=np.full(mean.shape, 0.1))

    def believe(self, X_pending: np.ndarray) -> TwoPoints:
        return self

    def sample_path(self, rng: np.random.Generator, features: int) -> Field:
        return self.field


def context_of(posterior: Posterior, scalarization: str) -> AcquisitionContext:
    Y = np.array([[0.0, 1.0], [1.0, 0.0], [0.6, 0.6]])
    return AcquisitionContext(
        posterior=posterior,
        X=np.array([[0.2], [0.4], [0.6]]),
        Y=Y,
        X_pending=np.empty((0, 1)),
        scalarization=SCALARIZATIONS[scalarization](),
        weights=np.array([0.5, 0.5]),
        normalization=Normalization.of_front(Y),
        rng=np.random.default_rng(0),
    )


@pytest.mark.parametrize("acquisition", ["expected_improvement", "upper_confidence_bound", "thompson_sampling"])
@pytest.mark.parametrize("scalarization", list(SCALARIZATIONS))
def test_a_better_prediction_has_the_better_score_with_every_scalarization(
    acquisition: str, scalarization: str
) -> None:
    score = ACQUISITIONS[acquisition]().scorer(context_of(TwoPoints(), scalarization))
    worse, better = score(np.array([[0.25], [0.75]]))
    assert better > worse


def test_neighbours_lie_on_both_sides() -> None:
    for parameter in (RealParameter(name="x", low=-5, high=10), IntegerParameter(name="x", low=0, high=100)):
        around = axis_neighbours(parameter, 0.5)
        assert (around < 0.5).any()
        assert (around > 0.5).any()


def test_local_search_goes_down_an_axis_as_well_as_up() -> None:
    for optimum in (0.1, 0.9):
        parameters = {"a": {"parameter_type": "real", "values": [0, 1], "parameter_default": 0.5}}
        search = {"type": "local_search", "random_points": 1}
        scenario = scenario_of(input_parameters=parameters, objectives=[{"name": "y"}], optimizer=search)
        found = run(scenario, 40, function=lambda c, at=optimum: {"y": abs(c["a"] - at)})
        assert min(e.values["y"] for e in found.history) < 0.01


def test_starts_are_the_best_candidates_whatever_their_parameters() -> None:
    X = np.linspace(0.05, 0.95, 10)[:, None]
    scores = X[:, 0] ** 2
    assert choose_starts(X, scores, 3)[:, 0] == pytest.approx([0.95, 0.85, 0.75])
    assert choose_starts(X[::-1], scores[::-1], 3)[:, 0] == pytest.approx([0.95, 0.85, 0.75])


@pytest.mark.parametrize("surrogate", list(SURROGATES))
def test_draws_of_thompson_sampling_differ(surrogate: str) -> None:
    rng = np.random.default_rng(0)
    X = rng.random((20, 2))
    Y = (X**2).sum(axis=1, keepdims=True)
    posterior = SURROGATES[surrogate]().fit(X, Y, is_ordered=np.ones(2, bool), rng=rng)
    context = replace(
        context_of(posterior, "linear"), X=X, Y=Y, weights=np.ones(1), normalization=Normalization.of_front(Y)
    )
    where = rng.random((50, 2))
    draws = [
        ACQUISITIONS["thompson_sampling"]().scorer(replace(context, rng=np.random.default_rng(i)))(where)
        for i in range(3)
    ]
    assert not np.allclose(draws[0], draws[1])
    assert not np.allclose(draws[1], draws[2])
    assert not np.allclose(draws[0], draws[2])


def test_weights_are_divided_by_one_sum() -> None:
    assert normalized_weights([1, 1, 2], 3) == pytest.approx([0.25, 0.25, 0.5])


def test_a_mutation_rate_of_three_changes_three_parameters() -> None:
    parameters = {f"p{i}": {"parameter_type": "ordinal", "values": list(range(50))} for i in range(8)}
    evolution = {"type": "evolutionary", "population_size": 2, "tournament_size": 2, "mutation_rate": 3}
    design = {"number_of_samples": 2}
    scenario = scenario_of(
        input_parameters=parameters, objectives=[{"name": "y"}], optimizer=evolution, design_of_experiment=design
    )
    optimizer = run(scenario, 2, function=lambda c: {"y": c["p0"]})
    parent = min(optimizer.history, key=lambda e: e.values["y"]).configuration
    for suggestion in optimizer.ask(5):
        assert sum(suggestion.configuration[name] != parent[name] for name in parameters) == 3


WITH_CATEGORIES = {
    "r": {"parameter_type": "real", "values": [0, 1], "prior": {"type": "gaussian", "mean": 0.3, "std": 0.2}},
    "n": {"parameter_type": "integer", "values": [0, 4], "prior": {"type": "weights", "weights": [1, 2, 3, 2, 0]}},
    "o": {"parameter_type": "ordinal", "values": [1, 2, 4], "prior": {"type": "weights", "weights": [5, 1, 1]}},
    "c": {"parameter_type": "categorical", "values": ["a", "b"], "prior": {"type": "weights", "weights": [1, 3]}},
}
SMALL_EVOLUTION = {"type": "evolutionary", "population_size": 4, "tournament_size": 2}


@pytest.mark.parametrize(
    "changes",
    [
        pytest.param({"optimizer": SMALL_EVOLUTION}, id="evolutionary"),
        pytest.param({"optimizer": SMALL_EVOLUTION | {"crossover": True, "regularized": True}}, id="crossover"),
        pytest.param({"optimizer": {"type": "local_search", "random_points": 4}}, id="local_search"),
        pytest.param({"acquisition": {"prior_weighting": "bopro"}}, id="bopro"),
        *[
            pytest.param({"design_of_experiment": {"type": f"{kind}latin_hypercube", "number_of_samples": 8}}, id=kind)
            for kind in ("", "k_", "prior_")
        ],
    ],
)
@pytest.mark.parametrize("n_objectives", [1, 2])
def test_categories_and_lists_as_priors_go_with_every_method(changes: dict, n_objectives: int) -> None:
    objectives = [{"name": "near"}, {"name": "far"}][:n_objectives]
    scenario = scenario_of(input_parameters=WITH_CATEGORIES, objectives=objectives, **changes)
    found = run(scenario, 10, function=lambda c: {"near": c["r"] + (c["c"] == "b"), "far": c["n"] - c["o"]})
    assert len({tuple(c.items()) for c in configurations(found)}) == 10


def test_a_latin_hypercube_draws_the_levels_of_a_list_prior_by_their_weights() -> None:
    design = {"type": "prior_latin_hypercube", "number_of_samples": 40}
    budget = {"evaluations": 40}
    scenario = scenario_of(input_parameters=WITH_CATEGORIES, design_of_experiment=design, budget=budget)
    drawn = [s.configuration["n"] for s in build_optimizer(load_scenario(scenario)).ask(40)]
    assert [drawn.count(n) for n in range(5)] == pytest.approx([5, 10, 15, 10, 0], abs=2)


@pytest.mark.parametrize("kind", OPTIMIZERS)
def test_one_design_point_is_enough(kind: str) -> None:
    scenario = scenario_of(optimizer=kind, design_of_experiment={"number_of_samples": 1})
    assert len(run(scenario, 6).history) == 6


def test_no_design_point_at_all_is_refused_in_words() -> None:
    with pytest.raises(ScenarioError, match=r"number_of_samples: 0 is too small"):
        load_scenario(scenario_of(design_of_experiment={"number_of_samples": 0}))


@pytest.mark.parametrize("maximizer", list(MAXIMIZERS))
@pytest.mark.parametrize("weighting", ["pibo", "bopro"])
def test_an_exhausted_space_ends_the_run(maximizer: str, weighting: str) -> None:
    scenario = scenario_of(
        input_parameters={name: WITH_CATEGORIES[name] for name in "oc"},
        acquisition={"prior_weighting": weighting},
        maximizer=maximizer,
    )
    found = run(scenario, 50, function=lambda c: {"near": c["o"], "far": -float(c["c"] == "a")})
    assert len(found.history) == 6
    assert found.ask(3) == []


@pytest.mark.parametrize("evaluations", [3, 5, 9])
def test_local_search_ends_at_any_limit(evaluations: int, tmp_path: Path) -> None:
    scenario = scenario_of(
        optimizer={"type": "local_search", "random_points": 5},
        design_of_experiment={"number_of_samples": min(evaluations, 5)},
        budget={"evaluations": evaluations, "batch_size": 2},
    )
    result = optimize(scenario, two_objectives, output_directory=tmp_path)
    assert len(result.evaluations) == evaluations


def test_cma_es_takes_another_point_where_the_best_is_evaluated() -> None:
    class Corner:
        is_differentiable = False

        def __call__(self, X: np.ndarray) -> np.ndarray:
            return X.sum(axis=1)

    space = SearchSpace(tuple(RealParameter(name=n, low=0, high=1) for n in "ab"))
    seen: list[bytes] = []
    for _ in range(3):
        found = MAXIMIZERS["cma_es"](candidates=16).maximize(
            MaximizationProblem(
                scorer=Corner(),
                space=space,
                prior=ProductPrior(2),
                incumbents=np.ones((1, 2)),
                seen=tuple(seen),
                rng=np.random.default_rng(0),
            )
        )
        assert found is not None
        (key,) = space.keys(found.x[None])
        assert key not in seen
        assert found.score > 1.9
        seen.append(key)
