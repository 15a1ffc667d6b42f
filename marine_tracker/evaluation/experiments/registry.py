"""Experiments by name: each module has HELP, RUNS and run(runs, seed, progress) -> Result.

It may have OPTIONS, {name: how argparse is to read --name}: its `run` takes them as keywords.
"""

from types import ModuleType

from . import (
    alpha_beta,
    compare,
    extended,
    gwnn,
    gwnn_monte_carlo,
    gwnn_paper,
    hulls,
    marine_table,
    rough_nn,
    two_radars,
    wavelet,
)

EXPERIMENTS: dict[str, ModuleType] = {
    'gwnn': gwnn, 'gwnn_paper': gwnn_paper, 'gwnn_monte_carlo': gwnn_monte_carlo,
    'marine_table': marine_table, 'rough_nn': rough_nn, 'wavelet': wavelet,
    'alpha_beta': alpha_beta, 'two_radars': two_radars, 'extended': extended, 'hulls': hulls,
    'compare': compare}
