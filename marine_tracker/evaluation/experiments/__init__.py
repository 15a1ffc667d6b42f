"""Experiments by name: each module has HELP, RUNS and run(runs, seed, progress) -> Result.

It may have OPTIONS, {name: how argparse is to read --name}: its `run` takes them as keywords.
"""

from types import ModuleType

from . import extended, gwnn, gwnn_monte_carlo, gwnn_paper, hulls, marine_table

EXPERIMENTS: dict[str, ModuleType] = {
    'gwnn': gwnn, 'gwnn_paper': gwnn_paper, 'gwnn_monte_carlo': gwnn_monte_carlo,
    'marine_table': marine_table, 'extended': extended, 'hulls': hulls}
