"""A headless Chromium that opens the page: for screenshots and for tests.

    python -m marine_tracker.display.browser ADDRESS FILE.png [--size 1280x800] [--wait 20]

What the page is to show goes into its address: `http://127.0.0.1:8080/?range=3&palette=night`.
Speaks the DevTools protocol over a WebSocket; needs the program `chromium` or Chrome and aiohttp.
"""

import argparse
import asyncio
import base64
import contextlib
import json
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import AsyncIterator, Iterator
from pathlib import Path
from typing import Any

import aiohttp

PROGRAMS = ('chromium', 'chromium-browser', 'google-chrome', 'chrome')
START_S = 60.0


def program() -> str | None:
    """Where Chromium or Chrome is; None where there is none."""
    return next(filter(None, map(shutil.which, PROGRAMS)), None)


class Page:
    """An open page.

    errors    what went wrong in it: exceptions, errors on its console, files that did not load
    requests  addresses that it asked for
    frames    what it looked like, while `Page.startScreencast` is on: images, encoded
    """

    def __init__(self, socket: aiohttp.ClientWebSocketResponse) -> None:
        self._socket = socket
        self._answers: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self._count = 0
        self.errors: list[str] = []
        self.requests: list[str] = []
        self.frames: list[bytes] = []
        self._listener = asyncio.ensure_future(self._listen())

    async def _listen(self) -> None:
        async for message in self._socket:
            heard = json.loads(message.data)
            about = heard.get('params', {})
            match heard.get('method'):
                case None:
                    self._answers.pop(heard['id']).set_result(heard)
                case 'Runtime.exceptionThrown':
                    self.errors.append(json.dumps(about['exceptionDetails'])[:500])
                case 'Runtime.consoleAPICalled' if about['type'] in ('error', 'assert'):
                    self.errors.append(json.dumps(about['args'])[:500])
                case 'Log.entryAdded' if about['entry']['level'] == 'error':
                    self.errors.append(about['entry']['text'])
                case 'Network.requestWillBeSent':
                    self.requests.append(about['request']['url'])
                case 'Page.screencastFrame':
                    self.frames.append(base64.b64decode(about['data']))
                    seen = {'sessionId': about['sessionId']}
                    await self._say('Page.screencastFrameAck', seen)

    async def _say(self, method: str, parameters: dict[str, Any]) -> asyncio.Future[dict[str, Any]]:
        """Send a command; its answer is to be waited for, or not."""
        self._count += 1
        number = self._count
        self._answers[number] = answer = asyncio.get_running_loop().create_future()
        await self._socket.send_json({'id': number, 'method': method, 'params': parameters})
        return answer

    async def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """A command of the DevTools protocol; its result. RuntimeError where it fails."""
        heard = await asyncio.wait_for(await self._say(method, parameters), START_S)
        if 'error' in heard:
            raise RuntimeError(f'{method}: {heard["error"]["message"]}')
        return heard['result']

    async def open(self, address: str) -> None:
        """Go to an address; waits until it has loaded."""
        await self.call('Page.navigate', url=address)
        await self.until("location.href != 'about:blank' && document.readyState == 'complete'")

    async def evaluate(self, expression: str) -> Any:
        """The value of a JavaScript expression, waited for. RuntimeError where it throws."""
        result = await self.call(
            'Runtime.evaluate', expression=expression, returnByValue=True, awaitPromise=True
        )
        if 'exceptionDetails' in result:
            raise RuntimeError(json.dumps(result['exceptionDetails'])[:500])
        return result['result'].get('value')

    async def until(self, expression: str, patience: float = START_S) -> Any:
        """Wait until an expression is true; its value. TimeoutError names the expression."""
        last = asyncio.get_running_loop().time() + patience
        while True:
            value = await self.evaluate(expression)
            if value:
                return value
            if asyncio.get_running_loop().time() > last:
                raise TimeoutError(f'not true within {patience:g} s: {expression}')
            await asyncio.sleep(0.1)

    async def click(self, x: float, y: float) -> None:
        """A click at a place of the window, CSS pixels."""
        for kind in ('mousePressed', 'mouseReleased'):
            await self.call(
                'Input.dispatchMouseEvent', type=kind, x=x, y=y, button='left', clickCount=1
            )

    async def key(self, key: str) -> None:
        """A key, pressed and let go."""
        for kind in ('keyDown', 'keyUp'):
            await self.call('Input.dispatchKeyEvent', type=kind, key=key)

    async def screenshot(self) -> bytes:
        """The window as PNG."""
        return base64.b64decode((await self.call('Page.captureScreenshot', format='png'))['data'])


@contextlib.contextmanager
def running(width: int = 1280, height: int = 800) -> Iterator[int]:
    """A browser with nothing kept from before; the port of its DevTools. OSError without one."""
    browser = program()
    if browser is None:
        raise OSError(f'none of {", ".join(PROGRAMS)} is installed')
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        process = subprocess.Popen(
            [
                browser,
                '--headless=new',
                '--no-sandbox',  # root in a container has none; only this page is opened
                '--disable-gpu',
                '--no-first-run',
                '--disable-background-networking',
                '--remote-debugging-port=0',
                f'--user-data-dir={profile}',
                f'--window-size={width},{height}',
                'about:blank',
            ],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            yield _port(Path(profile) / 'DevToolsActivePort', process)
        finally:
            process.terminate()
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


@contextlib.asynccontextmanager
async def open_tab(
    port: int, address: str, width: int = 1280, height: int = 800
) -> AsyncIterator[Page]:
    """The page in a tab of its own of a browser that runs (running)."""
    async with aiohttp.ClientSession(f'http://127.0.0.1:{port}') as session:
        async with session.put('/json/new?about:blank') as response:
            tab = await response.json()
        try:
            async with session.ws_connect(tab['webSocketDebuggerUrl'], max_msg_size=0) as socket:
                page = Page(socket)
                for domain in ('Runtime', 'Log', 'Network', 'Page'):
                    await page.call(f'{domain}.enable')
                await page.call(
                    'Emulation.setDeviceMetricsOverride',
                    width=width,
                    height=height,
                    deviceScaleFactor=1,
                    mobile=False,
                )
                await page.open(address)
                yield page
        finally:
            with contextlib.suppress(aiohttp.ClientError):
                async with session.get(f'/json/close/{tab["id"]}'):
                    pass


@contextlib.asynccontextmanager
async def open_page(address: str, width: int = 1280, height: int = 800) -> AsyncIterator[Page]:
    """The page in a browser of its own. OSError without one."""
    with running(width, height) as port:
        async with open_tab(port, address, width, height) as page:
            yield page


def _port(file: Path, process: subprocess.Popen) -> int:
    until = time.monotonic() + START_S
    while time.monotonic() < until and process.poll() is None:
        if file.exists() and (lines := file.read_text().splitlines()):
            return int(lines[0])
        time.sleep(0.05)
    raise OSError('the browser did not start')


async def _take(address: str, file: Path, width: int, height: int, wait: float) -> list[str]:
    async with open_page(address, width, height) as page:
        await asyncio.sleep(wait)
        file.write_bytes(await page.screenshot())
        return page.errors


def main() -> int:
    """A screenshot; 1 where the page had errors, which are printed."""
    parser = argparse.ArgumentParser(description='A screenshot of the page.')
    parser.add_argument('address')
    parser.add_argument('file', type=Path)
    parser.add_argument('--size', default='1280x800', help='of the window (default: %(default)s)')
    parser.add_argument('--wait', type=float, default=10.0, help='s before (default: %(default)s)')
    given = parser.parse_args()
    width, height = map(int, given.size.split('x'))
    try:
        errors = asyncio.run(_take(given.address, given.file, width, height, given.wait))
    except OSError as error:
        errors = [str(error)]
    print(*errors, sep='\n', end='\n' if errors else '', file=sys.stderr)
    return 1 if errors else 0


if __name__ == '__main__':
    sys.exit(main())
