"""Areas of danger over DDS: to a listener, to viewers of the page; alerts silenced there."""

import asyncio
import threading
import time

import numpy as np
import pytest

pytest.importorskip('rclpy')
pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import PointCloud2

from marine_tracker.arpa.danger_areas import dangers
from marine_tracker.geometry import KNOT, NAUTICAL_MILE, unit_vector
from marine_tracker.nodes import targets_cloud, topics
from marine_tracker.nodes.danger_areas_cloud import AREA_TYPE

SHIPS = [(3.4, 15, 195, 11), (2.6, 70, 285, 9)]


@pytest.fixture(scope='module')
def sea(simulated):
    return simulated(SHIPS, 200)


def test_the_areas_of_the_picture_come_to_who_listens(bridge, sea):
    here = bridge(sea, cpa_limit_nm=0.4, tcpa_limit_min=50.0)
    here.sail(12)
    ears = here.listen(PointCloud2, topics.DANGER_AREAS)
    here.sail_on(lambda: len(ears))
    picture = here.tracker._operator.picture
    expected = dangers(picture.motion, picture.own, 0.4 * NAUTICAL_MILE, 3000.0)
    rows = targets_cloud.read(ears[-1], AREA_TYPE)
    ring, areas = rows[rows['area'] == 0], rows[rows['area'] > 0]
    np.testing.assert_allclose(ring['probability'], expected.probability, atol=1e-6)
    assert (ring['safe'] > 0).tolist() == expected.safe.tolist()
    assert 0 < expected.safe.sum() < len(ring)
    assert len(areas) == expected.areas.course.size > 0
    numbers = picture.targets.number[expected.areas.row]
    assert areas['number'].reshape(len(numbers), -1)[:, 0].tolist() == numbers.tolist()
    np.testing.assert_allclose(areas['far'], expected.areas.far.ravel(), rtol=1e-5)
    middle = (areas['near'] + areas['far'])[:, None] / 2
    place = picture.own.position + middle * unit_vector(areas['course'].astype(float))
    np.testing.assert_allclose(np.stack([areas['x'], areas['y']], 1), place, atol=0.1)


def test_without_own_ships_way_there_are_none_and_no_ring(bridge, sea):
    here = bridge(sea, sensor_timeout_s=1.0)
    ears = here.listen(PointCloud2, topics.DANGER_AREAS)
    here.sail_on(lambda: len(ears) and ears[-1].width)
    for scan in here.scans[here._played : here._played + 15]:  # plots, but no own ship any more
        here.send([scan])
        time.sleep(0.2)
        if not ears[-1].width:
            return
    raise AssertionError(f'{ears[-1].width} points')


def test_viewers_get_them_on_demand_and_silence_what_sounds(bridge, sea, display, look):
    here = bridge(sea, cpa_limit_nm=1.5, tcpa_limit_min=50.0)
    node = display(here, own_length_m=96.0, own_beam_m=14.0)
    here.sail(8)
    past = here.listen(DiagnosticArray, topics.ALARMS_PAST)

    async def act(viewer):
        assert not here.tracker._output._to_areas.get_subscription_count()
        assert (await viewer.command('watch', areas=1))['ok']
        await asyncio.to_thread(
            here.wait, lambda: here.tracker._output._to_areas.get_subscription_count()
        )
        await asyncio.to_thread(here.sail_on, lambda: 'danger' in str(here.standing()))
        await asyncio.to_thread(here.sail, 2)
        await viewer.until(lambda me: me.newest.get('areas', {}).get('areas'))
        picture = here.tracker._operator.picture
        areas = viewer.newest['areas']
        assert {one['number'] for one in areas['areas']} <= set(picture.targets.number.tolist())
        assert areas['safe'] and all(0 <= a <= 360 for pair in areas['safe'] for a in pair)
        for one in areas['areas']:
            assert len(one['course']) == len(one['near']) == len(one['far'])
        await viewer.until(lambda me: me.newest.get('own', {}).get('wy'))
        assert viewer.newest['own']['stabilised'] == 'ground'
        assert viewer.newest['own']['wy'] == pytest.approx(viewer.newest['own']['vy'], abs=0.1)
        await viewer.until(lambda me: 'ship' in me.newest)
        ship = viewer.newest['ship']
        assert (ship['length'], ship['beam'], ship['bow'], ship['source']) == (96, 14, 48, 'radar')

        said = await viewer.command('silence')
        assert 'silenced for 30 s' in said['text']
        await viewer.until(lambda me: 'active silenced' in str(me.newest['alarms']['alarms']))
        await asyncio.to_thread(here.sail, 1)  # silenced is not acknowledged
        await viewer.until(lambda me: 2 in me.newest['targets']['columns']['alarm'])
        one = next(a for a in viewer.newest['alarms']['alarms'] if a['kind'] == 'danger')
        assert one['category'] == 'A' and one['instance'] and one['sounds'] == 1
        assert (await viewer.command('acknowledge_alert', instance=one['instance']))['ok']
        await asyncio.to_thread(
            here.wait, lambda: 'active acknowledged' in here.standing().values()
        )
        assert (await viewer.command('cancel', number=one['number']))['ok']
        await viewer.until(lambda me: me.newest.get('alarms_past', {}).get('alarms'))
        (settled, *_) = viewer.newest['alarms_past']['alarms']
        assert settled['name'] == one['name'] and settled['instance'] == one['instance']
        assert settled['raised'] <= settled['acknowledged'] <= settled['ended']

        assert (await viewer.command('watch', areas=0))['ok']
        await asyncio.to_thread(
            here.wait, lambda: not here.tracker._output._to_areas.get_subscription_count()
        )

    look(node, act)
    assert len(past)


def test_own_ships_way_for_the_page_is_that_of_the_targets_courses(bridge, sea, display, look):
    here = bridge(sea, current_set_deg=90.0, current_drift_kn=2.5)
    node = display(here)

    async def act(viewer):
        told = threading.Event()
        sailing = asyncio.ensure_future(asyncio.to_thread(here.sail_on, told.is_set, 400))
        await viewer.until(lambda me: me.newest.get('own', {}).get('stabilised') == 'sea')
        told.set()
        await sailing
        return viewer.newest['own']

    own = look(node, act)
    assert own['by'] == 'current by hand' and own['reference'] == 0
    drift = np.array([2.5 * KNOT, 0.0])
    way, ground = np.array([own['wx'], own['wy']]), np.array([own['vx'], own['vy']])
    assert way == pytest.approx(ground - drift, abs=0.03)
