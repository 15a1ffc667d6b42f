import asyncio
import threading

import aiohttp
import numpy as np
import pytest

pytest.importorskip('rclpy')

from marine_tracker.nodes import display_spokes
from marine_tracker.nodes.ppi_display_node import PpiDisplayNode
from marine_tracker.nodes.recording_player_node import RecordingPlayerNode
from marine_tracker.recording import spokes_file
from marine_tracker.types import OwnShip, Sweep

SHIPS = ((1500.0, 40.0, 35.0), (3300.0, 200.0, 35.0))


@pytest.mark.parametrize(('samples', 'full'), [(1024, 255), (400, 15), (100, 255), (3, 65535)])
def test_spokes_are_shrunk_to_the_greatest_of_their_samples(samples, full):
    kind = np.uint8 if full < 256 else np.uint16
    strength = np.zeros((2, samples), kind)
    strength[1, samples // 2] = full
    found = display_spokes.shrunk(strength, full)
    assert found.shape == (2, display_spokes.SAMPLES) and found.max() == 15
    assert not found[0].any()
    at = np.flatnonzero(found[1]) / display_spokes.SAMPLES
    assert abs(at.mean() - (samples // 2 + 0.5) / samples) < 1.5 / min(samples, 256)


def test_strengths_go_as_letters():
    assert display_spokes.letters(np.array([0, 3, 15], np.uint8)) == 'ADP'


def heard(address, until, found):
    """Messages `spokes` of the page, into `found` by part, until(found)."""

    async def listen():
        async with aiohttp.ClientSession() as session, session.ws_connect(address) as link:
            while not until(found):
                message = await link.receive_json(timeout=50)
                if message['kind'] == 'spokes':
                    found[message['part']] = message

    asyncio.run(listen())


def test_the_page_gets_the_echoes_in_sectors_at_true_bearings(
    graph, node_helpers, pictures, tmp_path
):
    wait, _ = node_helpers
    picture = pictures.turned(pictures.make(SHIPS, period=2.0), 6, 2.0)
    count, samples = picture.strength.shape
    heading = 0.7
    sweep = Sweep(
        picture.time,
        np.mod(picture.bearing - heading, 2 * np.pi),
        np.full(count, heading),
        picture.range_step * samples,
        picture.strength,
    )
    path = tmp_path / 'ships.npz'
    own = OwnShip(np.array([0.0, 20.0]), np.zeros((2, 2)), np.zeros((2, 2)), np.full(2, heading))
    spokes_file.write(path, [sweep], own)
    page = graph.make(PpiDisplayNode, address='127.0.0.1:0')
    address = f'http://127.0.0.1:{page.server.port}/live'
    found: dict = {}
    listener = threading.Thread(
        target=heard, args=(address, lambda f: len(f) == display_spokes.PARTS, found), daemon=True
    )
    listener.start()
    wait(lambda: page.server.viewers)
    graph.make(RecordingPlayerNode, folder=str(path))
    wait(lambda: not listener.is_alive())
    for range_, bearing, _ in SHIPS:
        direction = int(bearing / 360 * display_spokes.DIRECTIONS)
        message = found[direction // display_spokes.IN_PART]
        letters = np.frombuffer(message['strength'].encode(), np.uint8) - ord('A')
        rows = letters.reshape(display_spokes.IN_PART, display_spokes.SAMPLES)
        sample = int(range_ / message['range'] * display_spokes.SAMPLES)
        row = direction % display_spokes.IN_PART
        around = rows[max(row - 2, 0) : row + 3, sample - 1 : sample + 2]
        assert around.max() >= rows.mean() + 5
        assert message['range'] == pytest.approx(4800.0)
