"""Ten places of simulated scenes, each with its true reason for having no target, or having one."""

import itertools

import numpy as np
import pytest

from marine_tracker.arpa.explain import explain
from marine_tracker.arpa.explain_plots import seen as seen_of
from marine_tracker.parameters import ArpaParameters, TrackerParameters, from_mapping
from marine_tracker.service import Service
from marine_tracker.simulation import radar, scenario


@pytest.fixture(scope='module')
def coast():
    """Off a coast, after 45 scans: what explains a place, the truth, own ship's position."""
    chosen = scenario.load('coast')
    given = {**chosen.tracker_parameters(), 'extent': 'random_matrix'}
    service = Service(
        from_mapping(TrackerParameters, given),
        ArpaParameters(
            zones='[{name: roads, kind: exclusion, fixed_to: ground,'
            ' corners_m: [[400, 1650], [800, 1650], [800, 1950], [400, 1950]]}]'
        ),
    )
    memory, seen = service.start(), []
    for scan, truth in itertools.islice(radar.simulate(chosen, seed=4), 45):  # noqa: B007
        memory, out = service.step(memory, scan)
        seen.append(seen_of(out.report, out.estimate, out.picture))

    def why(position):
        found = explain(
            np.asarray(position, float),
            service.tracker,
            service.arpa,
            memory.tracker,
            memory.arpa,
            memory.extents.land,
            seen,
        )
        return {reason.about: reason.text for reason in found if reason.decides}

    return why, truth, seen[-1].own.position


@pytest.mark.parametrize(
    'place, about, words',
    [
        ((2005, -880), 'land', 'longer than any ship'),  # a headland of the coast
        ((1800, 1410), 'land', 'longer than any ship'),  # the mole
        ((-1800, 2450), 'land', 'longer than any ship'),  # the islet
        ((-1700, -1500), 'plots', 'no plot within'),  # open water
        ((700, -2500), 'plots', 'no plot within'),
        ((7900, -900), 'range', 'beyond the range of 4.00 NM'),
        ((560, 1700), 'exclusion zone', 'roads'),
    ],
)
def test_places_off_a_coast(coast, place, about, words):
    why, _, _ = coast
    assert words in why(place).get(about, ''), why(place)


def test_right_beside_own_ship_she_is_blind(coast):
    why, _, own = coast
    assert 'blind range of 50 m' in why(own + [21, -17])['range']


@pytest.mark.parametrize('ship', [1, 5])
def test_where_ships_are_there_are_targets(coast, ship):
    why, truth, _ = coast
    place = truth.position[truth.target == ship][0]
    assert 'target' in why(place), why(place)


def test_the_ship_at_anchor_in_the_exclusion_zone_is_seen_but_no_target(coast):
    why, truth, _ = coast
    found = why(truth.position[truth.target == 4][0])
    assert 'roads' in found['exclusion zone'] and 'target' not in found
