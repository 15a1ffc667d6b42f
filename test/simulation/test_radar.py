import time
from itertools import islice

import numpy as np
import pytest

from marine_tracker.geometry import to_range_bearing, wrap_angle
from marine_tracker.simulation import motion, scenario
from marine_tracker.simulation.radar import simulate

CLEAN = {'range_sigma_m': 0, 'bearing_sigma_deg': 0, 'pd_near': 1, 'pd_far': 1}


def at_rest(range_m, bearing_deg, **more):
    return {'start': {'range_m': range_m, 'bearing_deg': bearing_deg}, 'speed_kn': 0, **more}


def all_plots(loaded, seed=1):
    return [
        np.concatenate(column)
        for column in zip(*(scan.plots[:4] for scan, _ in simulate(loaded, seed)), strict=True)
    ]


def equal(first, second):
    return all(np.array_equal(a, b) for a, b in zip(first, second, strict=True))


def test_revolutions_follow_each_other_at_the_antennas_rate(make_scenario):
    scans = [scan for scan, _ in simulate(make_scenario(duration_s=300), 1)]
    assert len(scans) == 110
    assert np.allclose([scan.end - scan.start for scan in scans], 60 / 22, rtol=1e-9)
    assert [scan.end for scan in scans[:-1]] == [scan.start for scan in scans[1:]]
    for scan in scans:
        assert scan.own_ship.time[[0, -1]] == pytest.approx([scan.start, scan.end])
        assert len(scan.own_ship.time) == 4


def test_plots_are_in_time_order_and_inside_their_revolution():
    for scan, _ in simulate(scenario.load('busy_strait'), 3):
        stamps = scan.plots.time
        assert (np.diff(stamps) >= 0).all()
        assert ((stamps >= scan.start) & (stamps <= scan.end)).all()
        assert (scan.plots.range > 0).all()
        assert ((scan.plots.bearing >= 0) & (scan.plots.bearing < 2 * np.pi)).all()
        if scan.end > 300:
            break


def test_plot_is_where_the_target_was_when_the_beam_pointed_at_it(make_scenario):
    loaded = make_scenario(
        radar=CLEAN | {'range_resolution_m': 0},
        own_ship={
            'course_deg': 10,
            'speed_kn': 25,
            'legs': [{'turn': {'rate_deg_per_s': 2, 'angle_deg': 700}}],
        },
        targets=[
            {
                'start': {'range_m': 900, 'bearing_deg': b},
                'course_deg': 37 * b % 360,
                'speed_kn': 40,
                'name': f'{b}',
            }
            for b in (-20, 5, 80, 170, 181, 290)
        ],
    )
    seen = 0
    for scan, _ in simulate(loaded, 1):
        sweep = 2 * np.pi * (scan.plots.time - scan.start) / (scan.end - scan.start)
        assert wrap_angle(scan.plots.bearing - sweep) == pytest.approx(0, abs=1e-9)
        for stamp, distance, bearing, _ in zip(*scan.plots[:4], strict=True):
            truth, own = loaded.truth_at(stamp), loaded.own_ship_at(stamp)
            true_range, true_bearing = to_range_bearing(truth.position - own.position)
            error = np.hypot(true_range - distance, 900 * wrap_angle(true_bearing - bearing))
            assert error.min() < 1e-5
            seen += 1
    assert seen > 6 * 200


@pytest.mark.parametrize('side, passed', [(1, 0), (-1, 2)])
def test_beam_passes_a_circling_boat_as_often_as_it_laps_it(make_scenario, side, passed):
    # 150 m around own ship at 20 m/s: .133 rad/s with the beam or against it.
    loaded = make_scenario(
        duration_s=60 / 22 * 160,
        radar=CLEAN,
        targets=[
            {
                'start': {'range_m': 150, 'bearing_deg': 45},
                'course_deg': 45 + 90 * side,
                'speed_mps': 20,
                'legs': [{'turn': {'radius_m': 150, 'angle_deg': 3600 * side}}],
            }
        ],
    )
    counts = [len(scan.plots.time) for scan, _ in simulate(loaded, 1)]
    laps = (2 * np.pi * 22 / 60 - side * 20 / 150) * loaded.duration / (2 * np.pi)
    assert sum(counts) == pytest.approx(laps, abs=1)
    assert set(counts) == {1, passed}
    times = all_plots(loaded)[0]
    assert np.diff(times) == pytest.approx(2 * np.pi / (2 * np.pi * 22 / 60 - side * 20 / 150))


@pytest.mark.parametrize('seed', range(4))
def test_no_passage_is_lost_or_doubled_at_north(make_scenario, seed):
    # Oracle: the beam's angle less the target's bearing, unwrapped, passes a multiple of a turn.
    rng = np.random.default_rng(seed)
    targets = [
        {
            'start': {'range_m': rng.uniform(300, 900), 'bearing_deg': rng.uniform(-20, 20)},
            'course_deg': rng.uniform(0, 360),
            'speed_kn': rng.uniform(0, 30),
            'legs': [{'turn': {'rate_deg_per_s': rng.uniform(1, 8), 'angle_deg': 3000}}],
        }
        for _ in range(12)
    ]
    loaded = make_scenario(
        radar=CLEAN | {'range_resolution_m': 0, 'blind_range_m': 0},
        targets=targets,
        own_ship={
            'course_deg': 300,
            'speed_kn': 9,
            'legs': [{'turn': {'rate_deg_per_s': 3, 'angle_deg': -3000}}],
        },
    )
    times = np.linspace(0, loaded.scans * loaded.radar.scan_period, 24001)
    position, _ = motion.locate_ships(loaded.fleet.paths, np.arange(13), times[:, None])
    _, bearing = to_range_bearing(position[:, 1:] - position[:, :1])
    turns = times[:, None] * 22 / 60 - np.unwrap(bearing, axis=0) / (2 * np.pi)
    assert (np.diff(turns, axis=0) > 0).all()
    expected = np.floor(turns[-1] - 1e-9) - np.ceil(turns[0] - 1e-9) + 1
    assert len(all_plots(loaded)[0]) == expected.sum()


def test_target_exactly_north_is_passed_once_a_revolution(make_scenario):
    loaded = make_scenario(
        radar=CLEAN,
        targets=[at_rest(3000, 0), at_rest(3000, 360), at_rest(2000, 1e-14), at_rest(2500, -1e-14)],
    )
    counts = [len(scan.plots.time) for scan, _ in simulate(loaded, 1)]
    assert sum(counts) / len(counts) == pytest.approx(3, abs=0.05)  # the first two are one cell


def test_truth_has_every_target_once_a_scan_at_the_time_of_its_plot(make_scenario):
    loaded = make_scenario(
        radar=CLEAN,
        own_ship={'course_deg': 90, 'speed_kn': 20},
        targets=[
            {'start': {'range_m': 1500, 'bearing_deg': b}, 'course_deg': 200, 'speed_kn': 15}
            for b in (-5, 2, 100)
        ]
        + [at_rest(90000, 0)],
    )
    last = np.full(4, -1.0)
    for scan, truth in simulate(loaded, 1):
        assert truth.target.tolist() == [1, 2, 3, 4]
        assert (truth.time > last).all()
        assert ((truth.time >= scan.start) & (truth.time <= scan.end)).all()
        assert np.isin(scan.plots.time, truth.time).sum() >= min(len(scan.plots.time), 1)
        last = truth.time
        for row, stamp in enumerate(truth.time):
            assert truth.position[row] == pytest.approx(loaded.truth_at(stamp).position[row])


def test_noise_has_the_stated_deviation_and_bias(make_scenario):
    # 12 targets x 440 scans = 5,280 plots: a mean is within 4.5 sd / sqrt(5280), a deviation
    # within 4.5 sd / sqrt(2 x 5280), in all but 7 of a million seeds each.
    loaded = make_scenario(
        duration_s=1200,
        radar={
            'range_sigma_m': 12,
            'bearing_sigma_deg': 0.3,
            'range_bias_m': -20,
            'bearing_bias_deg': 1.5,
            'pd_near': 1,
            'pd_far': 1,
        },
        targets=[at_rest(4000, 30 * k) for k in range(12)],
    )
    _, distance, bearing, _ = all_plots(loaded)
    count = len(distance)
    assert count == 5280
    bearing = np.degrees(bearing) - 1.5
    bearing -= 30 * np.round(bearing / 30)
    for error, mean, sigma in ((distance - 4000, -20, 12), (bearing, 0, 0.3)):
        assert abs(error.mean() - mean) < 4.5 * sigma / np.sqrt(count)
        assert abs(error.std() - sigma) < 4.5 * sigma / np.sqrt(2 * count)


def test_detection_falls_from_near_to_far_and_obeys_the_target(make_scenario):
    # 880 scans a target: 4.5 sd of a share are at most 4.5 sqrt(.25 / 880) = .076.
    ranges = [60, 11112, 16000, 22200]
    loaded = make_scenario(
        duration_s=2400,
        radar={'pd_near': 0.95, 'pd_far': 0.5, 'max_range_nm': 12},
        targets=[at_rest(r, 40 * k + 5) for k, r in enumerate(ranges)]
        + [
            at_rest(22200, 200, pd=0.9),
            at_rest(60, 250, pd_factor=0.5),
            at_rest(900, 300, pd=0),
            at_rest(900, 330, pd=1),
        ],
    )
    bearing = np.degrees(all_plots(loaded)[2])
    share = [
        np.mean(np.abs(bearing - b) < 10) * len(bearing) / 880
        for b in (5, 45, 85, 125, 200, 250, 300, 330)
    ]
    ratio = np.array(ranges) / (12 * 1852)
    expected = [*0.95 * (0.5 / 0.95) ** ratio**4, 0.9, 0.475]
    assert share[:6] == pytest.approx(expected, abs=0.076)
    assert share[6:] == [0, 1]


def test_amplitude_is_over_the_threshold_and_tells_near_from_far(make_scenario):
    loaded = make_scenario(
        radar={'pd_near': 0.98, 'pd_far': 0.5}, targets=[at_rest(2000, 90), at_rest(21000, 180)]
    )
    _, distance, _, amplitude = all_plots(loaded)
    assert amplitude.min() >= 13
    assert amplitude[distance < 5000].mean() > amplitude[distance > 5000].mean() + 5
    assert amplitude.max() < 60


def test_targets_nearer_than_blind_or_beyond_maximum_range_give_no_plot(make_scenario):
    loaded = make_scenario(
        radar={'blind_range_m': 200, 'max_range_nm': 3, 'pd_far': 0.98, 'range_sigma_m': 0},
        targets=[at_rest(r, b) for r, b in ((199, 10), (201, 60), (5555, 110), (5557, 160))],
    )
    distance = all_plots(loaded)[1]
    assert set(np.round(distance)) == {201, 5555}


@pytest.mark.parametrize(
    'second, plots',
    [
        ((3020, 40.0), 1),
        ((3040, 40.0), 2),
        ((3000, 40.9), 1),
        ((3000, 41.1), 2),
        ((3020, 40.5), 1),
        ((3040, 40.5), 2),
    ],
)
def test_two_targets_in_one_resolution_cell_give_one_plot(make_scenario, second, plots):
    loaded = make_scenario(
        radar=CLEAN | {'range_resolution_m': 30, 'beam_width_deg': 1},
        targets=[at_rest(3000, 40), at_rest(*second)],
    )
    for scan, _ in simulate(loaded, 1):
        assert len(scan.plots.time) == plots


def test_merged_plot_lies_between_and_nearer_to_the_stronger_echo(make_scenario):
    loaded = make_scenario(
        duration_s=1200,
        radar=CLEAN | {'range_resolution_m': 30, 'beam_width_deg': 1},
        targets=[at_rest(3000, 40, pd=0.999), at_rest(3020, 40.5, pd=0.6)],
    )
    _, distance, bearing, _ = all_plots(loaded)
    merged = (distance > 3000.001) & (distance < 3019.999)
    assert merged.mean() == pytest.approx(0.6, abs=0.1)  # 4.5 sd of 440 scans
    assert distance[merged].mean() < 3010
    assert np.degrees(bearing) == pytest.approx(40 + 0.025 * (distance - 3000), abs=1e-6)


def test_same_seed_same_plots_to_the_bit_and_other_seed_other_plots(make_scenario):
    loaded, again = (
        make_scenario(duration_s=120, clutter={'uniform': 9, 'sea': 9}) for _ in range(2)
    )
    assert equal(all_plots(loaded, 5), all_plots(again, 5))
    assert not equal(all_plots(loaded, 5)[1:2], all_plots(loaded, 6)[1:2])


def test_clutter_and_missed_plots_leave_the_noise_of_the_others_alone(make_scenario):
    def ranges(**values):
        loaded = make_scenario(targets=[at_rest(4000, 90), at_rest(6000, 200)], **values)
        return [
            scan.plots.range[
                (np.abs(scan.plots.range - 4000) < 150)
                & (np.abs(scan.plots.bearing - np.pi / 2) < 0.1)
            ]
            for scan, _ in simulate(loaded, 9)
        ]

    quiet = ranges(radar={'pd_near': 1, 'pd_far': 1})
    crowded = ranges(radar={'pd_near': 1, 'pd_far': 1}, clutter={'uniform': 50, 'sea': 50})
    poor = ranges(radar={'pd_near': 0.8, 'pd_far': 0.8})
    assert all(alone in among for alone, among in zip(quiet, crowded, strict=True))
    assert sum(len(few) for few in poor) < 0.9 * len(quiet)
    assert all(few in alone for few, alone in zip(poor, quiet, strict=True) if len(few))


def test_own_ship_is_told_truly_where_no_sensor_errors_are_asked_for():
    loaded = scenario.load('encounters')
    for scan, _ in simulate(loaded, 1):
        true = loaded.own_ship_at(scan.own_ship.time)
        assert equal(scan.own_ship, true)


def test_busy_strait_simulates_over_200_scans_in_a_second_of_cpu():
    loaded = scenario.load('busy_strait')
    start = time.process_time()
    scans = sum(1 for _ in zip(range(200), simulate(loaded, 1), strict=False))
    assert scans / (time.process_time() - start) > 200


def test_scenario_of_seven_days_and_hundreds_of_targets_starts_at_once(make_scenario):
    loaded = make_scenario(
        duration_s=7 * 86400, targets=[at_rest(500 + 40 * k, 7 * k % 360) for k in range(400)]
    )
    scan, truth = next(simulate(loaded, 1))
    assert len(truth.target) == 400
    assert 300 < len(scan.plots.time) < 400


DOPPLER = CLEAN | {'radial_speed_sigma_mps': 0, 'range_resolution_m': 0}


def test_radial_speed_is_how_fast_the_target_leaves_a_radar_at_rest(make_scenario):
    """Own ship under way changes nothing: it counts over ground. Oracle: difference of ranges."""
    loaded = make_scenario(
        radar=DOPPLER,
        own_ship={'course_deg': 40, 'speed_kn': 22},
        targets=[
            {
                'start': {'range_m': 3000, 'bearing_deg': b},
                'course_deg': (70 + 2 * b) % 360,
                'speed_kn': 15,
                'name': f'{b}',
            }
            for b in (20, 140, 260)
        ],
    )
    seen = 0
    for scan, _ in simulate(loaded, 1):
        for stamp, bearing, speed in zip(
            scan.plots.time, scan.plots.bearing, scan.plots.radial_speed, strict=True
        ):
            radar_at = loaded.own_ship_at(stamp).position[0]
            before, after = (
                loaded.truth_at(stamp + step).position - radar_at for step in (-0.01, 0.01)
            )
            leaving = (np.hypot(*after.T) - np.hypot(*before.T)) / 0.02
            which = np.abs(wrap_angle(to_range_bearing(after)[1] - bearing)).argmin()
            assert speed == pytest.approx(leaving[which], abs=1e-3)
            seen += 1
    assert seen > 500


def test_radial_speed_has_the_stated_deviation_and_moves_no_other_chance(make_scenario):
    # 5,280 plots, bounds as above.
    def plots(**more):
        loaded = make_scenario(
            duration_s=1200,
            radar={'pd_near': 1, 'pd_far': 1, **more},
            clutter={'uniform': 5},
            targets=[at_rest(4000, 30 * k) for k in range(12)],
        )
        return [scan.plots for scan, _ in simulate(loaded, 1)]

    with_, without = plots(radial_speed_sigma_mps=0.4, max_radial_speed_mps=20), plots()
    assert all(p.radial_speed is None for p in without)
    for one, other in zip(with_, without, strict=True):
        assert equal(one[:4], other[:4])
    speed = np.concatenate([p.radial_speed[np.abs(p.range - 4000) < 100] for p in with_])
    speed = speed[np.abs(speed) < 2.5]  # without the noise plots that lie there
    assert abs(speed.mean()) < 4.5 * 0.4 / np.sqrt(5280)
    assert speed.std() == pytest.approx(0.4, rel=4.5 / np.sqrt(2 * 5280))


def test_false_plots_have_radial_speeds_of_noise_and_of_waves(make_scenario):
    def speeds(**clutter):
        loaded = make_scenario(
            duration_s=1200,
            clutter=clutter,
            radar={'radial_speed_sigma_kn': 1, 'max_radial_speed_mps': 20},
            targets=[at_rest(3000, 0, pd=0)],
        )
        return np.concatenate([scan.plots.radial_speed for scan, _ in simulate(loaded, 1)])

    noise, waves = speeds(uniform=20), speeds(sea=20)
    assert np.abs(noise).max() <= 20
    # Even over 40 m/s: variance 40^2 / 12, of which a sample's differs by sqrt(0.8 / n).
    assert noise.var() == pytest.approx(1600 / 12, rel=4.5 * np.sqrt(0.8 / len(noise)))
    assert waves.std() == pytest.approx(1.0, rel=4.5 / np.sqrt(2 * len(waves)))


@pytest.mark.parametrize(
    'name, plots, ranges, bearings',
    [
        ('busy_strait', 9444, 80714532.38816765, 4505774.05478484),
        ('clean', 240, 1546287.482138929, 3540.10933083906),
        ('encounters', 485, 6453734.031131014, 12959.41089061839),
        ('paper_track', 39, 195239.4980035836, 22.950977314993413),
        ('imo_1', 40, 646332.1724453561, 250.9853558068693),
        ('imazu_05', 76, 1343018.590494042, 165.74607680268014),
    ],
)
def test_plots_of_shipped_scenarios_are_those_of_the_first_release(name, plots, ranges, bearings):
    scans = [scan.plots for scan, _ in islice(simulate(scenario.load(name), 1), 40)]
    assert sum(len(scan.range) for scan in scans) == plots
    assert sum(scan.range.sum() for scan in scans) == pytest.approx(ranges, rel=1e-13)
    assert sum(
        (scan.bearing * np.arange(1, len(scan.range) + 1)).sum() for scan in scans
    ) == pytest.approx(bearings, rel=1e-13)
