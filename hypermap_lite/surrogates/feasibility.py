"""How likely a configuration is feasible, learned from which evaluations were."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final, Literal, Protocol, TypeAlias

import numpy as np
from scipy.special import log_ndtr, ndtr

from hypermap_lite.surrogates.base import Permutations
from hypermap_lite.surrogates.expectation_propagation import ExpectationPropagation
from hypermap_lite.surrogates.kernels import MaternHammingKernel
from hypermap_lite.surrogates.laplace import Laplace
from hypermap_lite.surrogates.linear_algebra import solve_lower
from hypermap_lite.surrogates.marginal_likelihood import LENGTHSCALE_BOUNDS, HyperPrior
from hypermap_lite.surrogates.telling_rows import telling_rows
from hypermap_lite.typing import BoolArray, FloatArray

Approximation: TypeAlias = Literal["both", "laplace"]

LOG_SQRT_2PI: Final = 0.5 * math.log(2 * math.pi)
VARIANCE_FLOOR: Final = 1e-9
VARIANCE_BOUNDS: Final = (0.1, 1000.0)
"""Of the latent function."""

DOUBT: Final = 3.0
"""Power of the share of the latent variance that the evaluations leave: how doubtful expectation propagation is.

That is the chance that it is wrong of a point, and the point feasible in spite of it. The chance is next to none where
many were infeasible, and a search that trusts the model to a power still looks for regions out of its reach: without
it, by expectation propagation alone, C2-DTLZ2 ends at 0.76 of the hypervolume instead of 0.97.
"""

MAX_ITERATIONS: Final = 30
MAX_ROWS: Final = 400
"""Evaluations the model rests on; of more, the telling ones are taken."""

MAX_ROWS_OF_FIT: Final = 128
"""Evaluations the hyperparameters are fitted to."""

FEWEST_OF_FIT: Final = 3
"""Feasible ones among them, at least.

One or two among many infeasible ones are most likely a matter of chance, by a fit, and not the tip of a region: the
search then leaves their surroundings for the corners.
"""

SPACING: Final = 0.6
"""Longest lengthscale where nothing is feasible yet, in units of the spacing of the evaluations.

What is feasible must have room between them. With longer ones what the search has left out looks known.
"""

SHARE: Final = 0.75
"""Power of the share of a point's surroundings in the cube: with 1, corners come too late, without it, too soon.

Evaluations after the design to the first feasible one, means over those of 24 seeds whose design has none, 6 to 17 of
them: with this power and `SPACING`; with the power 1 and the prior's lengthscales; of Sobol points.

    Chankong and Haimes, 16 %            1.5   1.7   5.8
    Tanaka et al., 5 % of a square       7.4  17.5  14.5
    a disc of 5 %                        9.0  12.8  12.9
    balls of 7 % in 3, 4 axes            3.7   7.0  10.3;  2.1   4.2   6.0
    corners of 5 % in 2, 3 axes         18.1  15.5  12.5; 12.2  14.2  13.5
    Osyczka and Kundu, six axes         21.0  20.0  28.7
"""


class FeasibilityPosterior(Protocol):
    """What is known of which points are feasible. Immutable."""

    @property
    def is_differentiable(self) -> bool:
        """Whether it has gradients."""
        ...

    def log_probability(self, X: FloatArray) -> FloatArray:
        """Return the log probability that each of n points is feasible, shape (n, d) to (n,)."""
        ...

    def log_probability_with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the log probabilities, shape (n,), and their gradients, shape (n, d)."""
        ...

    def log_novelty(self, X: FloatArray) -> FloatArray:
        """Return the log of how much an evaluation of each of n points would tell, up to a constant, shape (n,)."""
        ...

    def log_novelty_with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the log novelties, shape (n,), and their gradients, shape (n, d)."""
        ...


class FeasibilityModel(Protocol):
    """Options of a model of the feasibility."""

    def fit(
        self, X: FloatArray, is_feasible: BoolArray, *, is_ordered: BoolArray, permutations: Permutations | None = None
    ) -> FeasibilityPosterior:
        """Fit n evaluations, n >= 1, which may all be of one kind.

        Parameters
        ----------
        X
            Points of the unit cube, shape (n, d).
        is_feasible
            Which of them were feasible, shape (n,).
        is_ordered
            Which axes have an order, shape (d,); the others are categorical, or permutations.
        permutations
            The axes without an order whose codes are permutations; None for none.
        """
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class ProbitProcess:
    r"""Gaussian process classification by the Laplace approximation [1]_, and by expectation propagation on request.

    .. math:: P(x \text{ feasible}) = \Phi(\mu(x) / \sqrt{1 + \sigma^2(x)})

    with mean and variance of a latent function, a Matern-5/2 process with one lengthscale per axis around an unknown
    constant. Lengthscales and variance are the most likely ones a posteriori, by the Laplace approximation. If all
    points are feasible, or fewer than `FEWEST_OF_FIT`, which says too little about them, they stay at the mode of their
    priors, and lengthscales below `SPACING` if none is; the probability then rises next to feasible points, falls next
    to infeasible ones and is undecided far away.

    References
    ----------
    .. [1] Rasmussen, Williams. Gaussian Processes for Machine Learning, ch. 3. MIT Press, 2006.
    """

    constant_variance: float = 4.0
    """Prior variance of the latent constant: how unequal the shares of the two kinds may be."""

    variance: float = 4.0
    """Median of the prior of the latent function's variance: large values make steep boundaries."""

    approximation: Approximation = "laplace"
    """What tells the probability once there are feasible points: ``laplace``, or the more cautious of ``both``.

    The Laplace approximation is unsure where everything was infeasible: of a corner with thirty such evaluations it
    says that a tenth of it is feasible, and a search for a better point beyond a constraint comes back to it for ever.
    """

    def fit(
        self, X: FloatArray, is_feasible: BoolArray, *, is_ordered: BoolArray, permutations: Permutations | None = None
    ) -> ProbitPosterior | CautiousPosterior:
        """Fit n evaluations; see `FeasibilityModel.fit`."""
        labels = np.where(is_feasible, 1.0, -1.0)
        theta = self._mode(HyperPrior.over(is_ordered, permutations or {}))
        if is_ordered.any() and not is_feasible.any():
            spacing = len(X) ** (-1 / is_ordered.sum())
            theta[:-1][is_ordered] = np.minimum(theta[:-1][is_ordered], math.log(SPACING * spacing))
        prior = MaternHammingKernel(np.exp(theta[:-1]), is_ordered, permutations or {})
        if is_feasible.sum() >= FEWEST_OF_FIT and not is_feasible.all():
            rows = telling_rows(X, is_feasible, prior, MAX_ROWS_OF_FIT)
            theta = self._fit(theta, Evidence(X[rows], labels[rows], prior, self))
        rows = telling_rows(X, is_feasible, prior, MAX_ROWS)
        kernel = replace(prior, lengthscales=np.exp(theta[:-1]))
        variance = math.exp(theta[-1])
        K = variance * kernel(X[rows], X[rows]) + self.constant_variance
        by_mode = ProbitPosterior(
            X=X[rows],
            kernel=kernel,
            variance=variance,
            constant_variance=self.constant_variance,
            values=Laplace.at(K, labels[rows]),
        )
        if self.approximation == "laplace" or not is_feasible.any():
            return by_mode
        by_moments = replace(by_mode, values=ExpectationPropagation.at(K, labels[rows]), doubt=DOUBT)
        return CautiousPosterior(by_mode, by_moments)

    def evidence(
        self, X: FloatArray, is_feasible: BoolArray, *, is_ordered: BoolArray, permutations: Permutations | None = None
    ) -> tuple[float, float]:
        """Return how likely n labels of both kinds, shape (n,), are, and how well each is foretold by the others.

        The first is the log of their probability and of the hyperparameters' density, at the likeliest ones by
        `MAX_ROWS_OF_FIT` of them; the second the sum of the log probabilities of each label given all others.
        """
        theta = self._mode(HyperPrior.over(is_ordered, permutations or {}))
        kernel = MaternHammingKernel(np.exp(theta[:-1]), is_ordered, permutations or {})
        labels = np.where(is_feasible, 1.0, -1.0)
        rows = telling_rows(X, is_feasible, kernel, MAX_ROWS_OF_FIT)
        theta = self._fit(theta, Evidence(X[rows], labels[rows], kernel, self))
        known = Evidence(X, labels, kernel, self)
        return -known(theta)[0], float(known.laplace(theta).log_left_out(labels).sum())

    def _mode(self, prior: HyperPrior) -> FloatArray:
        """Return the log hyperparameters before any data, shape (d + 1,): lengthscales, variance."""
        return np.log([*prior.mode().lengthscales, self.variance])

    def _fit(self, start: FloatArray, evidence: Evidence) -> FloatArray:
        from scipy.optimize import minimize  # slow to import, and not needed to check a scenario

        bounds = np.log([*[LENGTHSCALE_BOUNDS] * (len(start) - 1), VARIANCE_BOUNDS])
        options = {"maxiter": MAX_ITERATIONS}
        result = minimize(evidence, start, jac=True, method="L-BFGS-B", bounds=bounds, options=options)
        return np.asarray(result.x) if np.isfinite(result.fun) else start


@dataclass(frozen=True, slots=True)
class Evidence:
    """The negative log posterior of the hyperparameters."""

    X: FloatArray
    labels: FloatArray
    kernel: MaternHammingKernel
    """With any lengthscales."""

    model: ProbitProcess

    def laplace(self, theta: FloatArray) -> Laplace:
        """Return the latent function by the log hyperparameters, shape (d + 1,)."""
        kernel = replace(self.kernel, lengthscales=np.exp(theta[:-1]))
        return Laplace.at(math.exp(theta[-1]) * kernel(self.X, self.X) + self.model.constant_variance, self.labels)

    def __call__(self, theta: FloatArray) -> tuple[float, FloatArray]:
        """Return the value and its gradient by the log hyperparameters, shape (d + 1,)."""
        kernel, variance = replace(self.kernel, lengthscales=np.exp(theta[:-1])), math.exp(theta[-1])
        C, H = kernel.parts(self.X, self.X)
        laplace = Laplace.at(variance * C + self.model.constant_variance, self.labels)
        M = laplace.evidence_weights()
        gradient = -variance * np.append(kernel.pull_log_lengthscales(M, C, H, self.X), np.vdot(M, C))
        penalty, slope = self._penalty(theta)
        return penalty - laplace.log_evidence, gradient + slope

    def _penalty(self, theta: FloatArray) -> tuple[float, FloatArray]:
        """Return the negative log prior: that of all lengthscales here, and log variance normal with width 1."""
        mu, sigma = HyperPrior.over(self.kernel.is_ordered, self.kernel.permutations).lengthscale_priors()
        z = (theta[:-1] - mu) / sigma
        excess = theta[-1] - math.log(self.model.variance)
        value = 0.5 * z @ z + theta[:-1].sum() + 0.5 * excess**2
        return float(value), np.append(z / sigma + 1.0, excess)


class LatentValues(Protocol):
    """A normal approximation of the latent values at b evaluations given their labels."""

    @property
    def slope(self) -> FloatArray:
        """The inverse of their prior covariance times their means, shape (b,)."""
        ...

    @property
    def root(self) -> FloatArray:
        """Square root of the precision that each label adds, shape (b,)."""
        ...

    @property
    def L(self) -> FloatArray:  # noqa: N802 - the field's name
        """Cholesky factor of I + root K root, shape (b, b)."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class ProbitPosterior:
    """The latent function given the evaluations."""

    X: FloatArray
    """Evaluations it rests on, shape (n, d)."""

    kernel: MaternHammingKernel
    variance: float
    constant_variance: float
    values: LatentValues
    """Of the latent function at the evaluations."""

    doubt: float = 0.0
    """Of what the model says of a point: a power, see `DOUBT`; 0 for none."""

    @property
    def is_differentiable(self) -> bool:
        """True."""
        return True

    def log_probability(self, X: FloatArray) -> FloatArray:
        """Return the log probability that each of n points is feasible, shape (n,)."""
        latent = self._latent(X)
        z = latent.mean / np.sqrt(1.0 + latent.variance)
        return np.asarray(log_ndtr(z)) if not self.doubt else np.log(ndtr(z) + self._doubt(latent) * ndtr(-z))

    def log_probability_with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the log probabilities, shape (n,), and their gradients, shape (n, d)."""
        latent = self._latent(X)
        width = np.sqrt(1.0 + latent.variance)
        z = latent.mean / width
        if not self.doubt:
            value = np.asarray(log_ndtr(z))
            by_z = np.exp(-0.5 * z * z - LOG_SQRT_2PI - value)
            return value, self._pull(latent, X, by_z / width, -0.5 * by_z * z / width**2)
        doubt = self._doubt(latent)
        probability = ndtr(z) + doubt * ndtr(-z)
        by_z = (1.0 - doubt) * np.exp(-0.5 * z * z - LOG_SQRT_2PI) / probability
        by_variance = self.doubt * doubt * ndtr(-z) / (latent.variance * probability) - 0.5 * by_z * z / width**2
        return np.log(probability), self._pull(latent, X, by_z / width, by_variance)

    def _doubt(self, latent: Latent) -> FloatArray:
        """Return the chance that the model is wrong of n points, shape (n,)."""
        return np.asarray((latent.variance / self._total) ** self.doubt)

    def log_novelty(self, X: FloatArray) -> FloatArray:
        """Return the log of the latent standard deviation times the share of a point's surroundings in the cube, (n,).

        Both are relative to their largest values. The uncertainty alone is largest in the corners, where an
        evaluation says something of a small part of the cube only.
        """
        return 0.5 * np.log(self._latent(X).variance / self._total) + self._log_share(X)[0]

    def log_novelty_with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the log novelties, shape (n,), and their gradients, shape (n, d)."""
        latent, (log_share, slope) = self._latent(X), self._log_share(X)
        value = 0.5 * np.log(latent.variance / self._total) + log_share
        return value, self._pull(latent, X, np.zeros(len(X)), 0.5 / latent.variance) + slope

    @property
    def _total(self) -> float:
        """Variance of the latent function before any evaluation."""
        return self.variance + self.constant_variance

    def _log_share(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the log mass within the cube of normal densities around n points, (n,), to the power `SHARE`.

        And its gradient, (n, d).
        """
        is_ordered, scale = self.kernel.is_ordered, self.kernel.lengthscales
        above, below = (1.0 - X) / scale, X / scale
        share = ndtr(above) - ndtr(-below)
        slope = (np.exp(-0.5 * below**2) - np.exp(-0.5 * above**2)) / (math.sqrt(2 * math.pi) * scale * share)
        return SHARE * np.log(share[:, is_ordered]).sum(axis=1), SHARE * np.where(is_ordered, slope, 0.0)

    def _latent(self, X: FloatArray) -> Latent:
        C, H = self.kernel.parts(X, self.X)
        k = self.variance * C + self.constant_variance  # (n, b)
        v = solve_lower(self.values.L, (k * self.values.root).T)  # (b, n)
        variance = np.maximum(self._total - np.einsum("bn,bn->n", v, v), VARIANCE_FLOOR)
        return Latent(k @ self.values.slope, variance, v, H)

    def _pull(self, latent: Latent, X: FloatArray, by_mean: FloatArray, by_variance: FloatArray) -> FloatArray:
        """Return the gradient by X of a function of mean and variance, shape (n, d)."""
        u = solve_lower(self.values.L, latent.v, transposed=True).T * self.values.root  # (n, b)
        by_k = by_mean[:, None] * self.values.slope - 2.0 * by_variance[:, None] * u
        return self.kernel.pull_coordinates(self.variance * by_k * latent.H, X, self.X)


@dataclass(frozen=True, slots=True)
class CautiousPosterior:
    """The less probable of what two approximations of the same model say of each point.

    The mode is too unsure deep among infeasible evaluations, the moments are too sure of regions without any. The
    novelty is that by the mode.
    """

    by_mode: ProbitPosterior
    by_moments: ProbitPosterior

    @property
    def is_differentiable(self) -> bool:
        """True: but for a kink where both say the same."""
        return True

    def log_probability(self, X: FloatArray) -> FloatArray:
        """Return the log probability that each of n points is feasible, shape (n,)."""
        return np.minimum(self.by_mode.log_probability(X), self.by_moments.log_probability(X))

    def log_probability_with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the log probabilities, shape (n,), and their gradients, shape (n, d)."""
        value, gradient = self.by_mode.log_probability_with_gradient(X)
        other, slope = self.by_moments.log_probability_with_gradient(X)
        return np.minimum(value, other), np.where((value <= other)[:, None], gradient, slope)

    def log_novelty(self, X: FloatArray) -> FloatArray:
        """Return the log of how much an evaluation of each of n points would tell, up to a constant, shape (n,)."""
        return self.by_mode.log_novelty(X)

    def log_novelty_with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the log novelties, shape (n,), and their gradients, shape (n, d)."""
        return self.by_mode.log_novelty_with_gradient(X)


@dataclass(frozen=True, slots=True)
class Latent:
    """The latent function at n points."""

    mean: FloatArray
    variance: FloatArray
    v: FloatArray
    H: FloatArray
