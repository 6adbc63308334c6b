"""BoTorch as its tutorials have it: a `SingleTaskGP` per outcome with its defaults, and qLogNEI or qLogNEHVI.

10 restarts from 512 raw samples, 128 quasi-Monte-Carlo samples, baseline pruned. Where configurations may be forbidden,
a further outcome, -1 if allowed and 1 if not, is modelled like the others and is the tutorials' outcome constraint.
Spaces with categories have a `MixedSingleTaskGP`; in those and in spaces with integers or lists of values, the search
alternates between reals and the rest.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import torch
from botorch import fit_gpytorch_mll
from botorch.acquisition import AcquisitionFunction, qLogNoisyExpectedImprovement
from botorch.acquisition.multi_objective import IdentityMCMultiOutputObjective
from botorch.acquisition.multi_objective.logei import qLogNoisyExpectedHypervolumeImprovement
from botorch.acquisition.objective import GenericMCObjective
from botorch.models import MixedSingleTaskGP, ModelListGP, SingleTaskGP
from botorch.optim import optimize_acqf, optimize_acqf_mixed_alternating
from botorch.sampling import SobolQMCNormalSampler
from gpytorch.mlls import SumMarginalLogLikelihood
from loop import Evaluate, serve
from torch import Tensor

RESTARTS, RAW_SAMPLES, SAMPLES = 10, 512, 128


class Box:
    """Configurations as points: reals and ordered levels in the unit interval, categories as their positions."""

    def __init__(self, parameters: Mapping[str, Mapping[str, Any]]) -> None:
        self.parameters = parameters
        self._levels = {name: levels(p) for name, p in parameters.items() if p["parameter_type"] != "real"}
        self._step = {
            name: 1.0 if parameters[name]["parameter_type"] == "categorical" else 1.0 / max(len(values) - 1, 1)
            for name, values in self._levels.items()
        }
        self.categories, self.ordered = (
            {
                j: [v * self._step[name] for v in range(len(self._levels[name]))]
                for j, (name, p) in enumerate(parameters.items())
                if p["parameter_type"] in kinds
            }
            for kinds in (("categorical",), ("integer", "ordinal"))
        )
        upper = [self.categories[j][-1] if j in self.categories else 1.0 for j in range(len(parameters))]
        self.bounds = torch.tensor([[0.0] * len(upper), upper], dtype=torch.double)

    def point(self, configuration: Mapping[str, Any]) -> list[float]:
        """Return the point of a configuration."""
        return [self._encoded(name, configuration[name]) for name in self.parameters]

    def _encoded(self, name: str, value: Any) -> float:
        if name in self._levels:
            return self._levels[name].index(value) * self._step[name]
        low, high = self.parameters[name]["values"]
        return (value - low) / (high - low)

    def configuration(self, x: list[float]) -> dict[str, Any]:
        """Return the configuration at a point."""
        return {name: self._decoded(name, u) for name, u in zip(self.parameters, x, strict=True)}

    def _decoded(self, name: str, u: float) -> Any:
        if name in self._levels:
            return self._levels[name][round(u / self._step[name])]
        low, high = self.parameters[name]["values"]
        return low + u * (high - low)


def levels(parameter: Mapping[str, Any]) -> list[Any]:
    """Return the values of a parameter that is not real."""
    values: list[Any] = parameter["values"]
    return list(range(values[0], values[1] + 1)) if parameter["parameter_type"] == "integer" else values


def run(task: Mapping[str, Any], evaluate: Evaluate) -> None:
    """Fit, maximize the acquisition function and evaluate, until the evaluations are used up."""
    warnings.simplefilter("ignore")
    torch.set_num_threads(1)
    torch.manual_seed(task["seed"])
    box = Box(task["parameters"])
    X = [box.point(row["configuration"]) for row in task["design"]]
    Y = [outcomes(task, row["values"], row["is_feasible"]) for row in task["design"]]
    while len(X) < task["evaluations"]:
        points = torch.tensor(X, dtype=torch.double)
        acquisition = acquisition_function(task, fitted(points, torch.tensor(Y, dtype=torch.double), box), points)
        configuration = box.configuration(best_point(acquisition, box))
        values, is_feasible = evaluate(configuration)
        X.append(box.point(configuration))
        Y.append(outcomes(task, values, is_feasible))


def outcomes(task: Mapping[str, Any], values: list[float], is_feasible: bool) -> list[float]:
    """Return what is modelled: the negative objectives, for BoTorch maximizes, and the constraint if there is one."""
    constraint = [-1.0 if is_feasible else 1.0] if task["is_constrained"] else []
    return [-value for value in values] + constraint


def fitted(X: Tensor, Y: Tensor, box: Box) -> ModelListGP:
    """Return a Gaussian process per outcome, with its hyperparameters fitted."""
    if box.categories:
        models = [MixedSingleTaskGP(X, y, cat_dims=list(box.categories)) for y in Y.split(1, dim=1)]
    else:
        models = [SingleTaskGP(X, y) for y in Y.split(1, dim=1)]
    model = ModelListGP(*models)
    fit_gpytorch_mll(SumMarginalLogLikelihood(model.likelihood, model))
    return model


def acquisition_function(task: Mapping[str, Any], model: ModelListGP, X: Tensor) -> AcquisitionFunction:
    """Return log noisy expected improvement, of the hypervolume if there are several objectives."""
    m = len(task["objectives"])
    common: dict[str, Any] = {
        "model": model,
        "X_baseline": X,
        "prune_baseline": True,
        "sampler": SobolQMCNormalSampler(torch.Size([SAMPLES]), seed=task["seed"] + len(X)),
        "constraints": [lambda Z: Z[..., -1]] if task["is_constrained"] else None,
    }
    if m == 1:
        objective = GenericMCObjective(lambda Z, X=None: Z[..., 0])
        return qLogNoisyExpectedImprovement(objective=objective, **common)
    return qLogNoisyExpectedHypervolumeImprovement(
        ref_point=[-r for r in task["reference_point"]],
        objective=IdentityMCMultiOutputObjective(outcomes=list(range(m))),
        **common,
    )


def best_point(acquisition: AcquisitionFunction, box: Box) -> list[float]:
    """Return the maximizer of an acquisition function."""
    settings = {"q": 1, "num_restarts": RESTARTS, "raw_samples": RAW_SAMPLES}
    if box.categories or box.ordered:
        dims = {"cat_dims": box.categories or None, "discrete_dims": box.ordered or None}
        x, _ = optimize_acqf_mixed_alternating(acquisition, bounds=box.bounds, **dims, **settings)
    else:
        options = {"batch_limit": 5, "maxiter": 200}
        x, _ = optimize_acqf(acquisition, bounds=box.bounds, options=options, **settings)
    return x.squeeze(0).tolist()


if __name__ == "__main__":
    serve(run)
