import numpy as np
import pytest

from marine_tracker.parameters import VideoParameters
from marine_tracker.types import OwnShip, Sweep
from marine_tracker.video import placing
from marine_tracker.video.chain import Chain, run

SHIPS = ((1500.0, 40.0, 32.0), (3300.0, 200.0, 30.0))


def as_sweep(spokes, heading=0.0):
    samples = spokes.strength.shape[1]
    angle = np.mod(spokes.bearing - heading, 2 * np.pi)
    count = len(spokes.time)
    return Sweep(
        spokes.time, angle, np.full(count, heading), spokes.range_step * samples, spokes.strength
    )


def at_rest(*_):
    return OwnShip(np.array([0.0, 60.0]), np.zeros((2, 2)), np.zeros((2, 2)))


def scans_of(pictures, size, revolutions=4, width=2 * np.pi, shift=0.0):
    picture = pictures.turned(pictures.make(SHIPS), revolutions)
    parts = [as_sweep(part, 1.1) for part in pictures.cut(picture, size)]
    chain = Chain(VideoParameters(beam_width_deg=2.4, pulse_length_m=30.0), width)
    return list(run(chain, parts, at_rest))


@pytest.mark.parametrize('size', [90, 900, 3600])
def test_scans_are_revolutions_with_each_ship_once(pictures, size):
    scans = scans_of(pictures, size)
    assert len(scans) in (4, 5)
    for scan in scans[1:3]:
        assert scan.end - scan.start == pytest.approx(2.5, abs=0.3)
        assert len(scan.plots.time) == 2
        assert (scan.plots.time >= scan.start - 1e-9).all()
        assert (scan.plots.time <= scan.end).all()
        assert scan.plots.covariance.shape == (2, 2, 2)
    assert sum(len(scan.plots.time) for scan in scans) == 8


def test_scans_may_be_sectors(pictures):
    scans = scans_of(pictures, 45, width=2 * np.pi / 8)
    assert len(scans) > 24 and sum(len(scan.plots.time) for scan in scans) == 8
    assert all(a.end == b.start for a, b in zip(scans, scans[1:-1]))
    for scan in scans[3:20]:
        assert scan.sector.angle == pytest.approx(2 * np.pi / 8)
        inside = np.mod(scan.plots.bearing - scan.sector.bearing, 2 * np.pi)
        assert (inside < scan.sector.angle + 0.02).all()


def test_own_ship_has_the_heading_that_the_radar_told(pictures):
    scan = scans_of(pictures, 128)[2]
    assert scan.own_ship.heading == pytest.approx([1.1, 1.1])


def bad_sweeps(pictures):
    one = as_sweep(pictures.make(SHIPS))
    count = len(one.time)
    later = one._replace(time=one.time + 2.5)
    some = np.r_[0:300, 500:900]
    yield 'spokes missing', later._replace(**{k: v[some] for k, v in later._asdict().items()})
    yield 'doubled', Sweep(*(np.repeat(column, 2, 0) for column in later))
    yield 'backwards', Sweep(*(column[::-1] for column in later))
    yield 'out of order', Sweep(*(c[np.random.default_rng(1).permutation(count)] for c in later))
    yield 'shorter', later._replace(strength=later.strength[:, :60])
    yield 'one sample', later._replace(strength=later.strength[:, :1])
    yield 'range 0', later._replace(range=np.zeros(count))
    yield 'heading nan', later._replace(heading=np.full(count, np.nan))
    yield 'heading jumps', later._replace(heading=np.random.default_rng(2).uniform(0, 6, count))
    yield 'full', later._replace(strength=np.full_like(later.strength, 255))
    yield 'one spoke', Sweep(*(column[:1] for column in later))
    yield 'none', Sweep(*(column[:0] for column in later))
    yield 'time nan', later._replace(time=np.full(count, np.nan))
    yield 'many', Sweep(*(np.tile(c, (12, 1) if c.ndim > 1 else 12)[:10_000] for c in later))
    yield '16 bits', later._replace(strength=later.strength.astype(np.uint16) * 256)
    yield (
        'noise',
        later._replace(
            strength=np.random.default_rng(3).integers(0, 256, later.strength.shape, np.uint8),
            range=np.random.default_rng(4).uniform(0, 1e5, count),
            angle=np.random.default_rng(5).uniform(-9, 9, count),
        ),
    )


def test_bad_video_loses_nothing_of_what_comes_after(pictures):
    """Before and after it the same ships are seen."""
    good = as_sweep(pictures.make(SHIPS))
    for name, bad in bad_sweeps(pictures):
        chain = Chain(VideoParameters(beam_width_deg=2.4, pulse_length_m=30.0))
        memory = chain.start()
        memory, _ = chain.step(memory, good, at_rest())
        memory, _ = chain.step(memory, bad, at_rest())
        plots = []
        for k in range(14, 17):
            later = good._replace(time=good.time + 2.5 * k)
            memory, done = chain.step(memory, later, at_rest())
            plots += [found.plots for found in done.found]
        ranges = np.concatenate([one.range for one in plots])
        for range_, _, _ in SHIPS:
            assert (np.abs(ranges - range_) < 20).sum() >= 2, name


def test_a_wrong_range_is_counted_and_all_else_is_told(pictures):
    chain = Chain(VideoParameters())
    sweep = as_sweep(pictures.make(SHIPS))
    _, done = chain.step(chain.start(), sweep._replace(range=sweep.range * 0), at_rest())
    assert done.counts == {placing.BAD_RANGE: 900} and not done.placed
