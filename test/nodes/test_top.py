"""`marine_tracker top`: the picture in a terminal, beside a simulator and a tracker that run."""

import asyncio
import math
import time

import numpy as np
import pytest

pytest.importorskip('rclpy')
pytest.importorskip('textual', reason='no textual: the terminal view is not tested')
from textual.widgets import DataTable, Static

from marine_tracker.commands import top, top_picture
from marine_tracker.nodes.targets_cloud import TARGET_TYPE

SCENARIO = """
duration_s: 900
own_ship: {course_deg: 50, speed_kn: 9}
targets:
  - {start: {range_nm: 3.4, bearing_deg: 50}, course_deg: 230, speed_kn: 11}
  - {start: {range_nm: 4.2, bearing_deg: 300}, course_deg: 300, speed_kn: 6}
"""


async def until(pilot, condition, patience=60):
    last = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < last, condition.__doc__ or condition
        await pilot.pause(0.1)


def test_targets_of_a_live_tracker_show_in_picture_and_table(launch, tmp_path):
    file = tmp_path / 'meeting.yaml'
    file.write_text(SCENARIO)
    launch('nodes.run tracker', '--ros-args', '-p', 'use_sim_time:=true')
    simulator = launch(
        'nodes.run radar_simulator', '--ros-args', '-p', f'scenario:={file}', '-p', 'rate:=20.0'
    )

    async def act():
        app = top.TopApp(6.0)
        async with app.run_test(size=(150, 46)) as pilot:

            def words(name):
                return str(app.query_one(name, Static).render())

            table = app.query_one(DataTable)
            await until(pilot, lambda: table.row_count == 2)
            await until(pilot, lambda: 'DANGER' in table.get_row_at(0)[-1])
            assert str(table.get_row_at(0)[0]).startswith('TT') and 'COG 050.0' in words('#state')
            number = str(table.get_row_at(0)[0])[2:]
            await until(pilot, lambda: f'●{number}' in words('#picture'))
            assert 'N' in words('#picture') and '◎' in words('#picture')
            assert words('#alarms')
            await pilot.press('n')
            assert app.chosen == int(app._in_order()[0]['id']) and table.show_cursor
            await pilot.press('minus', 'o')
            await until(pilot, lambda: '12 NM  head-up' in words('#state'))
            await pilot.press('a')
            await until(pilot, lambda: str(table.get_row_at(0)[-1]) == 'danger')
            # A radar that goes quiet is told, within seconds.
            simulator.process.kill()
            await until(pilot, lambda: 'NO LIVE DATA: no own ship for' in words('#state'), 10)
            await pilot.press('q')

    asyncio.run(act())


@pytest.mark.parametrize('up_deg', [0.0, 65.0, 241.5])
def test_characters_lie_where_the_targets_are(up_deg):
    targets = np.zeros(3, TARGET_TYPE)
    targets['number'], targets['id'] = [7, 8, 9], [70, 80, 90]
    targets['status'] = 1
    own = (512.0, -80.0, 0.0, 0.0, math.nan)
    bearings, ranges = np.radians([12.0, 134.0, 290.0]), np.array([1700.0, 3900.0, 5200.0])
    targets['x'] = own[0] + ranges * np.sin(bearings)
    targets['y'] = own[1] + ranges * np.cos(bearings)
    view = top_picture.View(90, 44, 3.0, math.radians(up_deg))
    lines = top_picture.draw(view, targets, own).plain.split('\n')
    assert len(lines) == 44 and {len(line) for line in lines} == {90}
    dots = (min(2 * 90, 4 * 44) / 2 - 1) / (3.0 * 1852)
    for target, bearing, away in zip(targets, bearings - math.radians(up_deg), ranges):
        column = 45 + away * math.sin(bearing) * dots / 2
        row = 22 - away * math.cos(bearing) * dots / 4
        seen = [
            (r, line.index(mark))
            for r, line in enumerate(lines)
            if (mark := f'○{target["number"]:02}') in line
        ]
        ((found_row, found_column),) = seen
        assert abs(found_column + 0.5 - column) <= 1 and abs(found_row + 0.5 - row) <= 1


def test_what_flashes_is_dark_half_of_the_time_and_what_is_lost_is_gone():
    targets = np.zeros(2, TARGET_TYPE)
    targets['number'], targets['x'], targets['y'] = [3, 4], [300.0, -300.0], [900.0, 800.0]
    targets['status'], targets['alarm'] = [1, 3], [2, 0]
    view, own = top_picture.View(60, 30, 1.5), (0.0, 0.0, 1.0, 1.0, 0.3)
    lit = top_picture.draw(view, targets, own, shown=True).plain
    dark = top_picture.draw(view, targets, own, shown=False).plain
    assert '●03' in lit and '03' not in dark and '04' not in lit


def test_what_is_not_known_is_a_dash():
    (target,) = np.zeros(1, TARGET_TYPE)
    for name in ('range', 'bearing', 'course', 'speed', 'cpa', 'tcpa'):
        target[name] = math.nan
    target['id'] = 31
    assert top.cells(target) == ('Q31', '–', '–', '–', '–', '–', '–', 'acquiring')


def test_a_range_that_there_is_not_is_refused_by_name(command):
    done = command('top', '--range', '5')
    assert done.returncode == 2 and '--range is 5; it must be one of 0.25, 0.5' in done.stderr
