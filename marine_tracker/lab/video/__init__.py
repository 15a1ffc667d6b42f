"""Plots from radar video beside theory."""
