"""Experiments by name. Each module has HELP, RUNS and run(runs, seed, progress) -> Result.

A module may have OPTIONS, {name: keywords of argparse for --name}. Its `run` takes the options as
keywords. If `run` takes `workers` too (evaluation.parallel.Workers), the user chooses where its
parts run.
"""

from types import ModuleType

from . import marine_table
from .ais import ais
from .alarms import alarms
from .alpha_beta import alpha_beta
from .clutter import ablation, clutter
from .compare import compare
from .crossings import crossings
from .danger_areas import danger_areas
from .dense import dense
from .extended import extended
from .gwnn import gwnn, leave_one_out, monte_carlo, strangers_rival
from .gwnn_paper import gwnn_paper
from .hulls import hulls
from .rough_nn import rough_nn
from .two_radars import two_radars
from .video import video
from .wavelet import wavelet

EXPERIMENTS: dict[str, ModuleType] = {
    'gwnn': gwnn,
    'gwnn_paper': gwnn_paper,
    'gwnn_monte_carlo': monte_carlo,
    'gwnn_kinds': leave_one_out,
    'gwnn_rival': strangers_rival,
    'marine_table': marine_table,
    'rough_nn': rough_nn,
    'wavelet': wavelet,
    'alpha_beta': alpha_beta,
    'two_radars': two_radars,
    'extended': extended,
    'hulls': hulls,
    'compare': compare,
    'dense': dense,
    'alarms': alarms,
    'video': video,
    'danger_areas': danger_areas,
    'clutter': clutter,
    'ablation': ablation,
    'crossings': crossings,
    'ais': ais,
}
