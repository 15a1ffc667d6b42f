"""Where AIS sentences come from: datagrams, connections, a serial port. Nothing here ever waits."""

import contextlib
import os
import selectors
import socket
import termios
import time
from collections.abc import Callable
from typing import Any

from .diagnostics import one_line
from .nmea_output_links import Endpoint, endpoints

AGAIN = 3.0  # s between two attempts to connect
LONGEST = 1 << 14  # bytes of a line that does not end
AT_ONCE = 1 << 16  # bytes read at a time
CONNECTIONS = 50  # of the server
GPSD_PORT, WATCH = 2947, b'?WATCH={"enable":true,"json":true};\n'

Take = Callable[[bytes, str], None]  # a line, and its source


class Links:
    """All links of a node; `poll` takes what has come.

    take    take(line, source)
    faults  what was wrong since the last look
    """

    def __init__(self, take: Take) -> None:
        self._take = take
        self._selector = selectors.DefaultSelector()
        self._rest: dict[Any, bytes] = {}  # of each stream the line that has not ended
        self._wanted: dict[str, tuple[Endpoint, float]] = {}  # to be connected; s of the wall, when
        self._open: dict[Any, Endpoint | None] = {}
        self.faults: list[str] = []

    def listen_udp(self, name: str, text: str) -> None:
        """Takes datagrams on each host:port. ValueError where it cannot."""
        for endpoint in endpoints(name, text):
            self._bound(name, endpoint, socket.SOCK_DGRAM, self._on_datagram)

    def serve_tcp(self, name: str, text: str) -> None:
        """Takes connections on each host:port. ValueError where it cannot."""
        for endpoint in endpoints(name, text):
            self._bound(name, endpoint, socket.SOCK_STREAM, self._on_client)

    def connect_tcp(self, name: str, text: str) -> None:
        """Connects to each host:port, again when it is lost. ValueError for a wrong one."""
        for endpoint in endpoints(name, text):
            self._wanted[endpoint.text] = endpoint, 0.0

    def open_serial(self, name: str, path: str, baud: int) -> None:
        """Reads a serial port, raw, or what stands for one. ValueError where it cannot."""
        try:
            port = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY)
        except OSError as error:
            raise ValueError(
                f'parameter {name} is {one_line(repr(path))}: {error.strerror}'
            ) from error
        with contextlib.suppress(termios.error):  # a pipe has no speed
            settings = termios.tcgetattr(port)
            speed = getattr(termios, f'B{baud}', None)
            if speed is None:
                os.close(port)
                raise ValueError(f'parameter baud is {baud}; a serial port has no such speed')
            settings[:4] = [0, 0, termios.CS8 | termios.CREAD | termios.CLOCAL, 0]
            settings[4:6] = [speed, speed]
            termios.tcsetattr(port, termios.TCSANOW, settings)
        self._selector.register(port, selectors.EVENT_READ, self._on_serial)

    def poll(self) -> None:
        """Takes all that has come, makes connections that are due."""
        now = time.monotonic()
        for endpoint in [one for one, due in self._wanted.values() if due <= now]:
            self._connect(endpoint, now)
        for key, _ in self._selector.select(0):
            key.data(key.fileobj)

    def close(self) -> None:
        """Closes all."""
        for key in list(self._selector.get_map().values()):
            if isinstance(key.fileobj, int):
                os.close(key.fileobj)
            else:
                key.fileobj.close()  # type: ignore[attr-defined]
        self._selector.close()

    @property
    def connected(self) -> int:
        """Number of connections."""
        return len(self._open)

    # -- sockets ---------------------------------------------------------------------------------

    def _bound(self, name: str, endpoint: Endpoint, kind: int, callback: Callable) -> None:
        error: OSError | None = None
        made = 0
        for family, addresses in endpoint.addresses.items():
            for address in addresses:
                one = socket.socket(family, kind)
                try:
                    one.setblocking(False)
                    if kind == socket.SOCK_STREAM:
                        one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                    if family == socket.AF_INET6:
                        one.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 0)
                    one.bind(address)
                    if kind == socket.SOCK_STREAM:
                        one.listen()
                except OSError as problem:
                    one.close()
                    error = problem
                else:
                    self._selector.register(one, selectors.EVENT_READ, callback)
                    made += 1
        if not made and error is not None:
            raise ValueError(
                f'parameter {name} has {one_line(repr(endpoint.text))}: cannot listen there: '
                f'{error.strerror}'
            ) from error

    def _connect(self, endpoint: Endpoint, now: float) -> None:
        """Begins a connection; whether it is made shows when it is read."""
        self._wanted[endpoint.text] = endpoint, now + AGAIN
        family, addresses = next(reversed(endpoint.addresses.items()))  # IPv4 where there is one
        one = socket.socket(family, socket.SOCK_STREAM)
        one.setblocking(False)
        try:
            one.connect(addresses[0])
        except BlockingIOError:
            pass
        except OSError as error:
            one.close()
            self.faults.append(f'{endpoint.text}: {error.strerror}')
            return
        del self._wanted[endpoint.text]
        self._open[one] = endpoint
        if addresses[0][1] == GPSD_PORT:
            events = selectors.EVENT_READ | selectors.EVENT_WRITE
            self._selector.register(one, events, self._on_gpsd)
            return
        self._selector.register(one, selectors.EVENT_READ, self._on_stream)

    def _on_datagram(self, one: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while True:
                data, sender = one.recvfrom(AT_ONCE)
                for line in data.splitlines():
                    if line.strip():
                        self._take(line, str(sender[0]))

    def _on_client(self, listener: socket.socket) -> None:
        with contextlib.suppress(OSError):
            client, _ = listener.accept()
            if len(self._open) >= CONNECTIONS:
                client.close()
                self.faults.append('a connection refused for want of room')
                return
            client.setblocking(False)
            self._open[client] = None
            self._selector.register(client, selectors.EVENT_READ, self._on_stream)

    def _on_gpsd(self, one: socket.socket) -> None:
        """The connection is made: gpsd is asked to tell what it hears."""
        self._selector.modify(one, selectors.EVENT_READ, self._on_stream)
        with contextlib.suppress(OSError):
            one.send(WATCH)

    def _on_stream(self, one: socket.socket) -> None:
        try:
            data = one.recv(AT_ONCE)
        except BlockingIOError:
            return
        except OSError as error:
            self._lost(one, error.strerror or str(error))
            return
        if not data:
            self._lost(one, 'closed')
            return
        self._split(one, data, f'tcp {one.fileno()}')

    def _lost(self, one: socket.socket, why: str) -> None:
        self._selector.unregister(one)
        endpoint = self._open.pop(one, None)
        self._rest.pop(one, None)
        one.close()
        if endpoint is not None:
            self._wanted[endpoint.text] = endpoint, time.monotonic() + AGAIN
            self.faults.append(f'{endpoint.text}: {why}')

    def _on_serial(self, port: int) -> None:
        try:
            data = os.read(port, AT_ONCE)
        except BlockingIOError:
            return
        except OSError as error:
            self._selector.unregister(port)
            self.faults.append(f'serial port: {error.strerror}')
            return
        self._split(port, data, 'serial')

    def _split(self, key: Any, data: bytes, source: str) -> None:
        *lines, rest = (self._rest.get(key, b'') + data).split(b'\n')
        if len(rest) > LONGEST:
            lines, rest = [*lines, rest], b''
        self._rest[key] = rest
        for line in lines:
            if line.strip():
                self._take(line, source)
