"""Monte Carlo trials of the estimator `gwnn`."""
