"""Problems with one objective."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from .base import FloatArray, Problem, one_objective, real_parameters
from .formulas import ackley, beale, branin, hartmann6, rosenbrock, six_hump_camel

SHAPES = (
    lambda X: rosenbrock(X) / 300,
    lambda X: six_hump_camel(X) / 10,
    lambda X: beale(X) / 50,
)
"""What a level of Func2C's categories stands for; further levels of the second one mean the last."""


def func2c(X: FloatArray) -> FloatArray:
    """Return Func2C: two categories choose two functions of two reals, which add up [1]_.

    References
    ----------
    .. [1] Ru, Alvi, Nguyen, Osborne, Roberts. Bayesian Optimisation over Multiple Continuous and Categorical Inputs.
       ICML 2020. Section 5.
    """
    chosen = np.minimum(X[:, :2].astype(int), len(SHAPES) - 1)
    values = np.column_stack([shape(2 * X[:, 2:]) for shape in SHAPES])
    rows = np.arange(len(X))
    return values[rows, chosen[:, 0]] + values[rows, chosen[:, 1]]


def gramacy_lee(X: FloatArray) -> FloatArray:
    """Return a function of one parameter with ten waves on a slope [1]_.

    References
    ----------
    .. [1] Gramacy, Lee. Cases for the Nugget in Modeling Computer Experiments. Statistics and Computing, 2012.
    """
    x = X[:, 0]
    return np.sin(10 * np.pi * x) / (2 * x) + (x - 1) ** 4


HARTMANN6 = Problem(
    function=one_objective(hartmann6), parameters=real_parameters([(0, 1)] * 6), best=-3.3223680114155147
)

SINGLE: Mapping[str, Problem] = {
    "branin": Problem(
        function=one_objective(branin),
        parameters=real_parameters([(-5, 10), (0, 15)]),
        best=0.39788735772973816,
        evaluations=40,
    ),
    "hartmann6": HARTMANN6,
    "hartmann6_noisy": replace(HARTMANN6, noise=0.1),
    "ackley5": Problem(function=one_objective(ackley), parameters=real_parameters([(-15, 20)] * 5), best=0.0),
    "func2c": Problem(
        function=one_objective(func2c),
        parameters={
            "h1": {"parameter_type": "categorical", "values": ["rosenbrock", "camel", "beale"]},
            "h2": {"parameter_type": "categorical", "values": ["rosenbrock", "camel", "beale", "beale2", "beale3"]},
            **real_parameters([(-1, 1)] * 2),
        },
        best=-0.20632569069807788,
    ),
    "gramacy_lee": Problem(
        function=one_objective(gramacy_lee),
        parameters=real_parameters([(0.5, 2.5)]),
        best=-0.8690111349895,
        evaluations=30,
    ),
}
