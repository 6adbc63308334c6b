"""One Gaussian process per objective, in NumPy with closed-form gradients."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hypermap_lite.errors import ScenarioError
from hypermap_lite.quasi_random import quasi_normal
from hypermap_lite.surrogates.base import (
    NO_PERMUTATIONS,
    Conditional,
    Fantasies,
    Field,
    Permutations,
    Posterior,
    Prediction,
    as_prediction,
)
from hypermap_lite.surrogates.beside import with_beside
from hypermap_lite.surrogates.failure_evidence import Densities, likely_failures
from hypermap_lite.surrogates.failures import Failures
from hypermap_lite.surrogates.fitted import Fitted
from hypermap_lite.surrogates.linear_algebra import safe_cholesky, solve_lower
from hypermap_lite.surrogates.marginal_likelihood import (
    REJECTED,
    Hyperparameters,
    HyperPrior,
    MarginalLikelihood,
    fit_hyperparameters,
)
from hypermap_lite.surrogates.noise_free import likelier_without_noise
from hypermap_lite.surrogates.outliers import Start, without_outliers
from hypermap_lite.surrogates.paths import Path
from hypermap_lite.surrogates.process import Process, ProcessField, Standardized
from hypermap_lite.surrogates.tails import FEW, MARGIN, Tails, likely_tail
from hypermap_lite.typing import BoolArray, FloatArray, Rng

FANTASY_JITTER = 1e-8
"""Jitter of the noise-free covariance of fantasies, relative to the output variance."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GaussianProcess:
    """Independent Gaussian processes with a Matern-5/2 kernel, one lengthscale per axis, and a constant mean."""

    noise: bool = True
    """Whether evaluations are noisy; the noise is then learned."""

    restart: bool = False
    """Whether every fit starts from the mode of the priors too, not only those from which later ones start.

    The optimum changes little from one evaluation to the next.
    """

    noise_floor: float = 1e-10
    """Smallest variance of the noise, as a share of the outputs' variance, > 0; of a model without noise, all of it.

    It limits how close to the optimum of a black box without noise the search can come.
    """

    noise_tail: float = 5.0
    """Width of the prior on the log of that variance below its most likely value, exp(-8), > 0; above it is 2.

    The wider, the sooner a black box without noise is taken for one.
    """

    lengthscale_location: float = -0.5
    """Mean of the prior on a log lengthscale in one dimension; 0.5 log(d) is added in d dimensions."""

    lengthscale_width: float = 0.7
    """Standard deviation of that prior, > 0."""

    categorical_prior: bool = True
    """Whether categorical axes have a lengthscale prior of their own, by their number, instead of that of all axes."""

    noise_from_replicates: bool = False
    """Whether the noise of each configuration is taken from its replicates, where there are several, and only a factor
    near one is learned. Rows of one configuration are then one."""

    learn_infeasible: bool = True
    """Whether it is fitted to the objective values of infeasible evaluations, too."""

    compress_tails: bool = True
    """Whether values far beyond those that count are compressed where that makes all values much likelier."""

    ignore_outliers: bool = True
    """Whether evaluations that are far worse than the others foretell are set aside, if the noise is learned."""

    separate_failures: bool = True
    """Whether evaluations in a bad mode of their own are told apart where that makes all of them much likelier."""

    separate_modes: bool = True
    """Whether that is done, too, where the front needs both kinds, if several objectives have an acquisition function
    that knows what to do with two."""

    doubt_noise: bool = False
    """Whether a model without noise takes the place of one with noise where it is likelier."""

    def __post_init__(self) -> None:
        if not 0 < self.noise_floor <= 1:
            raise ScenarioError("$.noise_floor", f"the floor is {self.noise_floor}", allowed="a number > 0, at most 1")
        if not 0 < self.noise_tail < math.inf:
            raise ScenarioError("$.noise_tail", f"the width is {self.noise_tail}", allowed="a number > 0")
        if not math.isfinite(self.lengthscale_location):
            problem = f"the location is {self.lengthscale_location}"
            raise ScenarioError("$.lengthscale_location", problem, allowed="a finite number")
        if not 0 < self.lengthscale_width < math.inf:
            problem = f"the width is {self.lengthscale_width}"
            raise ScenarioError("$.lengthscale_width", problem, allowed="a number > 0")

    @property
    def warm_start_growth(self) -> float:
        """Fits without a restart start from closer ones."""
        return 1.5 if self.restart else 1.2

    def tails(
        self,
        X: FloatArray,
        Y: FloatArray,
        least: FloatArray,
        *,
        is_ordered: BoolArray,
        permutations: Permutations = NO_PERMUTATIONS,
    ) -> Tails:
        """Compare a process of each objective with one of what its `likely_tail` leaves; see `Surrogate.tails`."""
        if not self.compress_tails:
            return (None,) * Y.shape[1]
        prior, found = self._prior(is_ordered, permutations), []
        for y, limit in zip(Y.T, least, strict=True):
            tail = likely_tail(y, float(limit))
            if tail is not None:
                plain, scale = _log_density(X, y, prior, is_ordered, permutations)
                compressed, compressed_scale = _log_density(X, tail.compress(y), prior, is_ordered, permutations)
                distinct = tail.distinct(y)
                by_slope = float(tail.log_slope(distinct).sum()) + len(distinct) * math.log(scale / compressed_scale)
                if not compressed - plain + by_slope >= MARGIN * max(len(y), FEW) or plain <= -REJECTED:
                    tail = None
            found.append(tail)
        return found

    def failures(
        self,
        X: FloatArray,
        Y: FloatArray,
        least: FloatArray,
        corner: FloatArray | None,
        *,
        is_ordered: BoolArray,
        permutations: Permutations = NO_PERMUTATIONS,
        or_needed: bool = False,
    ) -> Failures | None:
        """Compare processes of each objective's successes and failures with one of both; see `Surrogate.failures`."""
        if not self.separate_failures or self.noise_from_replicates:
            return None
        log_density = Densities(
            prior=self._prior(is_ordered, permutations),
            is_ordered=is_ordered,
            permutations=permutations,
            compress_tails=self.compress_tails,
            ignore_outliers=self._has_outliers,
        )
        or_needed = or_needed and self.separate_modes
        return likely_failures(X, Y, least.tolist(), corner, log_density, or_needed=or_needed)

    @property
    def _has_outliers(self) -> bool:
        """Whether there may be any: where the noise is known, each says what it says."""
        return self.ignore_outliers and self._learns_noise

    @property
    def _learns_noise(self) -> bool:
        """Whether the noise is neither known nor none."""
        return self.noise and not self.noise_from_replicates

    def _prior(self, is_ordered: BoolArray, permutations: Permutations) -> HyperPrior:
        return HyperPrior.over(
            is_ordered if self.categorical_prior else np.ones_like(is_ordered),
            permutations,
            has_noise=self.noise,
            noise_floor=self.noise_floor,
            noise_tail=self.noise_tail,
            lengthscale_location=self.lengthscale_location,
            lengthscale_sigma=self.lengthscale_width,
        )

    def fit(
        self,
        X: FloatArray,
        Y: FloatArray,
        *,
        is_ordered: BoolArray,
        rng: Rng,
        start: Sequence[Start] | None = None,
        anew: bool = False,
        permutations: Permutations = NO_PERMUTATIONS,
        noise_variance: FloatArray | None = None,
        n_beside: int = 0,
    ) -> Posterior:
        """Fit each objective's hyperparameters by maximum a posteriori; see `Surrogate.fit`."""
        prior = self._prior(is_ordered, permutations)
        if noise_variance is not None and self.noise:
            prior = prior.of_known_noise()
        n = len(X) - n_beside
        fits: Sequence[Fitted] = []
        for k, y in enumerate(Y[:n].T):
            output = Standardized.of(y)
            known = None if noise_variance is None or not self.noise else output.noise(noise_variance[:n, k])
            likelihood = MarginalLikelihood(X[:n], output.values, is_ordered, prior, permutations, known)
            fits = [*fits, self._fitted(likelihood, output, y, None if start is None else start[k], anew=anew)]
        if n_beside:
            noise_beside = None if noise_variance is None else noise_variance[n:]
            fits = with_beside(fits, X[n:], Y[n:], noise_beside, is_exact=self.restart)
        processes = tuple(fit.process for fit in fits)
        return GaussianProcessPosterior(
            processes=processes,
            may_be_best=np.arange(len(processes[0].X)) < n,
            lacks_noise=tuple(self.noise and not fit.likelihood.prior.has_noise for fit in fits),
        )

    def _fitted(
        self, likelihood: MarginalLikelihood, output: Standardized, y: FloatArray, before: Start | None, *, anew: bool
    ) -> Fitted:
        """Fit one objective, from what a fit to fewer evaluations has found."""
        starts = [] if before is None else [before.hyperparameters]
        if before is None or anew or self.restart:
            starts.append(likelihood.prior.mode())
        if self._has_outliers:
            fit = without_outliers(likelihood, y, starts, before, is_exact=self.restart).fit
        else:
            best = fit_hyperparameters(likelihood, starts, is_exact=self.restart)
            fit = Fitted(output=output, likelihood=likelihood, hyperparameters=best)
        if not (self.doubt_noise and self._learns_noise):
            return fit
        return likelier_without_noise(fit, is_exact=self.restart) or fit


@dataclass(frozen=True, slots=True, kw_only=True)
class GaussianProcessPosterior:
    """What the processes know of m objectives."""

    processes: tuple[Process, ...]

    may_be_best: BoolArray
    """Which of the evaluations may be on the front, shape (n,); the others only inform."""

    lacks_noise: tuple[bool, ...]
    """For which of the m objectives a model without noise was taken in place of one with noise."""

    @property
    def hyperparameters(self) -> tuple[Hyperparameters, ...]:
        """Hyperparameters of each objective."""
        return tuple(p.hyperparameters for p in self.processes)

    @property
    def start(self) -> tuple[Start, ...]:
        """What a fit to more evaluations may start from, by objective."""
        return tuple(
            Start(
                n=len(is_outlier),
                hyperparameters=process.hyperparameters,
                scale=process.output.scale,
                outliers=tuple(np.flatnonzero(is_outlier).tolist()),
            )
            for process, is_outlier in zip(self.processes, self.outliers().T, strict=True)
        )

    @property
    def is_differentiable(self) -> bool:
        """True: all fields carry gradients."""
        return True

    def explained(self) -> FloatArray:
        """Return which share of each objective's variance is explained by the others' evaluations, shape (m,)."""
        return np.array([process.explained(self.may_be_best) for process in self.processes])

    def outliers(self) -> BoolArray:
        """Return which outputs of the n evaluations that count are set aside as outliers, shape (n, m)."""
        nothing = np.zeros(len(self.may_be_best), dtype=bool)
        set_aside = [nothing if p.offsets is None else ~p.offsets.says_something for p in self.processes]
        return np.column_stack(set_aside)[self.may_be_best]

    def predict(self, X: FloatArray) -> Prediction:
        """Predict the noise-free objectives at n points, shape (n, d)."""
        return as_prediction(self.field(X))

    def field(self, X: FloatArray) -> Conditional:
        """Predict the noise-free objectives as a field with one scenario."""
        return combine([p.field_given(p.X, p.L, p.alpha[:, None]) for p in self.processes], X)

    def believe(self, X_pending: FloatArray) -> GaussianProcessPosterior:
        """Return the posterior if the pending points came out at their predicted means (a Kriging believer [1]_).

        References
        ----------
        .. [1] Ginsbourger, Le Riche, Carraro. Kriging Is Well-Suited to Parallelize Optimization. 2010.
        """
        if not len(X_pending):
            return self
        believed = []
        for p in self.processes:
            values = np.concatenate([p.output.values, p.joint(X_pending)[0]])
            X = np.vstack([p.X, X_pending])
            output = replace(p.output, values=values)
            kernel, known, offsets = p.kernel, p.known_noise, p.offsets
            if known is not None:
                known = np.append(known, np.full(len(X_pending), np.median(known)))
            if offsets is not None:
                offsets = offsets.padded(len(X_pending))
            believed.append(
                Process.condition(X, output, p.hyperparameters, kernel.is_ordered, kernel.permutations, known, offsets)
            )
        may_be_best = np.append(self.may_be_best, np.ones(len(X_pending), dtype=bool))
        return replace(self, processes=tuple(believed), may_be_best=may_be_best)

    def fantasies(self, X_pending: FloatArray, n: int, rng: Rng) -> Fantasies:
        """Draw the noise-free objectives at all observed and pending points by quasi-Monte Carlo, jointly [1]_.

        Between the base points each draw is continued by the closed form of a noise-free process.

        References
        ----------
        .. [1] Letham et al. Constrained Bayesian Optimization with Noisy Experiments. Bayesian Analysis, 2019.
        """
        base = np.vstack([self.processes[0].X, X_pending])
        normal = quasi_normal(n, len(base) * len(self.processes), rng).reshape(n, len(self.processes), len(base))
        values, fields = [], []
        for k, p in enumerate(self.processes):
            mean, covariance = p.joint(base)
            root = safe_cholesky(covariance, FANTASY_JITTER)
            draws = mean[:, None] + (root @ normal[:, k].T if root is not None else 0.0) * np.ones((1, n))  # (b, n)
            K = p.hyperparameters.output_variance * p.kernel(base, base)
            L = safe_cholesky(K, FANTASY_JITTER)
            if L is None:
                L = np.eye(len(base)) * 1e6
            weights = solve_lower(L, solve_lower(L, draws - p.mean), transposed=True)
            values.append(p.output.offset + p.output.scale * draws.T)
            fields.append(p.field_given(base, L, weights))
        may_be_best = np.append(self.may_be_best, np.ones(len(X_pending), dtype=bool))
        return Fantasies(values=np.stack(values, axis=2)[:, may_be_best], field=lambda X: combine(fields, X))

    def sample_path(self, rng: Rng, features: int) -> Field:
        """Draw one function: random Fourier features for the prior, corrected by the data (pathwise) [1]_.

        References
        ----------
        .. [1] Wilson et al. Efficiently Sampling Functions from Gaussian Process Posteriors. ICML 2020.
        """
        paths = [Path.draw(p, features, rng) for p in self.processes]

        def field(X: FloatArray) -> Conditional:
            answers = [path(X) for path in paths]
            mean = np.stack([value for value, _ in answers], axis=1)[None]  # (1, n, m)

            def pullback(by_mean: FloatArray, by_std: FloatArray) -> FloatArray:
                return np.sum([by_mean[0, :, k, None] * gradient for k, (_, gradient) in enumerate(answers)], axis=0)

            return Conditional(mean=mean, std=np.zeros_like(mean), pullback=pullback)

        return field


def _log_density(
    X: FloatArray, y: FloatArray, prior: HyperPrior, is_ordered: BoolArray, permutations: Permutations
) -> tuple[float, float]:
    """Return the log density of n standardized outputs and their likeliest hyperparameters; and the outputs' scale."""
    output = Standardized.of(y)
    likelihood = MarginalLikelihood(X, output.values, is_ordered, prior, permutations)
    best = fit_hyperparameters(likelihood, [prior.mode()], is_exact=False)
    return -likelihood(best.to_log())[0], output.scale


def combine(fields: Sequence[ProcessField], X: FloatArray) -> Conditional:
    """Return the predictions of all objectives together."""
    answers = [field(X) for field in fields]
    mean = np.stack([a[0] for a in answers], axis=2)  # (S, n, m)
    std = np.stack([a[1] for a in answers], axis=1)[None]  # (1, n, m)

    def pullback(by_mean: FloatArray, by_std: FloatArray) -> FloatArray:
        std_total = by_std.sum(axis=0)
        return np.sum([a[2](by_mean[:, :, k], std_total[:, k]) for k, a in enumerate(answers)], axis=0)

    return Conditional(mean=mean, std=std, pullback=pullback)
