"""Known values of the truncated Gaussian, and what it refuses."""

import math

import numpy as np
import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors import GaussianPrior
from hypermap_lite.priors.truncated_gaussian import TruncatedNormal
from hypermap_lite.space import CategoricalParameter, RealParameter


def test_half_a_normal_has_twice_its_density() -> None:
    density = TruncatedNormal(0.0, 0.1)  # the bound at 1 is ten standard deviations away
    assert density.log_density(np.array([0.0]))[0] == pytest.approx(math.log(2 / (0.1 * math.sqrt(2 * math.pi))))


def test_the_misleading_radius_prior_of_the_paper_peaks_at_the_bound() -> None:
    density = GaussianPrior(mean=0.09, std=0.01).on(RealParameter(name="Radius", low=0.0, high=0.08))
    assert density.mode() == 1.0
    assert density.cdf(np.array([0.5]))[0] < 1e-5


def test_a_location_forty_deviations_outside_still_samples_and_scores() -> None:
    density = TruncatedNormal(5.0, 0.1)
    u = density.sample(1000, np.random.default_rng(0))
    assert np.isfinite(density.log_density(u)).all()
    # Far in the tail a normal is an exponential with rate distance / variance.
    assert np.mean(1 - u) == pytest.approx(0.1**2 / 4.0, rel=0.1)


def test_a_log_scale_takes_the_mean_in_native_units_and_the_deviation_in_decades() -> None:
    density = GaussianPrior(mean=0.1, std=1.0).on(RealParameter(name="x", low=1e-3, high=10.0, log=True))
    assert (density.location, density.scale) == pytest.approx((0.5, 0.25))


@pytest.mark.parametrize(("mean", "std"), [(0, 0), (0, -1), (0, float("inf")), (float("nan"), 1), ("a", 1), (0, True)])
def test_impossible_numbers_are_refused(mean: object, std: object) -> None:
    with pytest.raises(ScenarioError, match=r"a number > 0|a finite number"):
        GaussianPrior(mean=mean, std=std)


def test_a_category_has_no_place_for_a_mean() -> None:
    with pytest.raises(ScenarioError, match="no numeric axis"):
        GaussianPrior(mean=1, std=1).on(CategoricalParameter(name="c", values=("a", "b")))


def test_a_log_axis_has_no_place_for_a_negative_mean() -> None:
    with pytest.raises(ScenarioError, match="no place on the logarithmic axis"):
        GaussianPrior(mean=-1, std=1).on(RealParameter(name="x", low=1, high=2, log=True))


@pytest.mark.parametrize(("mean", "std"), [(1e308, 1.0), (-1e308, 1e-300), (0.5, 1e308), (0.5, 1e-300), (1e300, 1e300)])
def test_absurd_numbers_still_give_a_density(mean: float, std: float) -> None:
    density = GaussianPrior(mean=mean, std=std).on(RealParameter(name="x", low=0, high=1))
    u = density.sample(100, np.random.default_rng(0))
    assert np.all((u >= 0) & (u <= 1))
    assert np.isfinite(density.log_density(np.array([density.mode()]))).all()
    assert density.cdf(np.array([0.0, 1.0])) == pytest.approx([0.0, 1.0])


def test_weights_are_advised_only_where_there_is_no_numeric_axis() -> None:
    prior = GaussianPrior(mean=-1, std=1)
    with pytest.raises(ScenarioError, match="no numeric axis") as categorical:
        prior.on(CategoricalParameter(name="c", values=("a", "b")))
    with pytest.raises(ScenarioError, match="no place on the logarithmic axis") as logarithmic:
        prior.on(RealParameter(name="r", low=0.1, high=10, log=True))
    assert "weights" in categorical.value.hint
    assert (logarithmic.value.hint, logarithmic.value.allowed) == ("", "> 0")
