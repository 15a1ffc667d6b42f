"""The page and its live data, served over HTTP and a WebSocket. It knows no ROS.

    server = DisplayServer('127.0.0.1:8080', on_command)
    server.publish('own', {'x': 1.0})      # from any thread; never waits for a viewer
    server.publish('spokes', {...}, part=7)    # one of several parts of a kind, here a sector
    server.close()

All runs in a thread of its own. Every message to a viewer is a JSON object with `kind` and `now`,
the server's steady clock in s: a page reckons ages with it, whatever its own clock says. A new
viewer gets the newest message of each kind, and of each of its parts, at once; of a kind ON_DEMAND
once it asks for it.
"""

import asyncio
import json
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Collection, Mapping
from concurrent.futures import Future
from importlib import resources
from socket import SO_SNDBUF, SOL_SOCKET
from typing import Any

from aiohttp import WSMsgType, web

from . import access, commands
from .commands import Command
from .viewers import Mailbox

MOST_VIEWERS = 50
PULSE_S = 1.0  # between two signs of life: a page that hears none for 3 s shows a red cross
APART_S = 0.05  # least time between two messages to one viewer
# Of what was sent, so much waits in this machine for a viewer that reads slowly: a second of a slow
# network, not the megabytes that a system allows.
SEND_BUFFER = 64 * 1024
MOST_PARTS = 512  # of one kind
AREAS = 'areas'
ON_DEMAND = (AREAS,)
START_S = 10.0
ANSWER_S = 5.0
TYPES = {
    'html': 'text/html',
    'js': 'text/javascript',
    'css': 'text/css',
    'svg': 'image/svg+xml',
    'txt': 'text/plain',
}
# A page that says no. Text alone would be black on white, at night too.
REFUSED = (
    '<!doctype html><html lang="en"><meta charset="utf-8"><meta name="color-scheme" content="dark">'
    '<title>PPI</title>'
    '<body bgcolor="#000000" text="#6e5f58"><p>{}</p></body></html>\n'
)
HEADERS = {
    'Content-Security-Policy': (  # the icons of OpenBridge have style attributes
        "default-src 'self'; style-src-attr 'unsafe-inline'; frame-ancestors 'none'; "
        "base-uri 'none'"
    ),
    'X-Content-Type-Options': 'nosniff',
    'Referrer-Policy': 'no-referrer',
    'Cache-Control': 'no-cache',
}
# What is counted.
FOREIGN, FULL, BAD, DENIED = (
    'foreign origins refused',
    'viewers refused for want of room',
    'bad messages',
    'commands without permission',
)


def read_address(address: str) -> tuple[str, int]:
    """Host and port of `host:port`, as `127.0.0.1:8080` or `[::]:8080`. ValueError else."""
    host, colon, port = address.rpartition(':')
    if not colon or not host or not port.isdecimal() or not int(port) < 65536:
        raise ValueError(f'address is {address!r}; it must be host:port, as 127.0.0.1:8080')
    return host.strip('[]'), int(port)


class DisplayServer:
    """See the module. ValueError for a wrong address, OSError where it cannot be listened on.

    on_command(command) is called in the server's thread; it returns a future of the answer, a
    text, or raises ValueError with what is wrong.

    names: under which browsers reach the page, beside this machine's own.
    anybody_commands: viewers on other machines may command, too, where they have the token.

    port, token: as in the address of the page; counts: what went wrong, by name
    """

    def __init__(
        self,
        address: str,
        on_command: Callable[[Command], Future[str]],
        anybody_commands: bool = False,
        token: str | None = None,
        names: Collection[str] = (),
    ) -> None:
        self._host, self.port = read_address(address)
        self._on_command, self._anybody = on_command, anybody_commands
        self._names = tuple(names)
        self.token = token or access.new_token()
        self.counts: Counter[str] = Counter({name: 0 for name in (FOREIGN, FULL, BAD, DENIED)})
        self._files = _static_files()
        self._latest: dict[str, str] = {}
        self._viewers: set[Mailbox] = set()
        self._sockets: set[web.WebSocketResponse] = set()
        self.loop = asyncio.new_event_loop()
        started = threading.Event()
        self._failure: Exception | None = None
        self._stop = asyncio.Event()
        self._thread = threading.Thread(
            target=self._run, args=(started,), name='display', daemon=True
        )
        self._thread.start()
        started.wait(START_S)
        if self._failure:
            raise self._failure

    @property
    def url(self) -> str:
        """The page, with the token: who opens this may command."""
        host = {'0.0.0.0': '127.0.0.1', '::': '[::1]'}.get(self._host, self._host)
        if ':' in host and not host.startswith('['):
            host = f'[{host}]'
        return f'http://{host}:{self.port}/#{self.token}'

    @property
    def viewers(self) -> int:
        """How many look."""
        return len(self._viewers)

    @property
    def replaced(self) -> int:
        """Messages that a newer one replaced before the present viewers had taken them."""
        return sum(viewer.replaced for viewer in tuple(self._viewers))

    def publish(self, kind: str, values: Mapping[str, Any], part: int | None = None) -> None:
        """To all viewers; values must be plain: None where there is no number.

        A newer message takes the place of one of its kind and part that a viewer still waits for:
        with a part for each sector, who has caught up has one whole turn. ValueError for more than
        MOST_PARTS.
        """
        if part is not None and not 0 <= part < MOST_PARTS:
            raise ValueError(f'part is {part}; it must be from 0 to {MOST_PARTS - 1}')
        now = time.monotonic()
        text = json.dumps(
            {'kind': kind, 'now': round(now, 3), **values}, allow_nan=False, separators=(',', ':')
        )
        self._in_loop(self._put, kind if part is None else f'{kind} {part}', text)

    def wanted(self, kind: str) -> int:
        """How many viewers have asked for a kind that comes on demand."""
        return sum(kind in viewer.wants for viewer in tuple(self._viewers))

    def forget(self, *kinds: str) -> None:
        """The newest messages of these kinds: a viewer who comes later does not get them."""
        self._in_loop(self._drop, kinds)

    def close(self) -> None:
        """All viewers are let go."""
        self._in_loop(self._stop.set)
        self._thread.join(START_S)

    def _in_loop(self, function: Callable[..., Any], *arguments: Any) -> None:
        try:
            self.loop.call_soon_threadsafe(function, *arguments)
        except RuntimeError:  # closed
            pass

    # -- in the thread -------------------------------------------------------------------------

    def _put(self, kind: str, text: str) -> None:
        self._latest[kind] = text
        for viewer in self._viewers:
            if kind not in ON_DEMAND or kind in viewer.wants:
                viewer.put(kind, text)

    def _watch(self, viewer: Mailbox, kinds: Mapping[str, Any]) -> None:
        """What this viewer wants of the kinds on demand; nobody needs permission to look."""
        viewer.wants = {kind for kind, on in kinds.items() if on}
        for kind in viewer.wants & self._latest.keys():
            viewer.put(kind, self._latest[kind])

    def _drop(self, kinds: tuple[str, ...]) -> None:
        for name in [name for name in self._latest if name.split(' ')[0] in kinds]:
            del self._latest[name]

    def _run(self, started: threading.Event) -> None:
        asyncio.set_event_loop(self.loop)
        try:
            self.loop.run_until_complete(self._serve(started))
        except Exception as error:  # told in the constructor, or where nobody waits any more
            self._failure = error
            if started.is_set():
                print(f'display: {type(error).__name__}: {error}', file=sys.stderr, flush=True)
        finally:
            started.set()
            self.loop.close()

    async def _serve(self, started: threading.Event) -> None:
        application = web.Application(client_max_size=4096)
        application.router.add_get('/live', self._live)
        application.router.add_get('/{name:.*}', self._file)
        runner = web.AppRunner(
            application, access_log=None, handle_signals=False, shutdown_timeout=1.0
        )
        await runner.setup()
        try:
            site = web.TCPSite(runner, self._host, self.port)
            await site.start()
            if self.port == 0:
                self.port = runner.addresses[0][1]
            started.set()
            while not self._stop.is_set():
                self._put('pulse', self._pulse())
                try:
                    await asyncio.wait_for(self._stop.wait(), PULSE_S)
                except TimeoutError:
                    pass
            for socket in tuple(self._sockets):
                await socket.close()
        finally:
            await runner.cleanup()

    def _pulse(self) -> str:
        return _text('pulse', viewers=len(self._viewers), utc=time.time())

    async def _file(self, request: web.Request) -> web.Response:
        if not access.host_trusted(request.host, self._names):
            raise _refusal(web.HTTPForbidden, 'This name is not one of this machine.')
        found = self._files.get(request.match_info['name'] or 'index.html')
        if found is None:
            raise _refusal(web.HTTPNotFound, 'There is no such page here.')
        body, kind = found
        return web.Response(body=body, content_type=kind, charset='utf-8', headers=HEADERS)

    async def _live(self, request: web.Request) -> web.StreamResponse:
        origin = request.headers.get('Origin')
        if not (
            access.host_trusted(request.host, self._names)
            and access.origin_trusted(origin, request.host)
        ):
            self.counts[FOREIGN] += 1
            raise _refusal(web.HTTPForbidden, 'Pages of other servers are refused.')
        if len(self._sockets) >= MOST_VIEWERS:
            self.counts[FULL] += 1
            raise _refusal(web.HTTPServiceUnavailable, f'{MOST_VIEWERS} viewers are the most.')
        # No heartbeat: who reads nothing for minutes is slow, not gone. TCP itself finds who is.
        socket = web.WebSocketResponse(max_msg_size=4 * commands.LONGEST, compress=False)
        await socket.prepare(request)
        if request.transport and (pipe := request.transport.get_extra_info('socket')):
            pipe.setsockopt(SOL_SOCKET, SO_SNDBUF, SEND_BUFFER)
        viewer = Mailbox()
        viewer.answer(self._pulse())  # first: all that comes after it is as old as it is
        for kind, text in self._latest.items():
            if kind not in ON_DEMAND:
                viewer.put(kind, text)
        self._viewers.add(viewer)
        self._sockets.add(socket)
        sender = asyncio.ensure_future(_send(socket, viewer))
        try:
            await self._listen(socket, viewer, request.remote)
        finally:
            self._viewers.discard(viewer)
            self._sockets.discard(socket)
            sender.cancel()
        return socket

    async def _listen(
        self, socket: web.WebSocketResponse, viewer: Mailbox, remote: str | None
    ) -> None:
        near, may_command = access.is_loopback(remote) or self._anybody, False
        async for message in socket:
            number = 0
            try:
                if message.type != WSMsgType.TEXT:
                    raise ValueError('not a text')
                command = commands.parse(message.data)
                number = command.id
                if command.name == commands.LOGIN:
                    may_command = near and access.same_token(command.values['token'], self.token)
                    viewer.answer(
                        _text('role', id=number, commands=may_command, why=_why(near, may_command))
                    )
                    continue
                if command.name == commands.WATCH:
                    self._watch(viewer, command.values)
                    viewer.answer(_text('answer', id=number, ok=True, text=''))
                    continue
            except ValueError as error:
                self.counts[BAD] += 1
                viewer.answer(_text('answer', id=number, ok=False, text=str(error)))
                continue
            if not may_command:
                self.counts[DENIED] += 1
                viewer.answer(_text('answer', id=number, ok=False, text=_why(near, False)))
                continue
            # One at a time: the next command of this viewer is read once this one is answered.
            try:
                answer = asyncio.wrap_future(self._on_command(command))
                said, done = await asyncio.wait_for(answer, ANSWER_S), True
            except ValueError as error:
                said, done = str(error) or 'refused', False
            except TimeoutError:
                said, done = 'no answer in time', False
            viewer.answer(_text('answer', id=number, ok=done, text=said))


def _why(near: bool, may_command: bool) -> str:
    if may_command:
        return 'may command'
    if not near:
        return 'looking only: commands from other machines are switched off'
    return 'looking only: open the address with the token that was printed at the start'


async def _send(socket: web.WebSocketResponse, viewer: Mailbox) -> None:
    """Waits for this viewer alone where it reads slowly."""
    try:
        while True:
            await socket.send_str(await viewer.take())
            if not len(viewer):
                await asyncio.sleep(APART_S)
    except ConnectionError:  # gone; the reading side sees it as well
        pass


def _text(kind: str, **values: Any) -> str:
    return json.dumps({'kind': kind, 'now': round(time.monotonic(), 3), **values})


def _refusal(kind: type[web.HTTPException], why: str) -> web.HTTPException:
    return kind(text=REFUSED.format(why), content_type='text/html', headers=HEADERS)


def _static_files() -> dict[str, tuple[bytes, str]]:
    """Every file of the page, by name: nothing else can be asked for."""
    folder = resources.files(__package__) / 'static'
    return {
        file.name: (file.read_bytes(), TYPES[file.name.rpartition('.')[2]])
        for file in folder.iterdir()
        if file.name.rpartition('.')[2] in TYPES
    }
