"""Trains the weights of an estimator again."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path

from ..evaluation import report
from ..files import write_text
from ..networks import gwnn_weights, rough_weights, wavelet_network
from ..parameters import VESSEL_CLASSES
from ..processes import keep_freed_memory
from ..simulation import scenario
from ..training import custom_traffic, gwnn_fusion, gwnn_samples, gwnn_training, rough_training
from .progress_bar import progress_bar

HELP = 'train the weights of an estimator again'
GWNN = """Train the network of `gwnn`.

The training simulates its own tracks and takes some minutes of one processor. It may be stopped at
any time: the same command continues from the checkpoint beside the file (FILE.part). To use the
result, set the tracker's parameters `gwnn_weights` and, if it is not `ship`, `vessel_class`. A
.json file beside the weights describes how they were made.

With --scenario the radar is the scenario's, and the tracks of its targets are added. With --kinds
the vessels move as a file of your own says; marine_tracker/training/custom_traffic.py describes
its form.
"""
ROUGH = """Train the network of `cs_rough_nn`, or that of `cs_bp_nn`.

It learns the process noise of the filter that gives the estimate, as a share of the other filter's
noise. It learns from a grid of samples: no tracks are simulated, and it takes some seconds. The
shipped weights are those of seed 1. A .json file beside the weights describes how they were made.
"""
STAGES = {
    'tracks': 'making tracks',
    'fusion': 'training to weight the filters',
    'spread': 'training to estimate the error',
}


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the command line of `train`."""
    names = parser.add_subparsers(title='estimators', metavar='NAME', required=True)
    _add_gwnn(names.add_parser('gwnn', help='the wavelet network of `gwnn`', description=GWNN))
    _add_rough(
        names.add_parser(
            'rough_nn', help='the networks of `cs_rough_nn` and `cs_bp_nn`', description=ROUGH
        )
    )


def _add_rough(sub) -> None:
    sub.add_argument(
        '--network',
        choices=tuple(rough_weights.NEURONS),
        default='rough',
        help='the rough network, or the plain one (default %(default)s)',
    )
    sub.add_argument('--seed', type=int, default=1, metavar='N', help='random seed (default 1)')
    sub.add_argument(
        '--out', metavar='FILE', help='where the weights go (default cs_NETWORK_nn.npz)'
    )
    report.add_arguments(sub)
    sub.set_defaults(train=_train_rough)


def _add_gwnn(sub) -> None:
    sub.add_argument(
        '--vessel-class',
        choices=VESSEL_CLASSES,
        default='ship',
        help='class of the filters and of the motion (default %(default)s)',
    )
    sub.add_argument(
        '--kinds',
        metavar='FILE',
        type=Path,
        help='file that says how the vessels move, instead of the class',
    )
    sub.add_argument(
        '--without',
        metavar='KIND',
        help='kind of motion to leave out, to see how it does on strangers',
    )
    sub.add_argument(
        '--no-legs',
        action='store_true',
        help='a network that does not see the straight legs; for comparison',
    )
    sub.add_argument(
        '--scenario',
        metavar='NAME|FILE',
        help='scenario that gives the radar, and additional targets',
    )
    sub.add_argument('--seed', type=int, default=1, metavar='N', help='random seed (default 1)')
    sub.add_argument(
        '--out', default='gwnn.npz', metavar='FILE', help='where the weights go (default gwnn.npz)'
    )
    sub.add_argument(
        '--tracks',
        type=int,
        default=gwnn_training.CHUNKS * gwnn_samples.CHUNK,
        metavar='N',
        help='number of tracks, rounded up to full chunks of '
        f'{gwnn_samples.CHUNK} (default %(default)s)',
    )
    sub.add_argument(
        '--steps',
        type=int,
        default=gwnn_training.STEPS,
        metavar='N',
        help='steps of the training (default %(default)s)',
    )
    sub.add_argument(
        '--units',
        choices=(wavelet_network.WAVELET, wavelet_network.TANH),
        default=wavelet_network.WAVELET,
        help='hidden units; plain ones are for comparison (default %(default)s)',
    )
    report.add_arguments(sub)
    sub.set_defaults(train=_train_gwnn)


def run(args: Namespace) -> int:
    """Writes the weights and prints how good they are."""
    if args.seed < 0:
        raise ValueError(f'--seed is {args.seed}; it must not be negative')
    return args.train(args)


def _out(name: str) -> Path:
    """The file for the weights. The description is written beside it."""
    out = Path(name)
    if not out.parent.is_dir():
        raise ValueError(f'--out is {out}; there is no folder {out.parent}')
    if out.suffix == '.json':
        raise ValueError(f'--out is {out}; that name is for the description beside the weights')
    return out


def _describe(out: Path, manifest) -> None:
    write_text(out.with_suffix('.json'), json.dumps(manifest, indent=1) + '\n')


def _train_rough(args) -> int:
    out = _out(args.out or f'cs_{args.network}_nn.npz')
    with progress_bar('training') as show:
        weights = rough_training.train(args.network, args.seed, show)
    manifest = rough_weights.save(out, weights)
    _describe(out, manifest)
    figures = [
        report.Figure('RMS error of the share O on the samples', manifest['rms_error']),
        report.Figure('samples', manifest['samples']),
    ]
    return report.publish(
        f'{out}: {args.network} network {manifest["layout"]}, seed {args.seed}',
        figures,
        args.json,
        manifest,
    )


def _train_gwnn(args) -> int:
    for name in ('tracks', 'steps'):
        if getattr(args, name) < 1:
            raise ValueError(f'--{name} is {getattr(args, name)}; it must be at least 1')
    out = _out(args.out)
    plan = _plan(args)
    keep_freed_memory()
    checkpoint = out.with_name(out.name + '.part')
    with progress_bar(STAGES['tracks']) as show:
        weights = gwnn_training.run(
            plan, checkpoint, lambda stage, done, whole: show(done, whole, STAGES[stage])
        )
    manifest = gwnn_weights.save(out, weights)
    _describe(out, manifest)
    checkpoint.unlink(missing_ok=True)
    figures = [
        report.Figure(f'{cell}: position ratio', ratio, '', None, None, "the bank's IMM")
        for cell, ratio in manifest['ratios'].items()
    ]
    return report.publish(
        f'{out}: {args.vessel_class}, {manifest["tracks"]} tracks, '
        f'{args.steps} steps, seed {args.seed}',
        figures,
        args.json,
        manifest,
    )


def _plan(args) -> gwnn_training.Plan:
    plan = gwnn_training.plan(
        args.vessel_class,
        args.seed,
        chunks=-(-args.tracks // gwnn_samples.CHUNK),
        steps=args.steps,
        layout=gwnn_fusion.LAYOUT._replace(units=args.units),
    )
    waters = plan.waters
    if args.kinds is not None:
        waters = waters._replace(kinds=custom_traffic.read_kinds(args.kinds), steered={})
    if args.without is not None:
        waters = waters.without(args.without)
    if args.scenario is not None:
        waters = custom_traffic.from_scenario(waters, scenario.load(args.scenario))
    return plan._replace(waters=waters, legs=not args.no_legs)
