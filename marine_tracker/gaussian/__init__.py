"""Linear algebra of Kalman filters, many at once."""
