"""Bayesian optimization: model the objectives, maximize the acquisition function, repeat."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hypermap_lite.acquisition.base import AcquisitionContext, Scorer
from hypermap_lite.acquisition.boundary_weighted import BoundaryWeighted
from hypermap_lite.acquisition.feasibility_weighted import FeasibilitySearch, Improving, optimistic_ideal
from hypermap_lite.design.base import InitialDesign
from hypermap_lite.design.random_sampling import RandomSampling
from hypermap_lite.evaluation.outcome import MODEL, NEAR, RANDOM, Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.maximizers.base import MaximizationProblem, are_apart
from hypermap_lite.objectives import MAX_CLOSED_FORM, reference_point_of
from hypermap_lite.optimizers.base import Optimizer
from hypermap_lite.optimizers.boundary import boundary_factor
from hypermap_lite.optimizers.failures import SeparateModels
from hypermap_lite.optimizers.first_feasible import choose, is_in_turn, points_left
from hypermap_lite.optimizers.foreseen import foreseen_reference_point, spread_points
from hypermap_lite.optimizers.guidance import Guidance, Guide
from hypermap_lite.optimizers.initial import InitialPhase
from hypermap_lite.optimizers.method import Method
from hypermap_lite.optimizers.models import MIN_COMPLETED, Models
from hypermap_lite.optimizers.modes import outliers_of
from hypermap_lite.optimizers.next_feasible import attempt, draw_near
from hypermap_lite.optimizers.stagnation import NEXT_TO_NOTHING, draws_at_end, is_in_the_dark, stands_still
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.pareto.ranking import crowding_distances, non_dominated_ranks
from hypermap_lite.priors.beliefs import Belief
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.scalarization.base import Normalization
from hypermap_lite.space.real import FEWEST_CHECKED
from hypermap_lite.surrogates.base import Knowledge, Posterior, Predictor
from hypermap_lite.surrogates.feasibility import FeasibilityPosterior
from hypermap_lite.surrogates.reported import AsReported
from hypermap_lite.typing import FloatArray, Rng

MAX_INCUMBENTS = 8
"""Best points whose surroundings are searched."""

MAX_FRONT_INCUMBENTS = 12
"""The same, where the whole front is looked at."""


class BayesianOptimizer(Optimizer):
    """Suggests the maximum of an acquisition function over a model of the completed evaluations.

    Parameters
    ----------
    history
        Completed trials so far; grows by `tell`.
    prior
        The user's belief over the optimum.
    initial
        The trials before there is a model.
    method
        The parts.
    budget
        Configurations of the whole run; sets the default strength of the prior.
    batch_size
        Configurations suggested at a time.
    seed
        Of the scenario.
    """

    def __init__(
        self,
        history: History,
        *,
        prior: ProductPrior,
        initial: InitialPhase,
        method: Method,
        budget: int,
        seed: int,
        batch_size: int = 1,
        beliefs: Sequence[Belief] = (),
    ) -> None:
        super().__init__(history)
        self._prior = prior
        self._initial = initial
        self._method = method
        self._budget = budget
        self._batch_size = batch_size
        self._seed = seed
        self._separate = SeparateModels(
            history,
            method.surrogate,
            method.feasibility_weighting,
            seed,
            knows_modes=self._has_promises()
            and len(history.objectives) > 1
            and (method.prior_weighting is None or method.prior_weighting.is_factor),
        )
        self._guide = Guide(beliefs or (Belief(prior=prior),), method.prior_weighting, history.space, seed)

    @property
    def _models(self) -> Models:
        """The models by all that is known; of evaluations that are told apart as failures as of infeasible ones."""
        return self._separate.after()

    @property
    def _known(self) -> Knowledge:
        """What is known of the objectives."""
        modes = self._separate.modes()
        return self._models.posterior() if modes is None else modes.known()

    @property
    def _observed(self) -> FloatArray:
        """The objectives of all evaluations that completed in the history of the `_models`, as that is told them."""
        return self._models.told() if self._separate.modes() is None else self.history.Y()

    def posterior(self) -> Posterior:
        """Return what the surrogate knows after the completed evaluations, of which there must be one.

        Of successes, if failures are told apart, and of objectives whose tails are compressed; see `predictor`. One
        model of all evaluations, also where two kinds of them are told apart.
        """
        return self.fitted()[0]

    def predictor(self) -> Predictor:
        """Return what predicts the objectives as they are reported, where an evaluation succeeds."""
        if (modes := self._separate.modes()) is not None:
            return modes.known()
        return AsReported(posterior=self.posterior(), tails=self._models.tails())

    def predictor_of_all(self) -> Predictor:
        """Return what predicts the objectives as they are reported, with the chance that an evaluation fails."""
        return self._separate.with_failures(self.predictor())

    def set_aside(self) -> set[int]:
        """Return the trials that fail or would likely do so if repeated, and those with an outlier."""
        if (modes := self._separate.modes()) is not None:
            return modes.outliers()
        fail = np.flatnonzero(self._separate.fail_likely())
        return outliers_of(self._models) | {self.history.completed[row].trial for row in fail}

    def has_model(self, n: int | None = None) -> bool:
        """Tell whether the first n rows, all by default, are enough for a model: in what the surrogate is fitted to."""
        return self._separate.after(n).n_observed(n) >= MIN_COMPLETED

    def fitted(self) -> tuple[Posterior, FloatArray]:
        """Return the `posterior`, and the points it was fitted to, shape (n, d)."""
        return self._models.posterior(), self._models.observed()[0]

    def _suggest(self, trial: int) -> Suggestion | None:
        if trial < len(self._initial):
            return self._initial.suggestion(trial)
        if self._method.epsilon:
            rng = generator(self._seed, Stream.EXPLORATION, trial)
            if rng.random() < self._method.epsilon:
                return self._drawn_by(RandomSampling(), trial, rng)
        rng = generator(self._seed, Stream.SUGGESTION, trial)
        has_objectives = self.has_model()
        feasibility = self._models.feasibility(searching=None if has_objectives else self.in_flight)
        guidance = self._guidance(trial)
        if guidance.trust == 0.0 and self._lacks_draws(trial):
            drawn = self._drawn_anywhere(trial, guidance)
            if drawn is not None:
                return drawn
        if not guidance.weight and (x := self._near_feasible(rng)) is not None:
            return self._told_of(guidance, trial, x, NEAR, None)
        if has_objectives:
            return self._with_model(trial, rng, feasibility, guidance)
        if feasibility is not None:
            return self._search(trial, rng, feasibility, guidance)
        return self._drawn_by(self._method.fallback, trial, rng)

    def _search(self, trial: int, rng: Rng, feasibility: FeasibilityPosterior, guidance: Guidance) -> Suggestion | None:
        """Return the next point of the search for feasible ones, of which there are too few for a model."""
        scorer: Scorer = FeasibilitySearch(feasibility=feasibility)
        weighting, weight, known = self._method.feasibility_weighting, guidance.weight, self._models.history
        if weighting is not None and weighting.first_feasible == "sobol" and not known.completed and not weight:
            left = points_left(self.history.space, self._seed, self.taken_keys())
            if len(left):
                x, score = choose(left, scorer, in_turn=is_in_turn(trial, guidance))
                return self._told_of(guidance, trial, x, RANDOM if score is None else MODEL, score)
        if weight and self._method.prior_weighting is not None:
            scorer = self._method.prior_weighting.weigh(scorer, guidance.belief.prior, weight)
        return self._by_score(scorer, known.X(), trial, rng, guidance)

    def _near_feasible(self, rng: Rng) -> FloatArray | None:
        """Return a draw next to one of the first feasible points, shape (d,), if that is due."""
        weighting = self._method.feasibility_weighting
        if weighting is None or weighting.next_feasible != "near":
            return None
        X, is_feasible = self.history.feasibility(learn_failed=True)
        k = attempt(is_feasible, len(self.in_flight))
        return None if k is None else draw_near(self.history.space, X[is_feasible], k, self.taken_keys(), rng)

    def _lacks_draws(self, trial: int) -> bool:
        """Tell whether draws all over the space are to make up for those that the design took from a dropped prior.

        What the model knows is where that prior was; the search would go on from a quarter of a design. Late in a run
        it does so all the same.
        """
        weighting = self._method.prior_weighting
        if weighting is None or not weighting.make_up:
            return False
        made = sum(s.phase == RANDOM and s.prior_weight == 0 for s in self._suggestions())
        return 0 < self._initial.n_guided - made <= (self._budget - trial) / 2

    def _drawn_anywhere(self, trial: int, guidance: Guidance) -> Suggestion | None:
        """Return a uniform draw in place of a suggestion without a prior, with what the history says of that."""
        drawn = self._drawn_by(RandomSampling(), trial, generator(self._seed, Stream.ESCAPE, trial))
        return None if drawn is None else guidance.said_of(drawn)

    def _drawn_by(self, design: InitialDesign, trial: int, rng: Rng) -> Suggestion | None:
        """Return a new point of a design instead of one by the model, if possible apart from pending ones; or None."""
        space, taken = self.history.space, self.taken_keys()
        X = design.points(space, self._prior, len(taken) + 1, rng)
        new = X[space.unseen(X, taken)]
        if not len(new):
            return None
        if (is_apart := are_apart(space, new, self._pending_points(), self._method.separation)).any():
            new = new[is_apart]
        return Suggestion(trial=trial, configuration=space.decode(new[:1])[0], phase=RANDOM)

    def _with_model(
        self, trial: int, rng: Rng, feasibility: FeasibilityPosterior | None, guidance: Guidance
    ) -> Suggestion | None:
        """Return the best point by the model, or a draw where the search stands still."""
        context = self._context(rng, feasibility)
        found = self._by_trade_off(context, trial, feasibility, guidance)
        if found is None:
            return None
        promise, suggestion = found
        if guidance.weight or not self._leads_nowhere(promise, context):
            return suggestion
        return self._drawn_anywhere(trial, guidance) or suggestion

    def _leads_nowhere(self, promise: float, context: AcquisitionContext) -> bool:
        """Tell whether it is time for a draw: the model has been of no use, and promises none or knows nothing."""
        if draws_at_end(self._suggestions()) >= self._method.escapes:
            return False
        models = self._models
        if self._has_promises() and is_in_the_dark(models.history, self._observed, self._known):
            return True
        return stands_still(models.history) and (len(self.history.objectives) == 1 or promise < NEXT_TO_NOTHING)

    def _has_promises(self) -> bool:
        """Tell whether acquisition values promise an improvement of an objective or of the hypervolume.

        Those for a drawn trade-off promise nothing that could be found again in the history.
        """
        acquisition, m = self._method.acquisition, len(self.history.objectives)
        return acquisition.is_logarithmic and (m == 1 or (m <= MAX_CLOSED_FORM and not acquisition.is_scalarizing))

    def _by_trade_off(
        self, context: AcquisitionContext, trial: int, feasibility: FeasibilityPosterior | None, guidance: Guidance
    ) -> tuple[float, Suggestion] | None:
        """Return what the best point at a drawn trade-off promises, and the point.

        Weights at which none promises anything may be drawn again.
        """
        rng = context.rng
        has_weights = self._method.acquisition.is_scalarizing and len(self.history.objectives) > 1
        n_draws = 1 + self._method.weights.redraws * has_weights
        best: tuple[float, Suggestion] | None = None
        mean = self._known.predict(context.X).mean
        for k in range(n_draws):
            if k:
                context = replace(context, weights=self._weights(context.normalization, rng))
            scorer = self._less_on_bounds(self._scorer(context, feasibility, guidance), context)
            suggestion = self._by_score(scorer, self._incumbents(context, mean), trial, rng, guidance)
            if suggestion is None:
                break
            promise = math.inf  # of a guided step without redraws nobody asks
            if n_draws > 1 or not guidance.weight:
                promise = self._promise(context, suggestion, feasibility, guidance)
            if best is None or promise > best[0]:
                best = promise, suggestion
            if promise > NEXT_TO_NOTHING:
                break
        return best

    def _promise(
        self,
        context: AcquisitionContext,
        suggestion: Suggestion,
        feasibility: FeasibilityPosterior | None,
        guidance: Guidance,
    ) -> float:
        """Return what the acquisition function alone, without prior and feasibility, thinks of a suggestion.

        Where there are two kinds of evaluations, the chances of both are part of it.
        """
        by_feasibility = self._method.feasibility_weighting
        if not self._method.acquisition.is_logarithmic or suggestion.acquisition_value is None:
            return math.inf
        x = self.history.space.encode([suggestion.configuration])
        if guidance.weight:
            return float(self._method.acquisition.scorer(context)(x)[0])
        if feasibility is None or by_feasibility is None or self._separate.modes() is not None:
            return suggestion.acquisition_value
        return suggestion.acquisition_value - by_feasibility.exponent * float(feasibility.log_probability(x)[0])

    def _weights(self, normalization: Normalization, rng: Rng) -> FloatArray:
        """Draw weights of the objectives; where these are in the user's units, they see what the model sees."""
        models = self._models
        return self._method.weights.sample(self.history.objectives, lambda y: normalization(models.as_told(y)), rng)

    def _scorer(
        self, context: AcquisitionContext, feasibility: FeasibilityPosterior | None, guidance: Guidance
    ) -> Scorer:
        """Return the acquisition function, with the prior and the probability of being feasible where they count."""
        acquisition, weighting = self._method.acquisition, self._method.prior_weighting
        by_feasibility = self._method.feasibility_weighting
        if (modes := self._separate.modes()) is not None and by_feasibility is not None:
            scorer = modes.scorer(acquisition, context, by_feasibility.exponent)
            if weighting is None or not guidance.weight:
                return scorer
            return weighting.weigh(scorer, guidance.belief.prior, guidance.weight)
        if feasibility is not None and not acquisition.is_logarithmic:
            acquisition = Improving(acquisition)
        if weighting is None or not guidance.weight:
            scorer = acquisition.scorer(context)
        else:
            scorer = weighting.scorer(acquisition, context, guidance.belief.prior, guidance.weight)
        return scorer if feasibility is None or by_feasibility is None else by_feasibility.weigh(scorer, feasibility)

    def _less_on_bounds(self, scorer: Scorer, context: AcquisitionContext) -> Scorer:
        """Return the scorer with a discount on the bounds of the space, if what it promised there did not come true."""
        axes, least = self.history.space.is_continuous, self._method.boundary_factor
        if least >= 1 or not self._has_promises() or axes.sum() < FEWEST_CHECKED:
            return scorer
        models = self._models
        mean = self._known.predict(models.history.X()).mean
        factor = boundary_factor(models.history, self._observed, mean, least, self._separate.modes_since())
        return scorer if factor == 1 else BoundaryWeighted(inner=scorer, axes=axes, factor=factor)

    def _by_score(
        self, scorer: Scorer, incumbents: FloatArray, trial: int, rng: Rng, guidance: Guidance
    ) -> Suggestion | None:
        """Return the new point of the best score, near the incumbents or anywhere else."""
        space = self.history.space
        best = self._method.maximizer.maximize(
            MaximizationProblem(
                scorer=scorer,
                space=space,
                prior=guidance.belief.prior,
                incumbents=incumbents,
                seen=self.taken_keys(),
                rng=rng,
                pending=self._pending_points(),
                separation=self._method.separation,
            )
        )
        if best is None:
            return None
        suggestion = self._told_of(guidance, trial, best.x, MODEL, best.score)
        if not isinstance(scorer, BoundaryWeighted):
            return suggestion
        # what the model promises, not what is believed of it
        believed = float(scorer.log_weight(space.encode([suggestion.configuration]))[0])
        return replace(suggestion, acquisition_value=best.score - believed)

    def _told_of(self, guidance: Guidance, trial: int, x: FloatArray, phase: str, value: float | None) -> Suggestion:
        """Return the suggestion of a point, shape (d,), with what the history says of it."""
        configuration = self.history.space.decode(x[None])[0]
        suggestion = Suggestion(trial=trial, configuration=configuration, phase=phase, acquisition_value=value)
        return guidance.said_of(suggestion)

    def _context(self, rng: Rng, feasibility: FeasibilityPosterior | None) -> AcquisitionContext:
        modes = self._separate.modes()
        X, Y = self._models.observed() if modes is None else (self.history.X(), self.history.Y())
        reference_point = reference_point_of(self.history.objectives)
        normalization = Normalization.of_front(Y, reference_point)
        known = self._known
        if feasibility is not None:
            normalization = normalization.reaching(
                optimistic_ideal(known, feasibility, spread_points(self.history.space, rng))
            )
        if reference_point is None and Y.shape[1] > 1 and not self._method.acquisition.is_scalarizing:
            reference_point = foreseen_reference_point(known, feasibility, self._models.history, rng)
        return AcquisitionContext(
            posterior=self._models.posterior() if modes is None else modes.low.posterior(),
            X=X,
            Y=Y,
            X_pending=self._pending_points(),
            scalarization=self._method.scalarization,
            weights=self._weights(normalization, rng),
            normalization=normalization,
            rng=rng,
            reference_point=reference_point,
            iteration=1 + self._n_model_based() // self._batch_size,
        )

    def _n_model_based(self, *, guided: bool = False) -> int:
        """Return the number of model-based suggestions before this one, on request without prior-free ones.

        Evaluations of an earlier experiment beyond the design count as such: a run that goes on from a file weighs the
        prior as one that never stopped.
        """
        chosen = [s.trial for s in self._suggestions() if s.phase == MODEL]
        if guided and not self._guide.is_idle:
            chosen = [trial for trial in chosen if not self._guide.is_free(trial)]
        return self._initial.n_beyond + len(chosen)

    def _pending_points(self) -> FloatArray:
        """Return the configurations under evaluation, shape (p, d)."""
        return self.history.space.encode([s.configuration for s in self.in_flight])

    def _suggestions(self) -> list[Suggestion]:
        """Return all suggestions so far, those under evaluation last."""
        return [*(e.suggestion for e in self.history), *self.in_flight]

    def _guidance(self, trial: int) -> Guidance:
        """Return the part of the prior in a suggestion, decaying with those before it that it had a part in."""
        n_in_all = self._budget - len(self._initial) + self._initial.n_beyond
        return self._guide.guidance(
            trial,
            n=1 + self._n_model_based(guided=True),
            model_budget=max(n_in_all, 1),
            history=list(self.history),
            first=len(self._initial),
            evidence=lambda n: self._separate.after(n).evidence(n),
        )

    def _incumbents(self, context: AcquisitionContext, mean: FloatArray) -> FloatArray:
        """Return the observed points worth refining, shape (k, d), best first by their predicted means, shape (n, m).

        Those of the best scalarization, or those of the front, the loneliest first.
        """
        if self._method.acquisition.is_scalarizing or mean.shape[1] == 1:
            scalars = context.scalarization(context.normalization(mean), context.weights)
            return context.X[np.argsort(scalars, kind="stable")[:MAX_INCUMBENTS]]
        ranks = non_dominated_ranks(mean)
        order = np.lexsort((-crowding_distances(mean, ranks), ranks))
        return context.X[order[:MAX_FRONT_INCUMBENTS]]
