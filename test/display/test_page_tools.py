"""The picture's geometry and tools in a real browser: clicked, dragged, touched and drawn."""

import asyncio
import math
import time

import pytest

pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')
from marine_tracker.geodesy import LocalFrame

STILL = {'vx': 0.0, 'vy': 0.0}
MARGIN = 40  # px around the picture, for the scale
NM = 1852.0
ECHO_AT = """(() => { const {view} = ppi.scopeNow(); const pen = ppi.surface.pen;
  const [x, y] = ppi.toScreen(view, EAST, NORTH).map(Math.round);
  const [r, g, b] = [1, 3, 5].map(k => parseInt(ppi.app.colors.echo.slice(k, k + 2), 16));
  const {data} = pen.getImageData(x - 12, y - 12, 25, 25);
  let [sx, sy, n] = [0, 0, 0];
  for (let k = 0; k < 625; k++)
    if (Math.hypot(data[4*k] - r, data[4*k+1] - g, data[4*k+2] - b) < 70) {
      sx += k % 25; sy += Math.floor(k / 25); n++; }
  return n && ppi.toMap(view, x - 12 + sx / n + .5, y - 12 + sy / n + .5); })()"""
DRAWN = 'new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))'
CORNER = "document.getElementById('%s').textContent"


async def box_of(page):
    return await page.evaluate(
        '(({x, y, width, height}) => [x, y, width, height])(ppi.canvas.getBoundingClientRect())'
    )


async def key(page, name, **more):
    await page.evaluate('ppi.canvas.focus()')
    await page.call('Input.dispatchKeyEvent', type='keyDown', key=name, **more)
    await page.call('Input.dispatchKeyEvent', type='keyUp', key=name, **more)


async def mouse(page, kind, x, y):
    buttons = 0 if kind == 'mouseReleased' else 1
    await page.call(
        'Input.dispatchMouseEvent',
        type=kind,
        x=x,
        y=y,
        button='left',
        buttons=buttons,
        clickCount=1,
    )


async def drag(page, start, end):
    await mouse(page, 'mousePressed', *start)
    for part in (0.3, 0.7, 1.0):
        await mouse(page, 'mouseMoved', *(a + part * (b - a) for a, b in zip(start, end)))
    await mouse(page, 'mouseReleased', *end)


async def touch(page, kind, *points):
    await page.call(
        'Input.dispatchTouchEvent',
        type=kind,
        touchPoints=[{'x': x, 'y': y, 'id': k} for k, (x, y) in enumerate(points)],
    )


async def choose(page, **settings):
    for name, value in settings.items():
        await page.evaluate(f'ppi.app.change({name!r}, {value!r})')


async def middle_of(page):
    """The middle of the picture, on a whole pixel, and its radius."""
    await page.evaluate(
        "for (const side of ['Width', 'Height']) ppi.canvas.style[side.toLowerCase()] ="
        " 2 * Math.floor(ppi.canvas['client' + side] / 2) + 'px'; ppi.app.redraw()"
    )
    x, y, width, height = await box_of(page)
    return x + width / 2, y + height / 2, min(width, height) / 2 - MARGIN


@pytest.mark.parametrize('ratio', [1, 1.5, 2])
def test_pixel_to_bearing_and_back_in_all_modes(visit, ratio):
    async def act(page, sea):
        await page.call(
            'Emulation.setDeviceMetricsOverride',
            width=1180,
            height=790,
            deviceScaleFactor=ratio,
            mobile=False,
        )
        middle_x, middle_y, radius = await middle_of(page)
        left, top, *_ = await box_of(page)
        for heading_deg in (0, 37, 90, 180, 359.6):
            heading = math.radians(heading_deg)
            sea.own['heading'] = heading
            await page.until(f'Math.abs(ppi.state.own.heading - {heading}) < 1e-6')
            for orientation, up in (('north-up', 0), ('head-up', heading), ('course-up', heading)):
                for off in ('off', 'ahead', 'place'):
                    await choose(page, orientation=orientation, offCentre=off)
                    if off == 'place':
                        await page.evaluate('ppi.app.choices({offRight: -0.3, offDown: 0.25})')
                    # By hand: where own ship stands, and what bearing lies under a pixel.
                    right, down = {
                        'off': (0, 0),
                        'ahead': (-0.5 * math.sin(heading - up), 0.5 * math.cos(heading - up)),
                        'place': (-0.3, 0.25),
                    }[off]
                    pixel = middle_x + 97, middle_y - 141
                    x = pixel[0] - middle_x - right * radius
                    y = pixel[1] - middle_y - down * radius
                    metres = math.hypot(x, y) * 6 * NM / radius
                    bearing = math.atan2(x, -y) + up
                    await page.click(*pixel)
                    cursor = await page.evaluate('ppi.marks.cursor')
                    ahead = (
                        sea.own['x'] + metres * math.sin(bearing),
                        sea.own['y'] + metres * math.cos(bearing),
                    )
                    assert cursor == pytest.approx(ahead, abs=1.0), (heading_deg, orientation, off)
                    # Its cross is drawn there: on its right arm, to a pixel of the screen.
                    await page.evaluate(DRAWN)
                    seen = await page.evaluate(f"""(() => {{
                      const pen = ppi.surface.pen; const [r, g, b] =
                        [1, 3, 5].map(k => parseInt(ppi.app.colors.cursor.slice(k, k + 2), 16));
                      const {{data}} = pen.getImageData(
                        Math.round({ratio} * ({pixel[0]} - {left} + 9)) - 1,
                        Math.round({ratio} * ({pixel[1]} - {top})) - 2, 3, 5);
                      let best = 1e9;
                      for (let k = 0; k < data.length; k += 4) best = Math.min(best,
                        Math.hypot(data[k] - r, data[k+1] - g, data[k+2] - b));
                      return best; }})()""")
                    assert seen < 130, (heading_deg, orientation, off, seen)

    visit(act, '?range=6', **STILL)


def test_at_anchor_the_echo_of_a_pier_stays_where_it_is_in_the_map_in_every_mode(visit):
    async def act(page, sea):
        pier = sea.own['x'] + 1900.0, sea.own['y'] - 1200.0
        left_out = []
        for orientation in ('north-up', 'head-up', 'course-up'):
            await choose(page, orientation=orientation)
            for yaw in (-20, -9, 0, 13, 20):
                heading = sea.own['heading'] = math.radians(160 + yaw)
                await page.until(f'Math.abs(ppi.state.own.heading - {heading}) < 1e-6')
                plots = {'stamp': time.monotonic(), 'radar': 1, 'x': [pier[0]], 'y': [pier[1]]}
                sea.server.publish('plots1', {'at': time.monotonic(), **plots})
                stamp = plots['stamp']
                await page.until(f'ppi.state.plots.some(scan => scan.stamp == {stamp})')
                await page.evaluate(DRAWN)
                # The middle of the pixels of an echo's colour, as a place in the map.
                seen = await page.evaluate(
                    ECHO_AT.replace('EAST', str(pier[0])).replace('NORTH', str(pier[1]))
                )
                if not seen or math.dist(seen, pier) > 3 * NM / 300 * 1.5:  # a pixel and a half
                    left_out.append((orientation, yaw, seen))
        assert left_out == []

    visit(act, '?range=3&trails=off', ships=0, dangers=0, plots=0, **STILL)


def test_lines_and_markers_by_key_by_mouse_and_typed(visit):
    async def act(page, sea):
        x, y, radius = await middle_of(page)
        scale = radius / (3 * NM)
        await page.click(x + 120, y)  # 090
        await key(page, 'e')
        await page.until(CORNER % 'cursor' + ".includes('EBL1 090.0° T')")
        await page.until(CORNER % 'cursor' + f".includes('VRM1 {120 / scale / NM:.2f} NM')")
        await drag(page, (x + 120, y), (x, y - 150))  # the ring lies there, it comes first
        await page.until(CORNER % 'cursor' + f".includes('VRM1 {150 / scale / NM:.2f} NM')")
        await drag(page, (x + 80, y + 1), (x + 70, y + 70))  # the line
        assert await page.evaluate('ppi.marks.tools.ebl[0].bearing') == pytest.approx(
            math.radians(135), abs=0.02
        )
        await page.evaluate("document.getElementById('tools-box').open = true")
        set_ = """(() => { const input = document.querySelector('[title="%s"]');
          input.value = '%s'; input.dispatchEvent(new Event('change')); })()"""
        await page.evaluate(set_ % ('EBL1 from true north or from the bow', 'relative'))
        heading = math.degrees(sea.own['heading'])
        await page.until(CORNER % 'cursor' + f".includes('EBL1 {(135 - heading) % 360:05.1f}° R')")
        await page.evaluate(set_ % ('VRM1 range, NM', '1.234'))
        await page.until(CORNER % 'cursor' + ".includes('VRM1 1.23 NM')")
        await page.evaluate(set_ % ('VRM1 range, NM', '-4'))
        assert 'from 0.001 to 200' in await page.evaluate(CORNER % 'said')
        assert await page.evaluate('ppi.marks.tools.vrm[0].range') == pytest.approx(1.234 * NM)
        await page.click(x - 60, y - 60)
        await page.evaluate(set_ % ('VRM1 begins at', 'ground'))
        await page.until(CORNER % 'cursor' + ".includes('NM offset, fixed')")
        await page.evaluate("document.getElementById('tools-reset').click()")
        await page.until('!' + CORNER % 'cursor' + ".includes('VRM')")
        await page.evaluate('document.querySelector(\'[title^="Line 3 through"]\').click()')
        assert await page.evaluate('ppi.marks.tools.lines[2].on')
        assert await page.evaluate('ppi.marks.tools.lines[2].distance') == pytest.approx(
            -60 / scale, abs=3
        )

    visit(act, '?range=3', **STILL)


def test_the_measure_and_the_place_on_earth_under_the_cursor(visit):
    async def act(page, sea):
        x, y, radius = await middle_of(page)
        await key(page, 'm')
        await page.click(x - 100, y + 30)
        await page.click(x + 100, y + 30)
        nm = 200 / radius * 3
        await page.until(CORNER % 'cursor' + f".includes('A to B 090.0° T {nm:.3f} NM')")
        await mouse(page, 'mouseMoved', x + 150, y - 40)
        metres = [150 * 3 * NM / radius, 40 * 3 * NM / radius]
        latitude, longitude = LocalFrame(sea.own['latitude'], sea.own['longitude']).to_geodetic(
            metres
        )
        told = [f'{int(v)}°{60 * (v % 1):06.3f}'[:8] for v in (latitude, longitude)]
        await page.until(CORNER % 'cursor' + f".includes('{told[0]}')")
        await page.until(CORNER % 'cursor' + f".includes('0{told[1]}')")
        await key(page, 'm')
        await page.until('!' + CORNER % 'cursor' + ".includes('A to B')")
        sea.own |= {'latitude': None, 'longitude': None}
        await page.until(CORNER % 'cursor' + ".includes('no position')")

    visit(act, '?range=3', **STILL)


def test_own_ship_goes_where_she_is_dragged_and_moves_in_true_motion(visit):
    async def act(page, sea):
        x, y, radius = await middle_of(page)
        view = '(({view}) => [view.centreX, view.centreY])(ppi.scopeNow())'
        left, top, *_ = await box_of(page)
        await drag(page, (x + 50, y + 90), (x + 50 + 100, y + 90 - 60))
        there = await page.evaluate(view)
        assert there == pytest.approx([x - left + 100, y - top - 60], abs=1.5)
        await drag(page, (x - 100, y), (x - 100 + 3 * radius, y))
        assert '75 %' in await page.evaluate(CORNER % 'said')
        cx, cy = await page.evaluate(view)
        away = math.hypot(cx - (x - left), cy - (y - top))
        assert away == pytest.approx(0.75 * radius, abs=1)
        await key(page, 'x')
        assert await page.evaluate(view) == pytest.approx([x - left, y - top], abs=0.01)
        await key(page, 'k')
        await page.until(CORNER % 'scale' + ".includes('true motion')")
        before = await page.evaluate(view)
        assert math.hypot(before[0] - x + left, before[1] - y + top) == pytest.approx(
            radius / 2, abs=2
        )
        await asyncio.sleep(1.5)  # 13 m/s at .125 NM: 20 m are 20 / 231 of the radius
        after = await page.evaluate(view)
        assert math.hypot(after[0] - before[0], after[1] - before[1]) > 0.03 * radius
        # A place in the map stands still.
        buoy = 'ppi.toScreen(ppi.scopeNow().view, -730, 2410)'
        first = await page.evaluate(buoy)
        await asyncio.sleep(0.4)
        assert await page.evaluate(buoy) == pytest.approx(first, abs=0.05)
        await key(page, 'x')
        reset = await page.evaluate(view)
        assert reset == pytest.approx(before, abs=3)

    visit(act, '?range=0.125', vx=12.0, vy=-5.0, heading=1.9)


def test_heading_line_and_graphics_are_off_for_a_moment_only(visit):
    async def act(page, sea):
        x, y, radius = await middle_of(page)
        left, top, *_ = await box_of(page)
        sea.own['heading'] = 0.0
        await page.until('ppi.state.own.heading == 0')
        bright = f"""(() => {{ const {{data}} = ppi.surface.pen.getImageData(
          {x - left} - 2, {y - top} - {radius} * 0.61, 5, 3);
          let best = 0; for (let k = 0; k < data.length; k += 4) best = Math.max(best, data[k]);
          return best; }})()"""
        await page.until(bright + ' > 130')
        for name in ('h', 'g'):
            await key(page, name)
            await page.until(bright + ' < 70', 2)
            await page.until(bright + ' > 130', 8)

    visit(act, '?range=6&rings=off&vectors=relative', ships=0, dangers=0, plots=0, **STILL)


def test_touch_taps_drags_and_pinches(visit):
    async def act(page, sea):
        await page.call('Emulation.setTouchEmulationEnabled', enabled=True, maxTouchPoints=5)
        x, y, radius = await middle_of(page)
        ship = await page.evaluate("""(() => { const t = ppi.state.targets[0];
          return ppi.toScreen(ppi.scopeNow().view, t.x, t.y); })()""")
        left, top, *_ = await box_of(page)
        await touch(page, 'touchStart', (ship[0] + left, ship[1] + top))
        await touch(page, 'touchEnd')
        await page.until('ppi.marks.id == ppi.state.targets[0].id')
        before = await page.evaluate('ppi.settings.range')
        await touch(page, 'touchStart', (x - 30, y), (x + 30, y))
        await touch(page, 'touchMove', (x - 60, y), (x + 60, y))
        await touch(page, 'touchEnd')
        assert await page.evaluate('ppi.settings.range') == before - 1
        await touch(page, 'touchStart', (x - 90, y), (x + 90, y))
        await touch(page, 'touchMove', (x - 40, y), (x + 40, y))
        await touch(page, 'touchMove', (x - 20, y), (x + 20, y))
        await touch(page, 'touchEnd')
        assert await page.evaluate('ppi.settings.range') == before + 1
        await touch(page, 'touchStart', (x + 100, y + 100))
        for k in range(5):
            await touch(page, 'touchMove', (x + 100 - 15 * k, y + 100))
        await touch(page, 'touchEnd')
        assert await page.evaluate('ppi.settings.offCentre') == 'place'
        assert await page.evaluate('ppi.settings.offRight') == pytest.approx(-60 / radius, abs=0.03)

    visit(act, '?range=6', ships=1, dangers=0, **STILL)


def test_a_lost_heading_turns_the_picture_head_up_and_says_so(visit):
    async def act(page, sea):
        await choose(page, orientation='north-up')
        bow = sea.own['heading']
        sea.own |= {'heading': None, 'bow': bow}
        await page.until("!document.getElementById('no-heading').hidden")
        assert 'head-up' in await page.evaluate(CORNER % 'scale')
        x, y, radius = await middle_of(page)
        await page.click(x, y - 100)  # right ahead
        await page.until(CORNER % 'cursor' + ".includes('000.0° R')")
        assert 'no position' in await page.evaluate(CORNER % 'cursor')
        assert await page.evaluate('ppi.scopeNow().view.up') == pytest.approx(bow)
        sea.own['heading'] = bow
        await page.until(CORNER % 'scale' + ".includes('north-up')")
        assert await page.evaluate("document.getElementById('no-heading').hidden")

    visit(act, '?range=6', **STILL)


def test_a_zone_by_keys_alone_and_why_by_key(visit):
    async def act(page, sea):
        sea.server.publish('zones', {'zones': [], 'error': ''})
        await page.evaluate("document.querySelector('[data-zone=sector]').click()")
        range_ = 'ppi.marks.draft.zone.range'
        before = await page.evaluate(range_)
        for _ in range(2):  # the second handle is the far side
            await key(page, ']')
        sea.own['heading'] = 0.0
        await page.until('ppi.state.own.heading == 0')
        for _ in range(5):
            await key(page, 'ArrowUp', modifiers=8)
        _, _, radius = await middle_of(page)
        far = before[1] + 40 * 6 * NM / radius
        assert await page.evaluate(range_) == pytest.approx([before[0], far], abs=20)
        await page.evaluate("document.getElementById('zone-save').click()")
        await page.until('!ppi.marks.draft')
        put = sea.commands.given[-1]
        assert put.name == 'zone_put' and put.values['was'] == ''
        assert put.values['zone']['range_m'] == pytest.approx([before[0], far], abs=20)
        assert put.values['zone']['kind'] == 'guard'
        await key(page, 'ArrowDown')
        await key(page, 'y')
        await page.until(CORNER % 'why-says' + ".includes('explain done')")
        asked = sea.commands.given[-1].values
        assert asked == pytest.approx(
            {'x': sea.own['x'], 'y': sea.own['y'] - 8 * 6 * NM / radius}, abs=15
        )

    visit(act, '?range=6', **STILL)


def test_what_waits_for_a_click_ends_with_escape(visit):
    async def act(page, sea):
        x, y, _ = await middle_of(page)
        await page.evaluate("document.getElementById('why').click()")
        assert 'Click where you miss a target' in await page.evaluate(CORNER % 'said')
        await key(page, 'Escape')
        await page.click(x + 30, y + 30)
        assert sea.commands.given == []
        await page.evaluate("document.getElementById('why').click()")
        await page.click(x + 30, y + 30)
        await page.until(CORNER % 'why-says' + ".includes('explain done')")
        assert [command.name for command in sea.commands.given] == ['explain']

    visit(act, '?range=6', **STILL)
