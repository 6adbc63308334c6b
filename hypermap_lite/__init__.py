"""Multi-objective Bayesian optimization with user priors, driven by one scenario file."""

__version__ = "0.1.0"
