"""Paper 004: extended targets by Gaussian processes."""
