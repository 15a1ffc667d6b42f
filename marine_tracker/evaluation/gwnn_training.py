"""How the weights of `gwnn` come about: simulated tracks, what the network sees, what is true.

Samples are taken from the same functions that the estimator runs (`gwnn.advance`,
`gwnn_inputs.inputs`, `gwnn.look`), so that training and use cannot drift apart. A sample is what
the network saw after a plot and where the target was at that moment or at a later scan.
"""

import json
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..estimators import bank as filters
from ..estimators import gwnn, gwnn_inputs, linear_modes
from ..networks import adam, gwnn_weights
from ..networks import wavelet_network as net
from ..types import Array, put, take
from . import ship_tracks

SCANS = 110
SPEED = 25.0                    # m/s, the fastest target the tracker is told of
CHUNK = 588                     # tracks made at once, as many of each kind
CHUNKS, STEPS = 40, 18000       # of the shipped training
UNSEEN = 1 << 16                # number of a chunk that is never trained on
FEW = 100                       # samples of a cell that say too little
SAVE_EVERY = 500                # steps
EXPECTED, KNOWN = 0.22, 0.10    # part of the rows sampled a scan: before the plot, after it
NEAREST = 1000.0                # m; nearer tracks are left out ...
CLOSE_SHARE, CLOSE_NEAREST = 0.15, 30.0             # ... but for those of a close-range radar
HARD_SHARE = 0.25
CLIP = 30.0                     # sigma: of the truth from the base
HUBER, VELOCITY_WEIGHT = 10.0, 0.5
MOST = 6.0                      # times the mean: weight of a sample for its noise
BATCH, PEAK, WARM_UP = 1024, 4e-3, 200
REWEIGH_EVERY, REWEIGH_BY = 250, 0.3                # steps between looks at the worst cells
LAYOUT = net.Layout(levels=2, translations=5, q=1.2, outputs=gwnn.OUTPUTS)
SPREAD_LAYOUT = net.Layout(levels=2, translations=2, q=1.2, outputs=gwnn.SPREADS)
SPREAD_STEPS = 4000
SPREAD_LEVEL = (-8.0, 6.0)      # log of the least and the largest variance, sigma^2

Progress = Callable[[str, int, int], None]


class Samples(NamedTuple):
    """n samples, float32.

    seen      [n, I]      the network's inputs
    apart     [n, 13, 4]  experts from the base at the time asked for
    base      [n, 4]      log weights of the base's modes at that time
    scans     [n]         from the last plot to that time
    truth     [n, 4]      from the base
    spread    [n, 4]      log variances of the base
    area      [n]         m^2, mean variance of the plots' coordinates as stated
    cell      [n]         kind, phase, after or before a plot, far or close: `cell_count` numbers
    truly     [n]         true deviation of the plots over the stated one
    """

    seen: Array
    apart: Array
    base: Array
    scans: Array
    truth: Array
    spread: Array
    area: Array
    cell: Array
    truly: Array


def cell_count() -> int:
    """How many kinds of samples are told apart."""
    return 8 * len(ship_tracks.KINDS)


def conditions(count: int, rng):
    """Radars [B], time steps [B, K] s, ranges [B] m to begin at, fastest speeds [B] m/s, and
    which are close [B]."""
    close = rng.random(count) < CLOSE_SHARE
    hard = (rng.random(count) < HARD_SHARE) | close

    def draw(low, high, near_low, near_high):
        return np.where(close, rng.uniform(near_low, near_high, count),
                        rng.uniform(low, high, count))
    some = rng.random((2, count)) < np.array([[0.5], [0.4]])
    period = 60 / np.where(hard, draw(20, 26, 20, 40), 22.0)
    radar = ship_tracks.Radar(
        range_sigma=draw(8, 35, 2, 15), bearing_sigma=np.radians(draw(0.15, 0.5, 0.3, 1.0)),
        detection=np.where(hard, rng.uniform(0.7, 1.0, count), 1.0),
        outliers=np.where(hard & some[0], rng.uniform(0.0, 0.06, count), 0.0),
        truly=np.where(hard & some[1], np.exp(rng.uniform(np.log(0.5), np.log(2.2), count)), 1.0),
        period=period)
    jitter = np.where(hard, rng.uniform(0, 0.06, count), 0.0)[:, None]
    steps = period[:, None] * (1 + jitter * np.clip(rng.standard_normal((count, SCANS)), -3, 3))
    ranges = np.exp(draw(np.log(1500), np.log(18000), np.log(60), np.log(2500)))
    fastest = draw(18, 18, 3, 18)
    return radar, steps, ranges, fastest, close


def make_samples(seed: int, chunk: int) -> Samples:
    """The samples of one chunk of tracks: the same for the same seed and number."""
    rng = np.random.default_rng([seed, chunk])
    radar, steps, ranges, fastest, close = conditions(CHUNK, rng)
    names = list(ship_tracks.KINDS)
    kind = np.arange(CHUNK) % len(names)
    ships = ship_tracks.sail([names[i] for i in kind], ranges, steps, rng, fastest)
    nearest = np.hypot(*np.moveaxis(ships.position, -1, 0)).min(1)
    keep = np.flatnonzero(nearest > np.where(close, CLOSE_NEAREST, NEAREST))
    radar, ships = take(radar, keep), take(ships, keep)
    cell = kind[keep] * 8 + close[keep]
    plots, seen = ship_tracks.observe(ships, radar, rng)
    phase = ship_tracks.phase(ships.manoeuvre)

    bank, memory = filters.begin(plots[0], SPEED), gwnn_inputs.begin(plots[0])
    parts = []
    for k in range(1, SCANS):
        warm = np.flatnonzero(memory.plots >= gwnn.WARM)
        for after, share in ((0, EXPECTED), (1, KNOWN)):
            rows = warm[rng.random(len(warm)) < share]
            if after:
                rows = rows[bank.time[rows] == ships.time[rows, k - 1]]
            if len(rows):
                parts.append(_sample(
                    take(bank, rows), take(memory, rows), take(ships, rows), k - after,
                    take(radar, rows), cell[rows] + 4 * phase[rows, k - after] + 2 * after))
        rows = np.flatnonzero(seen[:, k])
        new_bank, new_memory, _ = gwnn.advance(take(bank, rows), take(memory, rows),
                                               take(plots[k], rows))
        bank, memory = put(bank, rows, new_bank), put(memory, rows, new_memory)
    return join(parts)


def _sample(bank, memory, ships, k, radar, cell) -> Samples:
    """Samples that ask for scan k."""
    time, frame = ships.time[:, k], memory.frame
    ahead = filters.look(bank, time - bank.time)
    at = gwnn.look(bank, frame, ahead, time)
    truth = np.concatenate([ships.position[:, k], ships.velocity[:, k]], 1).T
    off = gwnn_inputs.to_sigma(frame, truth - ahead.mean)
    columns = filters.base(bank, time)
    _, covariance = linear_modes.unpack(columns.T)
    spread = gwnn_inputs.variances(frame, covariance)
    return Samples._make([*(np.ascontiguousarray(array, np.float32) for array in (
        gwnn_inputs.inputs(bank, memory, radar.period), at.apart.transpose(2, 1, 0),
        at.log_weight[:4].T, at.scans, np.clip(off, -CLIP, CLIP).T, np.log(spread).T,
        np.square(frame[:, 2:]).mean(1))),
        cell.astype(np.int16), radar.truly.astype(np.float32)])


def join(parts) -> Samples:
    """All samples of several parts."""
    return Samples(*(np.concatenate(columns) for columns in zip(*parts)))


def standardise(seen):
    """Centre and scale [I] of the inputs.

    Pairs share them and what changes sign is centred on 0, so the symmetries stay exact.
    """
    centre, scale = np.zeros(seen.shape[1], np.float32), np.ones(seen.shape[1], np.float32)
    i = 0
    for kind in gwnn_inputs.KINDS:
        width = 1 if kind in (gwnn_inputs.S, gwnn_inputs.P) else 2
        columns = seen[:, i:i + width]
        if kind in (gwnn_inputs.S, gwnn_inputs.E):
            centre[i:i + width] = columns.mean(dtype=float)
        scale[i:i + width] = np.sqrt(np.square(columns - centre[i]).mean(dtype=float)) + 1e-3
        i += width
    return centre, scale


class Symmetry(NamedTuple):
    """One way to turn or mirror the picture: what changes places, and signs.

    order, sign of the inputs; of a state of four; experts' order.
    """

    inputs: NDArray[np.int64]
    sign: Array
    state: NDArray[np.int64]
    state_sign: Array
    experts: NDArray[np.int64]


def symmetries() -> list[Symmetry]:
    """All eight."""
    return [_symmetry(np.array([x, y]), swap)
            for x in (1, -1) for y in (1, -1) for swap in (False, True)]


def _symmetry(signs, swap) -> Symmetry:
    mirrored = -1 if (signs.prod() < 0) != swap else 1
    order: list[int] = []
    sign: list[float] = []
    for kind in gwnn_inputs.KINDS:
        i = len(order)
        if kind in (gwnn_inputs.S, gwnn_inputs.P):
            order.append(i)
            sign.append(mirrored if kind == gwnn_inputs.P else 1)
            continue
        order += [i + 1, i] if swap else [i, i + 1]
        factor = {gwnn_inputs.V: signs, gwnn_inputs.PV: signs * mirrored,
                  gwnn_inputs.E: np.ones(2)}[kind]
        sign += list(factor)
    experts = np.arange(filters.EXPERTS)
    if mirrored < 0:
        for right, left in filters.TURNS:
            experts[[right, left]] = left, right
    pair = np.array([1, 0] if swap else [0, 1])
    return Symmetry(np.array(order), np.array(sign, np.float32), np.concatenate([pair, pair + 2]),
                    np.tile(signs, 2).astype(np.float32), experts)


def apply(symmetry: Symmetry, batch: Samples) -> Samples:
    """The samples seen in another way."""
    state, sign = symmetry.state, symmetry.state_sign
    modes = symmetry.experts[:4]
    return batch._replace(
        seen=batch.seen[:, symmetry.inputs] * symmetry.sign,
        apart=batch.apart[:, symmetry.experts][:, :, state] * sign,
        base=batch.base[:, modes], truth=batch.truth[:, state] * sign,
        spread=batch.spread[:, state])


def fuse(output, batch: Samples):
    """Corrections [n, 4] as `gwnn.fuse` makes them, with the experts' weights [n, 13]."""
    log_weight = np.full((len(output), filters.EXPERTS), gwnn.OTHERS, np.float32)
    log_weight[:, :4] = batch.base
    log_weight += output[:, gwnn.LOGITS]
    weight = np.exp(log_weight - log_weight.max(1, keepdims=True))
    weight /= weight.sum(1, keepdims=True)
    out = np.matmul(weight[:, None], batch.apart)[:, 0]
    out[:, :2] += output[:, gwnn.AT_ONCE] + batch.scans[:, None] * output[:, gwnn.PER_SCAN]
    out[:, 2:] += output[:, gwnn.OF_VELOCITY]
    return out, weight


def fuse_backward(gradient, out, weight, batch: Samples):
    """Gradient [n, 19] by the network's outputs, from that by the corrections [n, 4]."""
    back = np.zeros((len(gradient), gwnn.OUTPUTS), np.float32)
    mixed = np.matmul(weight[:, None], batch.apart)[:, 0]
    toward = np.matmul(batch.apart, gradient[:, :, None])[..., 0]
    back[:, gwnn.LOGITS] = weight * (toward - (mixed * gradient).sum(1, keepdims=True))
    back[:, gwnn.AT_ONCE] = gradient[:, :2]
    back[:, gwnn.PER_SCAN] = gradient[:, :2] * batch.scans[:, None]
    back[:, gwnn.OF_VELOCITY] = gradient[:, 2:]
    return back


def cell_weights(samples: Samples):
    """[n, 2] for position and velocity: each cell counts by its error relative to the base's.

    Velocity errors are to be small in m/s, not in sigma: within its cell a sample of noisy plots
    counts more.
    """
    size = np.square(samples.truth.astype(float)).reshape(-1, 2, 2).sum(2)
    size = np.minimum(size / samples.truly[:, None] ** 2, 40.0)
    share = np.ones_like(size)
    share[:, 1] = np.minimum(samples.area / _mean_by_cell(samples.area, samples.cell), MOST)
    out = np.empty((len(samples.cell), 2), np.float32)
    for j in (0, 1):
        mean = _mean_by_cell(share[:, j] * size[:, j], samples.cell)
        out[:, j] = share[:, j] / (mean * samples.truly ** 2)
    return out


def _mean_by_cell(values, cell):
    """The mean [n] of the values [n] over each one's cell."""
    count = np.maximum(np.bincount(cell, minlength=cell_count()), 1)
    return (np.bincount(cell, values, cell_count()) / count)[cell]


class Training(NamedTuple):
    """All that the training of the fusion network goes on from.

    network; moments of Adam; emphasis [cells, 2]: log weights of the cells for position and
    velocity; size and against [cells, 2]: running squared errors, the network's and the base's.
    """

    network: net.Network
    moments: adam.Moments
    emphasis: Array
    size: Array
    against: Array


def begin(samples: Samples, seed: int) -> Training:
    """An untrained network for these samples."""
    rng = np.random.default_rng([seed, 1 << 20])
    centre, scale = standardise(samples.seen)
    network = net.start(LAYOUT, centre, scale, rng)
    cells = np.zeros((cell_count(), 2))
    return Training(network, adam.start([network.inner, network.outer, network.bias]), cells,
                    cells.copy(), cells + 1e-9)


def train(training: Training, samples: Samples, seed: int, steps: int, until: int) -> Training:
    """Steps of Adam from where the training stands up to step `until` of `steps`.

    The network's and the moments' arrays are changed in place.
    """
    network, moments, emphasis, size, against = training
    parameters = [network.inner, network.outer, network.bias]
    form = net.units(network.layout, np.float32)
    ways, weights = symmetries(), cell_weights(samples)
    velocity = np.array([1, VELOCITY_WEIGHT], np.float32)
    for step in range(moments.steps, until):
        rng = np.random.default_rng([seed, 1 << 20, step])
        pick = rng.integers(0, len(samples.cell), BATCH)
        batch = apply(ways[rng.integers(8)], take(samples, pick))
        layer = net.squash(network, batch.seen)
        value, tanh = net.hidden(form, layer @ network.inner)
        output = value @ net.connect(network.outer) + network.bias
        out, weight = fuse(output, batch)
        error = out - batch.truth
        length = np.sqrt(np.square(error).reshape(-1, 2, 2).sum(2))
        own = weights[pick]
        factor = np.minimum(1, HUBER / np.sqrt(own) / np.maximum(length, 1e-6)) * own
        cell = batch.cell
        for j in (0, 1):
            old = np.square(batch.truth[:, 2 * j:2 * j + 2]).sum(1)
            size[:, j] += np.bincount(cell, own[:, j] * np.minimum(length[:, j] ** 2, 100),
                                      cell_count())
            against[:, j] += np.bincount(cell, own[:, j] * np.minimum(old, 100), cell_count())
        factor *= np.exp(emphasis[cell]) * velocity / BATCH
        gradient = (error * np.repeat(factor, 2, 1)).astype(np.float32)
        gradients = net.backward(network, form, layer, value, tanh,
                                 fuse_backward(gradient, out, weight, batch))
        moments = adam.step(parameters, gradients, moments,
                            adam.cosine(step, steps, PEAK, WARM_UP))
        if (step + 1) % REWEIGH_EVERY == 0:
            emphasis = emphasize(emphasis, size, against)
            size *= 0.5
            against *= 0.5
    return Training(network, moments, emphasis, size, against)


def emphasize(emphasis, size, against):
    """More weight for the cells where the network gains least on the base."""
    known = against[:, 0] > 1e-3
    ratio = np.sqrt(size / np.maximum(against, 1e-9))
    moved = emphasis + REWEIGH_BY * (ratio - ratio[known].mean(0))
    moved = np.clip(moved, -1.2, 2.0)
    return np.where(known[:, None], moved - moved[known].mean(0), 0.0)


def train_spread(network: net.Network, samples: Samples, seed: int, steps: int) -> net.Network:
    """The network that says how far the fusion network is off, by Gaussian likelihood."""
    rng = np.random.default_rng([seed, 1 << 21])
    pick = np.sort(rng.permutation(len(samples.cell))[:300000])
    samples = take(samples, pick)
    error = np.concatenate([
        fuse(net.forward(network, part.seen), part)[0] - part.truth
        for part in (take(samples, slice(i, i + 10000)) for i in range(0, len(pick), 10000))])
    square = np.minimum(error * error, 100.0)
    spread = net.start(SPREAD_LAYOUT, network.centre, network.scale, rng)
    parameters = [spread.inner, spread.outer, spread.bias]
    form, ways = net.units(SPREAD_LAYOUT, np.float32), symmetries()
    moments = adam.start(parameters)
    for step in range(steps):
        pick = rng.integers(0, len(square), BATCH // 2)
        way = ways[rng.integers(8)]
        batch, off = apply(way, take(samples, pick)), square[pick][:, way.state]
        layer = net.squash(spread, batch.seen)
        value, tanh = net.hidden(form, layer @ spread.inner)
        ratio = value @ net.connect(spread.outer) + spread.bias
        part = np.minimum(batch.scans, 1.0)[:, None]
        level = batch.spread + ratio[:, :4] + part * (ratio[:, 4:] - ratio[:, :4])
        slope = np.clip(0.5 * (1 - off * np.exp(-np.clip(level, *SPREAD_LEVEL))), -5, 0.5)
        slope /= len(pick)
        back = np.concatenate([slope * (1 - part), slope * part], 1).astype(np.float32)
        moments = adam.step(parameters, net.backward(spread, form, layer, value, tanh, back),
                            moments, adam.cosine(step, steps, 3e-3, WARM_UP))
    return spread


def judge(weights: gwnn_weights.Weights, seed: int) -> dict[str, float]:
    """RMS position error over the base IMM's, by kind and phase, on tracks not trained on."""
    samples = make_samples(seed, UNSEEN)
    out, _ = fuse(net.forward(weights.fusion, samples.seen), samples)
    before = samples.cell % 4 < 2
    size, against = (np.square(error[:, :2]).sum(1) for error in (out - samples.truth,
                                                                  samples.truth))
    ratios = {}
    for i, kind in enumerate(ship_tracks.KINDS):
        for phase, name in enumerate(('straight', 'manoeuvre')):
            chosen = before & (samples.cell // 8 == i) & (samples.cell // 4 % 2 == phase)
            if chosen.sum() > FEW:
                ratios[f'{kind}, {name}'] = round(
                    float(np.sqrt(size[chosen].mean() / against[chosen].mean())), 3)
    return ratios


def run(seed: int, chunks: int, steps: int, checkpoint: Path,
        progress: Progress = lambda stage, done, whole: None) -> gwnn_weights.Weights:
    """The whole training; goes on from the checkpoint file where there is one.

    Raises ValueError where the checkpoint is of another training, or is damaged.
    """
    settings = {'seed': seed, 'chunks': chunks, 'steps': steps, 'layout': list(LAYOUT),
                'inputs': gwnn_inputs.COUNT, 'filters': filters.settings()}
    training = _resume(checkpoint, settings)
    parts = []
    for chunk in range(chunks):
        progress('tracks', chunk, chunks)
        parts.append(make_samples(seed, chunk))
    samples = join(parts)
    del parts
    training = training or begin(samples, seed)
    for step in range(training.moments.steps, steps, SAVE_EVERY):
        progress('fusion', step, steps)
        training = train(training, samples, seed, steps, min(step + SAVE_EVERY, steps))
        _save(checkpoint, settings, training)
    progress('spread', 0, 1)
    spread = train_spread(training.network, samples, seed, SPREAD_STEPS)
    weights = gwnn_weights.Weights(training.network, spread, {
        'made_by': 'marine_tracker train gwnn', 'seed': seed, 'steps': steps,
        'tracks': chunks * CHUNK, 'samples': len(samples.cell), 'kinds': list(ship_tracks.KINDS),
        'inputs': gwnn_inputs.COUNT, 'hidden': len(training.network.inner.T),
        'filters': filters.settings()})
    progress('spread', 1, 1)
    return weights._replace(manifest={**weights.manifest, 'ratios': judge(weights, seed)})


def _state(training: Training) -> dict[str, Array]:
    """All arrays of a training, by name."""
    arrays = {name: getattr(training.network, name) for name in gwnn_weights.ARRAYS}
    for kind in ('mean', 'square'):
        for i, array in enumerate(getattr(training.moments, kind)):
            arrays[f'{kind}{i}'] = array
    return arrays | {'emphasis': training.emphasis, 'size': training.size,
                     'against': training.against}


def _save(path: Path, settings, training: Training) -> None:
    """Write a checkpoint; whoever stops the process meanwhile leaves the last one whole."""
    fresh = path.with_name(path.name + '.new')
    with open(fresh, 'wb') as file:
        np.savez(file, settings=np.array(json.dumps(settings)),
                 steps=np.array(training.moments.steps),
                 **_state(training))                                # type: ignore[arg-type]
    fresh.replace(path)


def _resume(path: Path, settings) -> Training | None:
    if not path.exists():
        return None
    try:
        with np.load(path, allow_pickle=False) as file:
            found = {name: file[name] for name in file.files}
        other = json.loads(str(found['settings']))
        network = net.Network._make([*(found[name] for name in gwnn_weights.ARRAYS), LAYOUT])
        mean, square = ([found[f'{kind}{i}'] for i in range(3)] for kind in ('mean', 'square'))
        moments = adam.Moments(mean, square, int(found['steps']))
        training = Training(network, moments, found['emphasis'], found['size'], found['against'])
    except (ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise ValueError(f'checkpoint {path} is damaged: remove it') from error
    if other != settings:
        raise ValueError(f'checkpoint {path} is of another training, {other}; remove it, or '
                         'train with its settings')
    return training
