"""Experiments by name: each module has HELP, RUNS and run(runs, seed) -> figures."""

from . import marine_table

EXPERIMENTS = {'marine_table': marine_table}
