"""Scenarios that must not run, each with what its message has to say; used for the loader and the command line."""

from __future__ import annotations

import copy
import json
from typing import Any, NamedTuple

GOOD: dict[str, Any] = {
    "application_name": "demo",
    "input_parameters": {
        "x": {"parameter_type": "real", "values": [-5, 10]},
        "n": {"parameter_type": "integer", "values": [1, 8]},
        "size": {"parameter_type": "ordinal", "values": [16, 32, 64]},
        "mode": {"parameter_type": "categorical", "values": ["fast", "safe"]},
    },
    "objectives": [{"name": "cost"}, {"name": "gain", "goal": "maximize"}],
}


class Bad(NamedTuple):
    """One mistake and its message."""

    text: str
    says: tuple[str, ...]
    """Fragments of the message: the path, the value, what is allowed, the nearest name."""

    when_loaded: bool = True
    """Whether loading alone finds it; else building the parts does."""


def changed(path: str, value: Any) -> str:
    """Return the good scenario as text with one value set; the last key is made if need be."""
    document = copy.deepcopy(GOOD)
    *above, last = [int(key) if key.isdigit() else key for key in path.split(".")]
    place: Any = document
    for key in above:
        place = place.setdefault(key, {}) if isinstance(key, str) else place[key]
    place[last] = value
    return json.dumps(document)


def without(key: str) -> str:
    """Return the good scenario as text without one section."""
    return json.dumps({name: value for name, value in GOOD.items() if name != key})


def parameter(**entry: Any) -> str:
    """Return the good scenario as text with one more parameter `p`."""
    return changed("input_parameters.p", entry)


def prior(name: str, **entry: Any) -> str:
    """Return the good scenario as text with a prior on one of its parameters."""
    return changed(f"input_parameters.{name}.prior", entry)


def joint(mean: dict[str, Any], std: dict[str, Any]) -> str:
    """Return the good scenario as text with a joint prior of one component."""
    return changed("priors", [{"type": "mixture", "components": [{"mean": mean, "std": std}]}])


def density(**entry: Any) -> str:
    """Return the good scenario as text with a kernel density for a joint prior."""
    return changed("priors", [{"type": "kde", **entry}])


REPEATED_OBJECTIVE = [{"name": "cost"}, {"name": "cost"}]
P = "$.input_parameters.p"

BAD: dict[str, Bad] = {
    # the file itself
    "broken_json": Bad('{\n  "seed": 1\n  "x": 2\n}', (":3:3", "line 3, column 3", '"x": 2', "comma before it")),
    "trailing_comma": Bad('{"seed": 1,}', ("line 1, column 11", "trailing comma before", "Remove the comma")),
    "single_quotes": Bad("{'seed': 1}", ("line 1, column 2", "double quotes")),
    "comment": Bad('{\n  // why\n  "seed": 1}', ("line 2, column 3", "no comments")),
    "python_word": Bad('{"seed": None}', ("line 1, column 10", "Write null instead of None")),
    "cut_off": Bad('{"seed": 1', ("line 1, column 11", "broken JSON")),
    "empty_file": Bad(" \n", ("the file is empty", "{...}")),
    "top_level_list": Bad("[1]", ("$: the file holds a list", "a JSON object")),
    "not_a_number": Bad(changed("seed", float("nan")), ("$.seed", "nan", "finite")),
    "infinite_bound": Bad(
        '{"input_parameters": {"x": {"values": [0, 1e999]}}}', ("$.input_parameters.x.values[1]", "inf")
    ),
    "repeated_key": Bad('{"seed": 1, "seed": 2}', ("$:", "'seed' stands twice", "each key once")),
    "repeated_parameter": Bad(
        '{"input_parameters": {"x": {}, "y": {}, "x": {}}}', ("$.input_parameters", "'x' stands twice", "Rename")
    ),
    # keys and sections
    "unknown_key": Bad(changed("sede", 3), ("$.sede", "unknown key, given 3", "objectives", "'seed'")),
    "unknown_nested_key": Bad(
        changed("budget", {"evaluation": 9}), ("$.budget.evaluation", "given 9", "'evaluations'")
    ),
    "misplaced_key": Bad(changed("replicates", 7), ("$.replicates", "given 7", "belongs to 'evaluator'")),
    "option_of_another_type": Bad(
        changed("surrogate", {"type": "gaussian_process", "max_features": 0.3}),
        ("$.surrogate.max_features", "allowed: type, noise", "goes with type random_forest"),
    ),
    "misspelt_option": Bad(
        changed("surrogate", {"type": "random_forest", "number_of_tree": 3}),
        ("$.surrogate.number_of_tree", "given 3", "'number_of_trees'"),
    ),
    "missing_objectives": Bad(without("objectives"), ("$:", "'objectives' is missing", "a list")),
    "missing_parameters": Bad(without("input_parameters"), ("$:", "'input_parameters' is missing")),
    "no_objectives": Bad(changed("objectives", []), ("$.objectives", "[] has 0 items", "not empty")),
    "no_parameters": Bad(changed("input_parameters", {}), ("$.input_parameters", "{} is empty", "at least one")),
    "section_of_wrong_type": Bad(changed("budget", 30), ("$.budget", "30 is a number", "an object with evaluations")),
    "unknown_preset": Bad(changed("preset", "papper"), ("$.preset", '"papper"', "paper, null", "'paper'")),
    "seed_in_quotes": Bad(
        changed("seed", "3"), ("$.seed", '"3" is a string', "an integer >= 0", "Write 3 without quotes")
    ),
    "seed_in_words": Bad(changed("seed", "one"), ("$.seed", '"one" is a string', "an integer >= 0")),
    "negative_seed": Bad(changed("seed", -1), ("$.seed", "-1 is too small", ">= 0")),
    "name_with_a_slash": Bad(changed("application_name", "a/b"), ("$.application_name", '"a/b"', "letters, digits")),
    # parameters
    "unknown_parameter_type": Bad(
        parameter(parameter_type="int", values=[0, 1]),
        (f"{P}.parameter_type", '"int"', "real, integer, ordinal, categorical", "'integer'"),
    ),
    "missing_parameter_type": Bad(parameter(values=[0, 1]), (f"{P}:", "'parameter_type' is missing", "real, integer")),
    "missing_values": Bad(parameter(parameter_type="real"), (f"{P}:", "'values' is missing", "[-5, 10]")),
    "parameter_name": Bad(
        changed("input_parameters.my x", {"parameter_type": "real", "values": [0, 1]}),
        ("$.input_parameters", '"my x"', "letters, digits, _ and -"),
    ),
    "reversed_bounds": Bad(
        parameter(parameter_type="real", values=[5, 1]),
        (f"{P}.values", "[5.0, 1.0] are reversed", "low < high", "Swap"),
        False,
    ),
    "equal_bounds": Bad(
        parameter(parameter_type="integer", values=[3, 3]), (f"{P}.values", "[3, 3] are equal", "low < high"), False
    ),
    "bound_of_wrong_type": Bad(
        parameter(parameter_type="real", values=[0, "1"]),
        (f"{P}.values[1]", '"1" is a string', "a number", "Write 1 without"),
    ),
    "bound_not_whole": Bad(
        parameter(parameter_type="integer", values=[0, 1.5]), (f"{P}.values[1]", "1.5 is not whole", "an integer")
    ),
    "three_bounds": Bad(
        parameter(parameter_type="real", values=[0, 1, 2]), (f"{P}.values", "3 items", "a list of 2 numbers")
    ),
    "log_scale_from_zero": Bad(
        parameter(parameter_type="real", values=[0, 1], scale="log"), (f"{P}.values[0]", "not positive", "> 0"), False
    ),
    "log_scale_of_a_categorical": Bad(
        parameter(parameter_type="categorical", values=["a", "b"], scale="log"),
        (f"{P}.scale", "unknown key", "goes with parameter_type real or integer"),
    ),
    "empty_categories": Bad(
        parameter(parameter_type="categorical", values=[]), (f"{P}.values", "0 items", "at least 2 different strings")
    ),
    "duplicate_categories": Bad(
        parameter(parameter_type="categorical", values=["a", "b", "a"]),
        (f"{P}.values", '"a" stands twice', "different"),
    ),
    "category_not_a_string": Bad(
        parameter(parameter_type="categorical", values=[True, False]),
        (f"{P}.values[0]", "true is a truth value", '"true"'),
    ),
    "duplicate_levels": Bad(parameter(parameter_type="ordinal", values=[1, 2, 1]), (f"{P}.values", "1 stands twice")),
    "default_outside_bounds": Bad(
        changed("input_parameters.x.parameter_default", 11),
        ("$.input_parameters.x.parameter_default", "11", "a number from -5 to 10"),
        False,
    ),
    "default_not_a_level": Bad(
        changed("input_parameters.mode.parameter_default", "save"),
        ("$.input_parameters.mode.parameter_default", "'save'", "'fast', 'safe'"),
        False,
    ),
    # priors
    "zero_std": Bad(
        prior("x", type="gaussian", mean=0, std=0), ("$.input_parameters.x.prior.std", "0 is too small", "a number > 0")
    ),
    "negative_std": Bad(
        prior("x", type="mixture", components=[{"mean": 0, "std": -1}]),
        ("$.input_parameters.x.prior.components[0].std", "-1 is too small", "> 0"),
    ),
    "missing_std": Bad(prior("x", type="gaussian", mean=0), ("$.input_parameters.x.prior:", "'std' is missing", "> 0")),
    "unknown_prior": Bad(
        prior("x", type="normal", mean=0, std=1), ("$.input_parameters.x.prior.type", '"normal"', "gaussian, mixture")
    ),
    "weights_of_wrong_length": Bad(
        prior("size", type="weights", weights=[1, 2]),
        ("$.input_parameters.size.prior.weights", "2 weights for the 3 levels", "3 numbers"),
        False,
    ),
    "negative_weight": Bad(
        prior("mode", type="weights", weights=[1, -2]),
        ("$.input_parameters.mode.prior.weights[1]", "-2 is too small", ">= 0"),
    ),
    "all_weights_zero": Bad(
        prior("mode", type="weights", weights=[0, 0]), ("$.input_parameters.mode.prior.weights", "zero", "> 0"), False
    ),
    "gaussian_on_a_categorical": Bad(
        prior("mode", type="gaussian", mean=0, std=1), ("$.input_parameters.mode.prior", "'mode'", "weights"), False
    ),
    "weights_on_a_real": Bad(
        prior("x", type="weights", weights=[1, 2]), ("$.input_parameters.x.prior", "'x'", "gaussian"), False
    ),
    "beta_without_shape": Bad(
        prior("x", type="beta"), ("$.input_parameters.x.prior", "shape", "alpha and beta"), False
    ),
    "prior_for_unknown_parameter": Bad(
        joint({"x": 0, "m": 1}, {"x": 1, "m": 1}),
        ("$.priors[0].components[0].mean.m", "no parameter 'm'", "x, n, size, mode"),
    ),
    "objective_prior_for_unknown_parameter": Bad(
        changed("objectives.0.priors", {"modes": {"type": "weights", "weights": [1, 2]}}),
        ("$.objectives[0].priors.modes", "no parameter 'modes'", "x, n, size, mode", "'mode'"),
    ),
    "objective_prior_without_a_std": Bad(
        changed("objectives.1.priors", {"x": {"type": "gaussian", "mean": 0}}),
        ("$.objectives[1].priors.x", "'std' is missing", "> 0"),
    ),
    "objective_prior_that_does_not_fit": Bad(
        changed("objectives.1.priors", {"size": {"type": "weights", "weights": [1, 2]}}),
        ("$.objectives[1].priors.size.weights", "2 weights for the 3 levels", "3 numbers"),
        False,
    ),
    "prior_free_above_one": Bad(
        changed("acquisition", {"prior_weighting": {"prior_free": 2}}),
        ("$.acquisition.prior_weighting.prior_free", "2 is too large", "<= 1"),
    ),
    "joint_prior_of_a_categorical": Bad(
        joint({"mode": 0}, {"mode": 1}),
        ("$.priors[0].components[0].mean.mode", "'mode' is categorical", "real and integer"),
    ),
    "joint_prior_names_differ": Bad(
        joint({"x": 0, "n": 1}, {"x": 1}), ("$.priors[0].components[0].std", "x", "all of x, n"), False
    ),
    "range_without_end": Bad(
        prior("x", type="uniform", low=2, hihg=3), ("$.input_parameters.x.prior.hihg", "given 3", "'high'")
    ),
    "reversed_range": Bad(
        prior("x", type="uniform", low=3, high=2),
        ("$.input_parameters.x.prior.low", "from 3 to 2 is reversed", "low < high", "Swap"),
        False,
    ),
    "empty_range": Bad(
        prior("x", type="uniform", low=3, high=3),
        ("$.input_parameters.x.prior.low", "from 3 to 3 is empty", "low < high"),
        False,
    ),
    "range_outside_the_bounds": Bad(
        prior("x", type="uniform", low=11),
        ("$.input_parameters.x.prior:", "from 11 to the bound", "'x'", "a number from -5 to 10"),
        False,
    ),
    "range_without_a_level": Bad(
        prior("size", type="uniform", low=17, high=31),
        ("$.input_parameters.size.prior:", "from 17 to 31", "'size'", "16, 32, 64"),
        False,
    ),
    "range_of_a_categorical": Bad(
        prior("mode", type="uniform", low=1),
        ("$.input_parameters.mode.prior:", "'mode' has no order", "weights"),
        False,
    ),
    "range_in_quotes": Bad(
        prior("x", type="uniform", low="1"), ("$.input_parameters.x.prior.low", '"1" is a string', "Write 1 without")
    ),
    "density_of_a_missing_file": Bad(
        density(file="bda.json"), ("$.priors[0].file", "no file 'bda.json'", "CSV file or run folder", "'bad.json'")
    ),
    "density_of_no_file": Bad(density(), ("$.priors[0]:", "no file to take points from", "Add 'file'")),
    "density_of_what_is_no_csv": Bad(density(file="bad.json"), ("$.priors[0].file", "bad.json", "no column 'x'")),
    "density_of_a_folder_that_is_no_run": Bad(
        density(file="."), ("$.priors[0].file", "the folder '.' has no pareto.csv and no history.csv", "a run folder")
    ),
    "unknown_rows": Bad(
        density(file="a.csv", rows="nondominated"),
        ("$.priors[0].rows", '"nondominated"', "non_dominated, best, all", "'non_dominated'"),
    ),
    "rows_best_without_quantile": Bad(
        density(file="a.csv", rows="best"), ("$.priors[0].quantile", "how many", "> 0 and <= 1", '"quantile": 0.1')
    ),
    "quantile_without_rows_best": Bad(
        density(file="a.csv", quantile=0.1), ("$.priors[0].quantile", "not non_dominated", '"rows": "best"')
    ),
    "quantile_of_nothing": Bad(
        density(file="a.csv", rows="best", quantile=0), ("$.priors[0].quantile", "0 is too small", "> 0 and <= 1")
    ),
    "density_of_an_unknown_parameter": Bad(
        density(file="a.csv", parameters=["sice"]), ("$.priors[0].parameters[0]", "no parameter 'sice'", "'size'")
    ),
    "density_of_a_parameter_twice": Bad(
        density(file="a.csv", parameters=["x", "x"]), ("$.priors[0].parameters", '"x" stands twice')
    ),
    "density_for_what_has_a_prior": Bad(
        prior("x", type="beta", shape="decay")[:-1]
        + ', "priors": [{"type": "kde", "file": "a.csv", "parameters": ["x"]}]}',
        ("$.priors[0].parameters[0]", "'x' already has a prior at $.input_parameters.x.prior"),
    ),
    "points_of_an_unknown_parameter": Bad(
        density(points={"sice": [16]}), ("$.priors[0].points.sice", "no parameter 'sice'", "'size'")
    ),
    "points_of_other_parameters": Bad(
        density(points={"x": [1]}, parameters=["n"]), ("$.priors[0].parameters", "the points are of x")
    ),
    "points_of_different_number": Bad(
        density(points={"x": [1, 2], "n": [1]}), ("$.priors[0].points.n", "there are 1 values", "as many"), False
    ),
    "point_outside_the_bounds": Bad(
        density(points={"x": [1, 12]}), ("$.priors[0].points.x[1]", "12", "a number from -5 to 10"), False
    ),
    "point_that_is_null": Bad(
        density(points={"x": [1, None]}), ("$.priors[0].points.x[1]", "null is null", "a number or a string")
    ),
    "bandwidth_factor_zero": Bad(
        density(points={"x": [1]}, bandwidth_factor=0), ("$.priors[0].bandwidth_factor", "0 is too small", "> 0")
    ),
    "negative_point_weight": Bad(
        density(points={"x": [1]}, point_weights=[-1]), ("$.priors[0].point_weights[0]", "-1 is too small", ">= 0")
    ),
    "misspelt_option_of_a_density": Bad(
        density(points={"x": [1]}, bandwith_factor=2), ("$.priors[0].bandwith_factor", "given 2", "'bandwidth_factor'")
    ),
    # objectives
    "unknown_goal": Bad(
        changed("objectives.0.goal", "max"),
        ("$.objectives[0].goal", 'unknown goal "max"', "minimize, maximize", "'maximize'"),
    ),
    "repeated_objective": Bad(
        changed("objectives", REPEATED_OBJECTIVE), ("$.objectives[0].name", "2 objectives", "'cost'", "each name once")
    ),
    "objective_named_as_parameter": Bad(
        changed("objectives.0.name", "x"), ("$.input_parameters.x", "'x'", "each name once")
    ),
    "reserved_name": Bad(changed("objectives.0.name", "trial"), ("$.objectives[0].name", "'trial'", "any other name")),
    "objective_a_string": Bad(
        changed("objectives", ["cost"]),
        ("$.objectives[0]", '"cost" is a string', "an object with name", '{"name": "cost"}'),
    ),
    "objectives_a_string": Bad(changed("objectives", "cost"), ("$.objectives", '"cost" is a string', 'Write ["cost"]')),
    # method
    "unknown_acquisition": Bad(
        changed("acquisition", "ei"), ("$.acquisition.type", '"ei"', "thompson_sampling", "'expected_improvement'")
    ),
    "unknown_surrogate": Bad(changed("surrogate", {"type": "rf"}), ("$.surrogate.type", '"rf"', "'random_forest'")),
    "share_above_one": Bad(
        changed("surrogate", {"type": "random_forest", "max_features": 2}),
        ("$.surrogate.max_features", "2 is too large", "> 0 and <= 1"),
    ),
    "limits_for_unknown_objective": Bad(
        changed("acquisition", {"weights": {"type": "bounding_box", "limits": {"costs": [0, 1], "gain": [0, 1]}}}),
        ("$.acquisition.weights.limits.costs", "no objective 'costs'", "cost, gain", "'cost'"),
    ),
    "reversed_limits": Bad(
        changed("acquisition", {"weights": {"type": "bounding_box", "limits": {"cost": [1, 0], "gain": [0, 1]}}}),
        ("$.acquisition.weights.limits.cost", "reversed", "low < high"),
    ),
    "missing_limits": Bad(
        changed("acquisition", {"weights": {"type": "bounding_box", "limits": {"cost": [0, 1]}}}),
        ("$.acquisition.weights.limits", "'gain' has no limits", "every objective"),
    ),
    # budget and evaluator
    "budget_smaller_than_design": Bad(
        changed("budget", {"evaluations": 5})[:-1] + ', "design_of_experiment": {"number_of_samples": 7}}',
        ("$.design_of_experiment.number_of_samples", "design of 7", "budget of 5", "1 to 5"),
    ),
    "asynchronous_batches": Bad(
        changed("budget", {"asynchronous": True, "batch_size": 2}),
        ("$.budget.asynchronous", "batches of 2", "evaluator.workers"),
    ),
    "asynchronous_confirmation": Bad(
        changed("budget", {"asynchronous": True, "evaluations": 30, "confirm_front": 4}),
        ("$.budget.asynchronous", "the last evaluations confirm the front", "A second run", "earlier_evaluations"),
    ),
    "asynchronous_client": Bad(
        changed("budget", {"asynchronous": True})[:-1] + ', "evaluator": {"type": "client_server"}}',
        ("$.budget.asynchronous", "a client that answers batches"),
    ),
    "asynchronous_batch_function": Bad(
        changed("budget", {"asynchronous": True})[:-1] + ', "evaluator": {"batch": true}}',
        ("$.budget.asynchronous", "a function that takes a whole batch"),
    ),
    "zero_batch_size": Bad(changed("budget", {"batch_size": 0}), ("$.budget.batch_size", "0 is too small", ">= 1")),
    "unknown_evaluator": Bad(
        changed("evaluator", "shell"),
        ("$.evaluator.type", '"shell"', "python, command, client_server, exhaustive, none"),
    ),
    "function_without_module": Bad(
        changed("evaluator", {"type": "python", "function": "evaluate"}),
        ("$.evaluator.function", '"evaluate"', "module:name"),
    ),
    "missing_function": Bad(
        changed("evaluator", {"type": "python"}),
        ("$.evaluator:", "'function' is missing", "module:name", "branin:evaluate"),
    ),
    "module_does_not_import": Bad(
        changed("evaluator", {"type": "python", "function": "no_such_module_here:evaluate"}),
        ("$.evaluator.function", "No module named 'no_such_module_here'"),
        False,
    ),
    "command_as_a_string": Bad(
        changed("evaluator", {"type": "command", "command": "simulate {x}"}),
        ("$.evaluator.command", "is a string", "a list of strings", 'Write ["simulate {x}"]'),
    ),
    "command_not_found": Bad(
        changed("evaluator", {"type": "command", "command": ["no-such-program-here", "{x}"]}),
        ("$.evaluator.command", "no-such-program-here"),
        False,
    ),
    "unknown_placeholder": Bad(
        changed("evaluator", {"type": "command", "command": ["echo", "{mod}"]}),
        ("$.evaluator.command", "mod", "'mode'"),
        False,
    ),
    "negative_time_limit": Bad(
        changed("evaluator", {"timeout_seconds": -1}), ("$.evaluator.timeout_seconds", "-1", "a number > 0 or null")
    ),
    # inheritance
    "extends_itself": Bad(changed("extends", "bad.json"), ("$.extends", "bad.json -> bad.json")),
    "extends_nothing": Bad(changed("extends", "base.jsn"), ("$.extends", '"base.jsn"', "relative to")),
    "extends_a_number": Bad(changed("extends", 3), ("$.extends", "3", "a file name or a list")),
    "null_that_removes_nothing": Bad(
        changed("input_parameters.y", None), ("$.input_parameters.y", "null removes an entry", "Drop it")
    ),
    "null_in_a_joint_prior": Bad(
        changed("priors", [{"type": "mixture", "components": [{"mean": {"x": None}, "std": {"x": 1}}]}]),
        ("$.priors[0].components[0].mean.x", "null removes an entry"),
    ),
    # names and numbers beyond what files and floats can hold
    "newline_in_a_parameter_name": Bad(
        changed("input_parameters.p\n", {"parameter_type": "real", "values": [0, 1]}),
        ("$.input_parameters", '"p\\n"', "letters, digits, _ and -"),
    ),
    "newline_in_an_objective_name": Bad(changed("objectives.0.name", "cost\n"), ("$.objectives[0].name", '"cost\\n"')),
    "newline_in_the_application_name": Bad(changed("application_name", "demo\n"), ("$.application_name", '"demo\\n"')),
    "newline_in_the_function": Bad(
        changed("evaluator", {"type": "python", "function": "a:b\n"}), ("$.evaluator.function", '"a:b\\n"')
    ),
    "integer_beyond_floats": Bad(
        changed("input_parameters.x.values", [0, 10**400]), ("$.input_parameters.x.values[1]", "too large", "finite")
    ),
    "integer_of_many_digits": Bad('{"seed": ' + "9" * 5000 + "}", ("$.seed", "too large", "finite")),
    "integer_beyond_floats_as_a_name": Bad(
        changed("application_name", 10**400), ("$.application_name", "too large", "finite")
    ),
    **{
        f"parameter_named_{name}": Bad(
            changed(f"input_parameters.{name}", {"parameter_type": "real", "values": [0, 1]}),
            (f"$.input_parameters.{name}", f"{{{name}}} stands for something else", f"'{name}_value'"),
        )
        for name in ("python", "params_json", "params_file", "result_file", "trial_dir", "seed", "trial", "replicate")
    },
}
