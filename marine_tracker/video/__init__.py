"""Radar video to plots: spokes in, plots with their covariance out."""
