"""Every estimator on every kind of scene."""
