"""Paper 001: two filters joined by a rough neural network."""
