"""Why there is no target at a place: the true reason comes first, in scenes made to have one."""

import json

import numpy as np
import pytest

from marine_tracker.arpa import acquisition
from marine_tracker.arpa.explain import explain
from marine_tracker.arpa.explain_plots import seen as seen_of
from marine_tracker.geometry import to_range_bearing
from marine_tracker.parameters import ArpaParameters, TrackerParameters
from marine_tracker.service import Service
from marine_tracker.types import OwnShip, PolarPlots, Scan, Sector, take

PERIOD = 2.2
TRACKER = {'range_sigma_m': 8.0, 'bearing_sigma_deg': 0.35, 'min_range_m': 150.0}
TRACKER |= {'max_range_m': 9000.0, 'scan_period_s': PERIOD, 'glint_sigma_m': 0.0}


def scan_of(number, places, radar=0, own=(0.0, 0.0)):
    """A revolution in which own ship lies still; places [M, 2] m of plots."""
    offset = np.reshape(np.asarray(places, float), (-1, 2)) - own
    away, bearing = to_range_bearing(offset)
    start = 100 + number * PERIOD
    time = start + bearing / (2 * np.pi) * PERIOD
    plots = PolarPlots(time, away, bearing, np.full(len(away), 20.0))
    at = np.array([start, start + PERIOD])
    still = OwnShip(at, np.tile(np.asarray(own, float), (2, 1)), np.zeros((2, 2)), np.zeros(2))
    return Scan(start, start + PERIOD, plots, still, radar)


def parted(scan, count):
    """The same revolution as so many sectors."""
    width, length = 2 * np.pi / count, (scan.end - scan.start) / count
    for k in range(count):
        here = (scan.plots.bearing // width).astype(int) == k
        start = scan.start + k * length
        yield scan._replace(
            start=start,
            end=start + length,
            plots=take(scan.plots, here),
            sector=Sector(k * width, width),
        )


class Sea:
    """A service that takes scans one after the other, and is asked."""

    def __init__(self, arpa=None, **tracker):
        self.service = Service(
            TrackerParameters(**TRACKER | tracker), ArpaParameters(**(arpa or {}))
        )
        self.memory, self.seen, self.count = self.service.start(), [], 0

    def sail(self, *scans, radar=0, sectors=0):
        """Revolutions of plots at these places, each as so many sectors; 0: as a whole."""
        for places in scans:
            scan = scan_of(self.count, places, radar)
            self.count += 1
            for part in parted(scan, sectors) if sectors else [scan]:
                self.memory, _, out = self.service.take(self.memory, part, 0.0)
                if out:
                    self.seen.append(seen_of(out.report, out.estimate, out.picture))
        return self

    def ask(self, *position, silent=0.0):
        extents = self.service.extents
        return explain(
            np.array(position, float),
            self.service.tracker,
            self.service.arpa,
            self.memory.tracker,
            self.memory.arpa,
            self.memory.extents.land if extents.on else None,
            self.seen,
            silent,
        )

    def why(self, *position):
        """The deciding reasons, by what they are about."""
        return {reason.about: reason.text for reason in self.ask(*position) if reason.decides}


def moving(start, step, count):
    return [[np.add(start, np.multiply(k, step)).tolist()] for k in range(count)]


def test_before_the_first_scan_that_is_the_reason():
    assert list(Sea().why(100, 200)) == ['scans']


def test_an_empty_place_has_no_plots():
    why = Sea().sail(*[[[3100, 900]]] * 6).why(-2500, 1400)
    assert list(why) == ['plots']
    assert 'no plot within' in why['plots'] and 'last 6 scans' in why['plots']


def test_out_of_range_and_inside_the_blind_range_are_told_with_their_limits():
    sea = Sea().sail(*[[[3100, 900]]] * 3)
    assert 'blind range of 150 m' in sea.why(60, -70)['range']
    assert 'beyond the range of 4.86 NM' in sea.why(-7000, 6500)['range']
    assert 'range' not in sea.why(100, -130)  # 164 m
    assert 'range' not in sea.why(-6000, 6600)  # 8920 m


def test_a_place_beyond_one_radar_only_is_not_decided_by_it():
    radars = '[{topic: a/radar/plots, max_range_m: 2000.0}, {topic: b/radar/plots}]'
    sea = Sea(radars=radars).sail([], radar=0).sail([], radar=1)
    told = [reason for reason in sea.ask(2500, 300) if reason.about == 'range']
    assert ['of a' in reason.text for reason in told] == [True]
    assert not told[0].decides


def test_an_exclusion_zone_is_named():
    zone = '[{name: pier 7, kind: exclusion, fixed_to: ground, corners_m: [[700, 700], [1500, 700],'
    zone += ' [1500, 1600], [700, 1600]]}]'
    sea = Sea({'zones': zone}).sail(*moving([900, 1000], [3, 4], 9))
    assert 'pier 7' in sea.why(925, 1030)['exclusion zone']
    assert 'exclusion zone' not in sea.why(1510, 1000)


def test_acquisition_by_hand_or_in_zones_only_is_told():
    ship = moving([-1800, 2400], [6, -2], 9)
    at = (-1750, 2384)
    assert 'nowhere' in Sea({'acquisition': 'nowhere'}).sail(*ship).why(*at)['acquisition']
    zones = '[{name: near, kind: guard, range_nm: [0.2, 1.2]}]'
    sea = Sea({'acquisition': 'zones', 'zones': zones}).sail(*ship)
    assert 'outside of all guard zones' in sea.why(*at)['acquisition']
    assert 'acquisition' not in sea.why(900, 1100)


def test_a_track_that_is_being_built_tells_what_is_missing():
    sea = Sea(confirm_hits=4, confirm_scans=6).sail(*moving([2200, -900], [5, 5], 2))
    why = sea.why(2205, -895)
    assert '2 plots in its last 2 scans' in why['tentative']
    assert '4 in 6 are needed' in why['tentative']
    rng = np.random.default_rng(8)
    crowd = [rng.uniform([2000, -1100], [2600, -500], (60, 2)).tolist() for _ in range(8)]
    told = moving([2200, -900], [5, 5], 3)
    sea = Sea(confirm_existence=0.9997).sail(*crowd, *[a + b for a, b in zip(crowd, told)])
    assert '0.9997 is needed' in sea.why(2210, -890)['tentative']


def test_a_first_plot_is_alone():
    sea = Sea().sail(*[[[3100, 900]]] * 4, [[3100, 900], [-1300, -2100]])
    assert list(sea.why(-1310, -2090)) == ['lone plot']


def test_a_plot_that_another_tracks_gate_explains_names_that_track():
    ship = [3000.0, 3000.0]
    sea = Sea().sail(*[[ship]] * 12, [ship, [3022.0, 2980.0]])
    why = sea.why(3022, 2980)
    assert 'in the gate of another one, TT01' in why['gate']


def test_a_target_that_is_there_is_named_and_a_cancelled_one_too():
    sea = Sea().sail(*moving([1000, -2600], [4, 6], 9))
    at = (1034, -2549)
    assert 'TT01' in sea.why(*at)['target']
    acquired, _ = acquisition.cancel(sea.memory.arpa.acquisition, 1)
    sea.memory = sea.memory._replace(arpa=sea.memory.arpa._replace(acquisition=acquired))
    sea.sail([[1036, -2546]])
    why = sea.why(1036, -2546)
    assert 'target' not in why and 'cancelled by hand' in why['barred']


def test_leaps_beyond_the_greatest_speed_are_told_in_knots():
    sea = Sea(max_target_speed_mps=20.0).sail(*moving([-3000, 400], [330, 0], 5))
    why = sea.why(-1680, 400)  # 330 m in 2.2 s
    assert '330 m away' in why['speed'] and '39 kn is the limit' in why['speed']
    assert '29' in why['speed']  # 290 to 300 kn
    slow = Sea(max_target_speed_mps=20.0).sail(*moving([-3000, 400], [30, 0], 5))
    assert 'speed' not in slow.why(-2880, 400)


def test_dense_clutter_that_no_track_can_stand_out_of_is_told():
    rng = np.random.default_rng(7)
    scans = [rng.uniform([1500, 1500], [2600, 2600], (350, 2)).tolist() for _ in range(14)]
    sea = Sea(confirm_existence=0.9997).sail(*scans)
    clutter = [reason for reason in sea.ask(2000, 2000) if reason.about == 'clutter'][0]
    assert clutter.decides and '0.9997 confirms' in clutter.text
    calm = [reason for reason in sea.ask(-2000, -2000) if reason.about == 'clutter'][0]
    assert not calm.decides


def test_full_lists_are_told():
    ships = [[[900 + 700 * k, 1500] for k in range(5)]] * 8
    sea = Sea({'max_targets': 3}).sail(*ships)
    waits = [name for name in range(5) if 'max_targets' in str(sea.why(900 + 700 * name, 1500))]
    assert len(waits) == 2
    sea = Sea(max_tracks=5).sail(*ships)
    assert 'max_tracks' in sea.why(-2000, -2000)['capacity']


def test_a_target_that_was_lost_here_is_told_with_why():
    sea = Sea().sail(*[[[1700.0, 2100.0]]] * 10, *[[[5000.0, -300.0]]] * 9)
    why = sea.why(1700, 2100)
    assert 'TT01 was lost here' in why['lost'] and 'missed' in why['lost']


def test_land_is_told_where_extents_map_it():
    shore = [[2000 + 12.0 * k, 2500 + 5.0 * (k % 3)] for k in range(90)]
    sea = Sea(extent='random_matrix').sail(*[shore] * 25)
    assert 'land' in sea.why(2500, 2505)['land']
    assert 'land' not in sea.why(2500, -2505)


def test_deciding_reasons_come_first():
    decides = [reason.decides for reason in Sea().sail(*[[[3100, 900]]] * 3).ask(60, -70)]
    assert decides == sorted(decides, reverse=True) and decides[0]


@pytest.mark.parametrize('sectors', [1, 8, 30])
def test_a_radar_that_sends_sectors_gives_the_same_reasons(sectors):
    ship = [[2000.0 + 6 * k, 1500.0 - 4 * k] for k in range(11)]
    scans = [[place] for place in ship[:10]] + [[ship[10], [-1300, -2100]]]
    whole = Sea().sail(*scans)
    parts = Sea().sail(*scans, [[9000, 9000]], sectors=sectors)  # it tells of the last one later
    assert 'TT01' in parts.why(*ship[10])['target']
    for place in ((-900, 2500), ship[10]):
        told = {reason.about for reason in whole.ask(*place)} - {'gate'}
        assert told <= {reason.about for reason in parts.ask(*place)}
    seen = next(reason.text for reason in parts.ask(*ship[8]) if reason.about == 'plots')
    assert 'of the last 10 scans' in seen


def test_land_by_a_file_is_told(tmp_path):
    square = [[1000, 1000], [1900, 1000], [1900, 1800], [1000, 1800], [1000, 1000]]
    file = tmp_path / 'land.geojson'
    file.write_text(json.dumps({'type': 'Polygon', 'coordinates': [square]}))
    sea = Sea(land_mask=str(file)).sail(*moving([1200, 1300], [5, 4], 8))
    assert 'land_mask' in sea.why(1230, 1324)['land']
    assert 'land' not in sea.why(950, 1324)


def test_a_place_where_plots_always_are_is_told():
    quay = [[1500 + 60.0 * k, 1800 + 11.0 * (k % 2)] for k in range(6)]
    rng = np.random.default_rng(3)
    sea = Sea(stationary_places=True).sail(
        *[(np.array(quay) + rng.normal(0, 4, (6, 2))).tolist() for _ in range(90)]
    )
    assert 'shown as a place' in sea.why(*quay[2]).get('place', ''), sea.why(*quay[2])


def test_a_silent_radar_is_told_with_how_long():
    sea = Sea().sail(*moving([2200, -900], [5, 5], 9))
    first = sea.ask(2240, -860, silent=11.6)[0]
    assert (first.about, first.decides) == ('scans', True) and '12 s' in first.text


def test_of_several_radars_none_of_which_sees_anything_that_is_the_reason():
    radars = '[{topic: a/radar/plots}, {topic: b/radar/plots}]'
    sea = Sea(radars=radars)
    for _ in range(4):
        sea.sail([[3000, 100]], radar=0).sail([[-700, 2000]], radar=1)
    told = [reason for reason in sea.ask(-2000, -2000) if reason.about == 'plots']
    assert [reason.decides for reason in told] == [True, True]
    told = [reason for reason in sea.ask(3000, 100) if reason.about == 'plots']
    assert not any(reason.decides for reason in told)
    assert ['of b' in reason.text for reason in told] == [False, True]
