"""Experiments by name: each module has HELP, RUNS and run(runs, seed) -> figures.

It may have claims(runs, seed) -> report.Claims, printed below the table, and pictures(folder,
runs, seed) -> files drawn, for `--out`. One with DATA, a text, takes `--data FOLDER` and passes it
to `run` as `data`.
"""

from types import ModuleType

from . import gwnn_monte_carlo, gwnn_paper, marine_table

EXPERIMENTS: dict[str, ModuleType] = {
    'marine_table': marine_table, 'gwnn_paper': gwnn_paper, 'gwnn_monte_carlo': gwnn_monte_carlo}
