"""The benchmark of priors draws them as piBO does, and compares with no prior."""

import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks.problems import PROBLEMS
from hypermap_lite import non_dominated

HOME = str(Path(__file__).parents[2] / "benchmarks")


@pytest.fixture(scope="module")
def benchmark():
    sys.path.insert(0, HOME)
    import prior_benchmark

    yield prior_benchmark
    sys.path.remove(HOME)


def test_good_places_are_optimal_and_bad_ones_are_not(benchmark):
    problem = PROBLEMS["branin_currin"]
    axis = np.linspace(0, 1, 501)
    U = np.column_stack([u.ravel() for u in np.meshgrid(axis, axis)])
    places = benchmark.PLACES["branin_currin"]
    Y = problem.function(problem.points(np.vstack([places.good, U])))
    assert non_dominated(Y)[0]
    assert (problem.function(np.array([places.bad]))[0] > problem.reference_point).any()
    hartmann, places = PROBLEMS["hartmann6"], benchmark.PLACES["hartmann6"]
    values = hartmann.function(np.array([places.good, places.bad]))[:, 0]
    assert values[0] == pytest.approx(hartmann.best)
    assert values[1] == pytest.approx(0, abs=0.1)


def test_prior_has_the_deviation_and_the_offset_of_its_level(benchmark):
    problem, places = PROBLEMS["hartmann6"], benchmark.PLACES["hartmann6"]
    for name, level in benchmark.LEVELS.items():
        priors = [
            [p["prior"] for p in benchmark.parameters_with_prior(problem, places, level, seed).values()]
            for seed in range(200)
        ]
        place = np.array(places.bad if name == "wrong" else places.good)
        offsets = np.array([[prior["mean"] for prior in drawn] for drawn in priors]) - place
        assert {prior["std"] for drawn in priors for prior in drawn} == {level.deviation}
        assert offsets.std() == pytest.approx(level.offset, rel=0.05)


def test_emulated_tasks_have_the_priors_of_their_scenarios(benchmark):
    assert benchmark.priors_of("branin_currin") == ("none", "strong", "weak", "wrong")
    assert benchmark.priors_of("object_pushing_emulated") == ("none", "operator", "misleading")
    parameters = benchmark.parameters_of_task("object_pushing_emulated", "misleading")
    assert parameters["offset_y_start"]["prior"] == {"type": "gaussian", "mean": 0.25, "std": 0.05}
    plain = {
        name: {key: of for key, of in parameter.items() if key != "prior"} for name, parameter in parameters.items()
    }
    assert plain == PROBLEMS["object_pushing_emulated"].parameters


def test_error_of_a_ratio_is_that_of_its_parts(benchmark):
    rng = np.random.default_rng(0)
    draws = rng.normal([3.0, 2.0], [0.6, 0.3], (2000, 20, 2))
    ratios = draws[:, :, 0].mean(axis=1) / draws[:, :, 1].mean(axis=1)
    found = [benchmark.ratio(list(a), list(b)).split(" ± ") for a, b in draws[:200].transpose(0, 2, 1)]
    assert np.mean([float(error) for _, error in found]) == pytest.approx(ratios.std(), rel=0.1)
    assert [float(of) for of, _ in found] == pytest.approx(ratios[:200], abs=5e-4)
    assert benchmark.ratio([1.0], [1.0, 2.0]) == "0.667"


def test_target_is_reached_when_the_value_is_as_good(benchmark):
    assert benchmark.evaluations_to(PROBLEMS["branin_currin"], [0.1, 0.5, 0.7], 0.5) == 2
    assert benchmark.evaluations_to(PROBLEMS["branin_currin"], [0.1, 0.5, 0.7], 0.8) == float("inf")
    hartmann = PROBLEMS["hartmann6"]
    assert benchmark.evaluations_to(hartmann, [0.0, -1.0, -2.0], -hartmann.best - 0.05) == 3


def test_summary_compares_with_the_same_method_without_a_prior(benchmark):
    rows = [
        {"problem": "branin_currin", "method": "default", "prior": prior, "seed": seed, "final": final, "trace": trace}
        | {"cpu_seconds": 0.1}
        for prior, seed, final, trace in [
            ("none", 0, 0.8, "0.1 0.8"),
            ("none", 1, 0.6, "0.1 0.6"),
            ("strong", 0, 0.77, "0.7 0.77"),
            ("wrong", 0, 0.35, "0.0 0.35"),
        ]
    ]
    lines = {line[2]: line for line in benchmark.summary(rows)}
    assert lines["strong"][4:8] == ("0.770", "1.100", "1.100", "2 %")
    assert lines["wrong"][4:8] == ("0.350", "0.500", "0.500", "never")
