"""Bayesian optimization that takes the noise from replicates."""

import numpy as np
import pytest

from hypermap_lite.assembly import build_history, build_optimizer
from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.reports import posterior_front
from hypermap_lite.scenario.loader import load_scenario
from tests.optimizers.runs import configurations, resumed, scenario_of, two_objectives

POOLED = {"surrogate": {"noise_from_replicates": True}}


def sampled(suggestion, n=3):
    """Return the evaluation of n noisy replicates, with noise that grows along one axis."""
    rng = np.random.default_rng([suggestion.trial, n])
    scale = 0.02 + 0.2 * suggestion.configuration["a"]
    values = {
        name: value + scale * rng.standard_normal(n) for name, value in two_objectives(suggestion.configuration).items()
    }
    return Evaluation(
        suggestion=suggestion,
        state=State.COMPLETED,
        values={name: float(sample.mean()) for name, sample in values.items()},
        standard_errors={
            name: float(sample.std(ddof=1) / np.sqrt(n)) if n > 1 else np.nan for name, sample in values.items()
        },
        replicates=n,
    )


def run(scenario, n, replicates=3):
    optimizer = build_optimizer(load_scenario(scenario))
    while len(optimizer.history) < n:
        optimizer.tell([sampled(s, replicates) for s in optimizer.ask()])
    return optimizer


def test_posterior_knows_noise_and_number_of_replicates_of_each_configuration():
    optimizer = run(scenario_of(budget={"evaluations": 16, "confirm_front": 4}, **POOLED), 16)
    posterior, X = optimizer.fitted()
    samples = optimizer.history.samples()
    assert X.tolist() == samples.X.tolist()
    assert len(X) < 16
    process = posterior.processes[0]
    expected = samples.noise_variance[:, 0] * process.hyperparameters.noise_variance / process.output.scale**2
    assert process.noise_variances == pytest.approx(expected)
    # What is evaluated most is known best.
    assert samples.replicates.max() > 3


@pytest.mark.parametrize("surrogate", [{}, {"type": "random_forest"}])
def test_other_surrogates_have_a_row_per_evaluation(surrogate):
    scenario = scenario_of(budget={"evaluations": 14, "confirm_front": 4}, surrogate=surrogate)
    assert len(run(scenario, 14).fitted()[1]) == 14


def test_resumed_optimizer_goes_on_as_the_uninterrupted_one():
    scenario = scenario_of(budget={"evaluations": 14, "confirm_front": 4}, **POOLED)
    first = run(scenario, 14)
    longer = scenario_of(budget={"evaluations": 22, "confirm_front": 2}, **POOLED)
    whole = resumed(longer, list(first.history))
    while len(whole.history) < 22:
        whole.tell([sampled(s) for s in whole.ask()])
    for at in (9, 13, 16, 18):
        (suggestion,) = resumed(longer if at >= 14 else scenario, list(whole.history)[:at]).ask()
        assert suggestion.configuration == whole.history[at].configuration


def test_single_replicates_are_modelled_as_without_the_option():
    with_it, without = (run(scenario_of(**changes), 12, replicates=1) for changes in (POOLED, {}))
    assert configurations(with_it) == configurations(without)


def test_confirmation_that_failed_does_not_stop_the_search():
    scenario = scenario_of(budget={"evaluations": 14, "confirm_front": 2}, **POOLED)
    optimizer = run(scenario, 12)
    (suggestion,) = optimizer.ask()
    optimizer.tell([Evaluation(suggestion=suggestion, state=State.FAILED, error="broken")])
    (following,) = optimizer.ask()
    assert following.configuration != suggestion.configuration
    history = build_history(load_scenario(scenario))
    history.extend(optimizer.history)
    assert len(history.samples().X) == 11


def test_checks_of_a_prior_are_the_same_when_they_are_made_again():
    """A run that goes on works out the earlier checks anew, from the rows of their time."""
    prior = {"type": "gaussian", "mean": 0.9, "std": 0.05}
    parameters = {name: {"parameter_type": "real", "values": [0, 1], "prior": prior} for name in ("a", "b")}
    scenario = load_scenario(scenario_of(input_parameters=parameters, budget={"evaluations": 16}, **POOLED))
    going = build_optimizer(scenario)
    trusts = []
    while len(going.history) < 16:
        again = build_optimizer(scenario)
        again.history.extend(going.history)
        (asked,), (repeated,) = going.ask(), again.ask()
        assert repeated.configuration == asked.configuration
        assert (repeated.prior_weight, repeated.prior_trust) == (asked.prior_weight, asked.prior_trust)
        trusts.append(asked.prior_trust)
        going.tell([sampled(asked)])
    assert min(trust for trust in trusts if trust is not None) < 1  # there were checks, and they said something


MIXED = {"budget": {"evaluations": 16, "confirm_front": 4}, **POOLED}


def with_earlier(rows, **changes):
    """Return an optimizer after earlier rows: configurations, completed or infeasible."""
    scenario = load_scenario(scenario_of(**MIXED, **changes))
    history = build_history(scenario)
    for trial, (a, is_completed) in enumerate(rows):
        suggestion = Suggestion(trial=trial, configuration={"a": a, "b": 0.5}, phase="earlier")
        infeasible = Evaluation(suggestion=suggestion, state=State.INFEASIBLE)
        history.append(sampled(suggestion) if is_completed else infeasible)
    return build_optimizer(scenario, history)


def test_configuration_of_mixed_states_may_be_confirmed():
    optimizer = with_earlier([(0.5, True), (0.5, False), (0.1, True), (0.3, True), (0.7, True), (0.9, True)])
    while len(optimizer.history) < 16:
        optimizer.tell([sampled(s) for s in optimizer.ask()])
    assert [e.suggestion.phase for e in optimizer.history][12:] == ["confirm"] * 4


def test_configurations_that_are_all_of_mixed_states_are_modelled():
    optimizer = with_earlier(
        [(0.2, True), (0.2, False), (0.6, True), (0.6, False)], design_of_experiment={"number_of_samples": 2}
    )
    (suggestion,) = optimizer.ask()
    assert suggestion.phase == "model"
    assert len(optimizer.fitted()[1]) == 2


def test_run_whose_confirmations_all_failed_goes_on_without_a_model():
    changes = {"design_of_experiment": {"number_of_samples": 2}, **POOLED}
    changes["acquisition"] = {"feasibility_weighting": {"learn_failed": False}}
    budget = {"evaluations": 4, "confirm_front": 2}
    optimizer = build_optimizer(load_scenario(scenario_of(budget=budget, **changes)))
    optimizer.tell([sampled(s) for s in optimizer.ask(2)])
    optimizer.tell([Evaluation(suggestion=s, state=State.FAILED, error="broken") for s in optimizer.ask(2)])
    longer = scenario_of(budget={"evaluations": 8}, **changes)
    (suggestion,) = resumed(longer, list(optimizer.history)).ask()
    assert suggestion.phase == "random"
    with pytest.raises(UsageError, match="too few configurations"):
        posterior_front(load_scenario(longer), optimizer.history)
