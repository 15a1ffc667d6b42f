import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from marine_tracker.evaluation import metrics
from marine_tracker.recording.csv_folder import Recording
from marine_tracker.recording.track_file import TrackRows
from marine_tracker.types import OwnShip, PolarPlots, Scan, Truth

SCANS, PERIOD, SPEED = 20, 2.5, 5.0
NORTH = {1: 1000.0, 2: 3000.0}  # m, where the targets start; both go north at SPEED


def world(
    targets=(1,), plotted=(1, 2), bias_deg=0.0, delay=0.0, known_velocity=True, north=NORTH, **notes
):
    """Targets that go north from a radar at rest; `delay` s after the scan's time they are seen.

    Two plots in every scan set the ranges that the radar sees, 100 and 5000 m.
    """
    scans, truths = [], []
    for k in range(SCANS):
        time = PERIOD * k
        y = np.array([north[target] + SPEED * (time + delay) for target in targets])
        seen = np.isin(targets, plotted)
        plots = PolarPlots(
            np.full(2 + seen.sum(), time),
            np.append([100.0, 5000.0], y[seen]),
            np.append([np.pi, np.pi / 2], np.full(seen.sum(), np.radians(bias_deg))),
            np.zeros(2 + seen.sum()),
        )
        still = OwnShip(np.array([time]), np.zeros((1, 2)), np.zeros((1, 2)))
        scans.append(Scan(time, time, plots, still))
        velocity = [[0.0, SPEED]] if known_velocity else [[math.nan, math.nan]]
        truths.append(
            Truth(
                np.full(len(y), time + delay),
                np.array(targets),
                np.stack([np.zeros(len(y)), y], -1),
                np.repeat(velocity, len(y), 0),
            )
        )
    times = PERIOD * np.arange(SCANS)
    return Recording(
        'world',
        tuple(scans),
        tuple(truths),
        {},
        notes,
        np.arange(SCANS),
        OwnShip(times, np.zeros((SCANS, 2)), np.zeros((SCANS, 2))),
    )


def rows(
    name,
    scans=range(SCANS),
    north=1000.0,
    off=0.0,
    speed_off=0.0,
    status='confirmed',
    predicted_off=math.nan,
):
    """(time, track, status, position, velocity, predicted, scan) of a track on a target."""
    return [
        (
            PERIOD * k,
            name,
            status,
            (0.0, north + SPEED * PERIOD * k + off),
            (0.0, SPEED + speed_off),
            (0.0, north + SPEED * PERIOD * k + off + predicted_off),
            k,
        )
        for k in scans
    ]


def track_rows(*tracks, with_scan=True):
    table = [row for track in tracks for row in track]
    if not table:
        none = np.zeros((0, 2))
        return TrackRows(
            np.zeros(0),
            np.zeros(0, np.str_),
            np.zeros(0, np.str_),
            none,
            none,
            none,
            np.zeros(0, np.int64),
        )
    time, name, status, position, velocity, predicted, scan = (
        np.array(column) for column in zip(*table)
    )
    return TrackRows(
        time,
        name.astype(np.str_),
        status,
        position,
        velocity,
        predicted,
        scan if with_scan else None,
    )


def score(recording, *tracks, **options):
    return metrics.score(recording, track_rows(*tracks), **options).figures


def test_a_perfect_track_has_no_error():
    figures = score(world(), rows('1', predicted_off=0.0))
    for name in (
        'gospa_mean_m',
        'gospa_rms_m',
        'position_rmse_m',
        'position_median_m',
        'velocity_rmse_mps',
        'prediction_rmse_m',
        'cv_prediction_rmse_m',
    ):
        assert figures[name] == pytest.approx(0, abs=1e-9), name
    assert figures['held'] == figures['held_within_fifth'] == 1
    assert figures['first_confirmation_s'] == 0
    for name in (
        'breaks_per_target',
        'switches_per_target',
        'false_per_scan',
        'false_tracks',
        'never_confirmed',
    ):
        assert figures[name] == 0, name
    assert figures['scans'] == figures['truth_rows'] == figures['scored_rows'] == SCANS
    assert figures['plot_fraction_on_scored'] == 1


def test_figures_are_those_documented_in_that_order():
    assert list(score(world(), rows('1'))) == list(metrics.FIGURES)


def test_an_offset_and_a_false_track_split_into_localisation_and_false():
    figures = score(world(), rows('1', off=30, speed_off=2), rows('2', north=-3000.0))
    assert figures['gospa_mean_m'] == pytest.approx(math.sqrt(30**2 + 100**2 / 2))
    assert figures['gospa_rms_m'] == pytest.approx(figures['gospa_mean_m'])
    assert figures['gospa_localisation_rms_m'] == pytest.approx(30)
    assert figures['gospa_missed_rms_m'] == 0
    assert figures['gospa_false_rms_m'] == pytest.approx(100 / math.sqrt(2))
    assert figures['gospa_without_false_m'] == pytest.approx(30)
    assert figures['position_rmse_m'] == figures['position_median_m'] == pytest.approx(30)
    assert figures['velocity_rmse_mps'] == pytest.approx(2)
    assert figures['cv_prediction_rmse_m'] == pytest.approx(30 + 2 * PERIOD)
    assert figures['held'] == 1 and figures['held_within_fifth'] == 0
    assert figures['false_per_scan'] == 1 and figures['false_tracks'] == 1
    assert figures['false_short_lived_per_scan'] == 0  # it lives for 20 scans


def test_a_rmse_weighs_large_errors_more_than_the_median():
    figures = score(world(), rows('1', range(15), off=10), rows('1', range(15, 20), off=50))
    assert figures['position_rmse_m'] == pytest.approx(math.sqrt((15 * 100 + 5 * 2500) / 20))
    assert figures['position_median_m'] == pytest.approx(10)
    assert figures['held_within_fifth'] == pytest.approx(15 / 20)


def test_no_tracks_at_all():
    figures = score(world())
    assert figures['gospa_mean_m'] == pytest.approx(100 / math.sqrt(2))
    assert figures['gospa_missed_rms_m'] == pytest.approx(figures['gospa_mean_m'])
    assert figures['held'] == 0 and figures['never_confirmed'] == 1
    for name in (
        'position_rmse_m',
        'velocity_rmse_mps',
        'prediction_rmse_m',
        'first_confirmation_s',
    ):
        assert figures[name] is None, name


def test_beyond_the_cutoff_a_track_is_false_and_its_target_missed():
    figures = score(world(), rows('1', off=150))
    assert figures['gospa_mean_m'] == pytest.approx(100)
    assert figures['held'] == 0 and figures['false_per_scan'] == 1
    wider = score(world(), rows('1', off=150), cutoff=200.0)
    assert wider['gospa_mean_m'] == pytest.approx(150) and wider['held'] == 1
    assert score(world(cutoff_m=200.0), rows('1', off=150)) == wider


def test_tentative_and_lost_rows_do_not_count():
    figures = score(
        world(),
        rows('1', range(4), status='tentative'),
        rows('1', range(4, 10)),
        rows('1', range(10, 12), status='coasting'),
        rows('1', range(12, 20), status='lost'),
    )
    assert figures['held'] == pytest.approx(8 / 20)
    assert figures['first_confirmation_s'] == pytest.approx(4 * PERIOD)
    assert figures['breaks_per_target'] == 1


def test_a_break_and_a_switch():
    figures = score(world(), rows('1', range(8)), rows('2', range(10, 20)))
    assert figures['breaks_per_target'] == 1 and figures['switches_per_target'] == 1
    assert figures['held'] == pytest.approx(18 / 20) and figures['false_tracks'] == 0


def test_the_same_track_after_a_break_is_no_switch():
    figures = score(world(), rows('1', range(8)), rows('1', range(10, 20)))
    assert figures['breaks_per_target'] == 1 and figures['switches_per_target'] == 0


def test_a_nearer_duplicate_does_not_take_the_target_over():
    figures = score(world(), rows('1', off=20), rows('2', range(10, 20)))
    assert figures['switches_per_target'] == 0
    assert figures['false_per_scan'] == pytest.approx(10 / 20)
    assert figures['false_short_lived_per_scan'] == pytest.approx(10 / 20)


def test_a_track_once_on_a_target_is_no_false_track_though_its_strayed_rows_are():
    figures = score(world(), rows('1', range(10)), rows('1', range(10, 20), off=500))
    assert figures['false_per_scan'] == pytest.approx(10 / 20)
    assert figures['false_short_lived_per_scan'] == 0 and figures['false_tracks'] == 0


def test_tracks_that_change_places_are_a_switch_for_each_target():
    result = metrics.score(
        world((1, 2)),
        track_rows(
            rows('1', range(10)),
            rows('2', range(10), north=3000.0),
            rows('2', range(10, 20)),
            rows('1', range(10, 20), north=3000.0),
        ),
    )
    assert result.figures['switches_per_target'] == 1 and result.figures['held'] == 1
    assert result.targets == {
        target: {'rows': 20, 'held': 1.0, 'breaks': 0, 'switches': 1, 'first_confirmation_s': 0.0}
        for target in (1, 2)
    }


def test_truth_that_the_radar_did_not_see_is_set_aside_with_its_track():
    figures = score(world((1, 2), plotted=(1,)), rows('1'), rows('2', north=3000.0))
    assert figures['truth_targets'] == 1 and figures['scored_rows'] == 20
    assert figures['truth_rows'] == 40
    assert figures['gospa_mean_m'] == pytest.approx(0) and figures['false_per_scan'] == 0


def test_truth_out_of_range_is_not_scored():
    figures = score(world((1, 2), north={1: 1000.0, 2: 9000.0}, plotted=(1,)), rows('1'))
    assert figures['truth_targets'] == 1 and figures['held'] == 1


def test_one_plot_makes_one_target_seen():
    figures = score(world((1, 2), north={1: 1000.0, 2: 1040.0}, plotted=(1,)), rows('1'))
    assert figures['truth_targets'] == 1


def test_five_plots_in_eleven_scans_make_a_target_seen_and_four_do_not():
    def seen_with(scans):
        full, empty = world(), world(plotted=())
        mixed = full._replace(
            scans=tuple((full if k in scans else empty).scans[k] for k in range(SCANS))
        )
        return score(mixed, rows('1'))

    assert seen_with({0, 2, 4, 6})['scored_rows'] == 0
    figures = seen_with({0, 2, 4, 6, 8})
    assert figures['scored_rows'] == 3  # scans 3, 4 and 5 have all five near
    assert figures['plot_fraction_on_scored'] == pytest.approx(1 / 3)


def test_a_bearing_bias_turns_the_truth():
    turn = math.radians(-3.0)
    track = [
        (
            time,
            name,
            status,
            (p[1] * math.sin(turn), p[1] * math.cos(turn)),
            (SPEED * math.sin(turn), SPEED * math.cos(turn)),
            predicted,
            k,
        )
        for time, name, status, p, _, predicted, k in rows('1')
    ]
    for figures in (
        score(world(bias_deg=-3.0, azimuth_bias_deg=-3.0), track),
        score(world(bias_deg=-3.0), track, bias_deg=-3.0),
    ):
        assert figures['position_rmse_m'] == pytest.approx(0, abs=1e-9)
        assert figures['velocity_rmse_mps'] == pytest.approx(0, abs=1e-9)
        assert figures['plot_fraction_on_scored'] == 1
    turned = score(world(bias_deg=-3.0, azimuth_bias_deg=-3.0), track, bias_deg=0.0)
    assert turned['position_rmse_m'] is None or turned['position_rmse_m'] > 40


def test_a_lag_moves_the_truth_back_along_its_velocity():
    assert score(world(), rows('1', off=-10))['position_rmse_m'] == pytest.approx(10)
    for figures in (
        score(world(), rows('1', off=-10), lag=2.0),
        score(world(plot_lag_s=2.0), rows('1', off=-10)),
    ):
        assert figures['position_rmse_m'] == pytest.approx(0, abs=1e-9)


def test_a_track_is_moved_to_the_time_of_the_truth():
    assert score(world(delay=1.0), rows('1'))['position_rmse_m'] == pytest.approx(0, abs=1e-9)
    predicted = score(world(delay=1.0), rows('1', speed_off=3.0, predicted_off=0.0))
    assert predicted['prediction_rmse_m'] == pytest.approx(3.0)


def test_unknown_velocities_come_from_positions():
    figures = score(world(known_velocity=False), rows('1', speed_off=1.0))
    assert figures['velocity_rmse_mps'] == pytest.approx(1.0)


def test_predictions_are_scored_where_a_track_gives_them():
    figures = score(world(), rows('1', range(1)), rows('1', range(1, SCANS), predicted_off=7.0))
    assert figures['prediction_rmse_m'] == pytest.approx(7.0)


def test_of_two_rows_of_a_track_in_a_scan_the_last_counts():
    late = [(time + 0.1, *rest) for time, *rest in rows('1', off=0.5)]
    figures = score(world(), late, rows('1', off=80.0))
    assert figures['position_rmse_m'] == pytest.approx(0.0, abs=1e-9)
    assert figures['false_per_scan'] == 0


def test_without_scan_numbers_a_row_belongs_to_the_nearest_scan():
    near = [
        (time + 1.2, name, status, (p[0], p[1] + 1.2 * SPEED), *rest)
        for time, name, status, p, *rest in rows('1')
    ]
    result = metrics.score(world(), track_rows(near, with_scan=False))
    assert result.figures['held'] == 1
    assert result.figures['position_rmse_m'] == pytest.approx(0.0, abs=1e-9)


def test_rows_of_scans_that_the_recording_does_not_have_are_ignored():
    stray = [(*row[:-1], 99) for row in rows('2', range(3), north=-2000.0)]
    assert score(world(), rows('1'), stray) == score(world(), rows('1'))


def test_a_scan_without_truth_still_counts_its_tracks_as_false():
    recording = world()
    none = Truth(np.empty(0), np.empty(0, np.int64), np.empty((0, 2)), np.empty((0, 2)))
    recording = recording._replace(truths=(*recording.truths[:10], *(none,) * 10))
    figures = score(recording, rows('1'))
    assert figures['scored_rows'] == 10 and figures['false_per_scan'] == pytest.approx(10 / 20)


def test_a_recording_without_truth_cannot_be_scored():
    none = Truth(np.empty(0), np.empty(0, np.int64), np.empty((0, 2)), np.empty((0, 2)))
    with pytest.raises(ValueError, match='world has no truth to score against'):
        score(world()._replace(truths=(none,) * SCANS))


@pytest.mark.parametrize('cutoff', [0.0, -5.0, math.inf, math.nan])
def test_a_cutoff_must_be_above_zero_and_finite(cutoff):
    with pytest.raises(ValueError, match=f'cutoff_m is {cutoff}; it must be a number, above 0'):
        score(world(), cutoff=cutoff)


@pytest.mark.parametrize(
    ('name', 'value'),
    [('cutoff_m', 'far'), ('seen_within_m', 0), ('azimuth_bias_deg', None), ('plot_lag_s', True)],
)
def test_a_wrong_note_is_named(name, value):
    with pytest.raises(ValueError, match=f'{name} is {value!r}; it must be a number'):
        score(world(**{name: value}))


@pytest.mark.parametrize(
    ('option', 'name'), [('bias_deg', 'azimuth_bias_deg'), ('lag', 'plot_lag_s')]
)
def test_bias_and_lag_must_be_finite(option, name):
    with pytest.raises(ValueError, match=f'{name} is nan; it must be a number, finite'):
        score(world(), **{option: math.nan})


def test_notes_say_whether_strangers_may_count_as_false():
    assert metrics.score(world(), track_rows()).counts_strangers
    assert not metrics.score(world(uncooperative=False), track_rows()).counts_strangers


offsets = st.lists(
    st.tuples(
        st.sampled_from('abcd'),
        st.integers(0, SCANS - 1),
        st.floats(-300, 300),
        st.sampled_from([1000.0, 3000.0, -2000.0]),
        st.sampled_from(['confirmed', 'coasting', 'tentative']),
    ),
    max_size=40,
)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(offsets)
def test_gospa_is_the_sum_of_its_parts_and_fractions_are_fractions(drawn):
    recording = world((1, 2))
    tracks = [
        row
        for name, k, off, north, status in drawn
        for row in rows(name, [k], north=north, off=off, status=status)
    ]
    figures = score(recording, tracks)
    parts = sum(figures[f'gospa_{part}_rms_m'] ** 2 for part in ('localisation', 'missed', 'false'))
    assert figures['gospa_rms_m'] == pytest.approx(math.sqrt(parts))
    assert figures['gospa_mean_m'] <= figures['gospa_rms_m'] + 1e-9
    assert figures['gospa_without_false_m'] <= figures['gospa_mean_m'] + 1e-9
    assert 0 <= figures['held_within_fifth'] <= figures['held'] <= 1
    assert figures['false_short_lived_per_scan'] <= figures['false_per_scan']
    assert (figures['position_rmse_m'] or 0) <= 100


@settings(max_examples=20, deadline=None, derandomize=True)
@given(offsets, st.randoms(use_true_random=False))
def test_names_of_tracks_and_order_of_scans_in_the_file_do_not_matter(drawn, random):
    unique = {(name, k): (off, north, status) for name, k, off, north, status in drawn}
    tracks = [
        row
        for (name, k), (off, north, status) in unique.items()
        for row in rows(name, [k], north=north, off=off, status=status)
    ]
    renamed = [
        (row[0], 'x' + {'a': 'q', 'b': 'r', 'c': 's', 'd': 't'}[row[1]], *row[2:])
        for row in sorted(tracks, key=lambda row: row[6])
    ]
    before, after = (
        score(world((1, 2)), sorted(tracks, key=lambda row: row[6])),
        score(world((1, 2)), renamed),
    )
    assert before == after
    shuffled = list(range(SCANS))
    random.shuffle(shuffled)
    by_scan = sorted(tracks, key=lambda row: shuffled[row[6]])
    assert score(world((1, 2)), by_scan) == before
