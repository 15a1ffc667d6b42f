"""Experiments: what the papers claim and what of it holds, and comparisons."""
