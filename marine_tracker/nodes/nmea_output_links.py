"""Lines out over UDP and TCP, without ever waiting for anybody."""

import socket
from typing import NamedTuple

PENDING = 1 << 18  # bytes that may wait for a slow TCP client before it is dropped
CLIENTS = 50  # TCP clients at a time


class Endpoint(NamedTuple):
    """family and address as `socket` takes them; text as it was given."""

    family: socket.AddressFamily
    address: tuple
    text: str


def endpoints(name: str, text: str) -> list[Endpoint]:
    """What stands in the parameter `name`: host:port, several separated by blanks.

    ValueError names the parameter where one is none, or cannot be resolved.
    """
    found = []
    for word in text.split():
        host, colon, port = word.rpartition(':')
        if not (colon and host and port.isdecimal() and 0 < int(port) < 65536):
            raise ValueError(
                f'parameter {name} has {word!r}; it must be host:port, as '
                '127.0.0.1:10110, with a port from 1 to 65535'
            )
        try:
            family, _, _, _, address = socket.getaddrinfo(
                host.strip('[]'), int(port), type=socket.SOCK_DGRAM
            )[0]
        except (OSError, UnicodeError) as error:
            raise ValueError(f'parameter {name} has {word!r}: {error}') from error
        found.append(Endpoint(family, address, word))
    return found


class Datagrams:
    """Sends each line as one datagram to every destination of the parameter `name`."""

    def __init__(self, name: str, text: str):
        self.destinations = endpoints(name, text)
        self.sent = 0
        self.error = ''  # what the last failure said
        self._sockets: dict[int, socket.socket] = {}
        for family in {destination.family for destination in self.destinations}:
            self._sockets[family] = socket.socket(family, socket.SOCK_DGRAM)
            self._sockets[family].setblocking(False)
            self._sockets[family].setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)

    def send(self, lines: list[bytes]) -> int:
        """How many could not be sent; `error` says why the last one could not."""
        failed = 0
        for destination in self.destinations:
            for line in lines:
                try:
                    self._sockets[destination.family].sendto(line, destination.address)
                    self.sent += 1
                except OSError as error:
                    failed += 1
                    self.error = f'{destination.text}: {error.strerror}'
        return failed

    def close(self) -> None:
        """No more."""
        for one in self._sockets.values():
            one.close()


class Clients:
    """A TCP server whose clients all get every line; what they say is not read.

    A client that takes its lines too slowly is dropped: it would get stale ones.
    """

    def __init__(self, name: str, text: str):
        self.sent = self.dropped = 0
        self._pending: dict[socket.socket, bytearray] = {}
        self._listener = None
        for endpoint in endpoints(name, text)[:1]:
            if len(text.split()) > 1:
                raise ValueError(f'parameter {name} is {text!r}; it must be one host:port')
            try:
                self._listener = socket.create_server(endpoint.address[:2], family=endpoint.family)
            except OSError as error:
                raise ValueError(
                    f'parameter {name} is {text!r}: cannot listen there: {error.strerror}'
                ) from error
            self._listener.setblocking(False)

    def __len__(self):
        return len(self._pending)

    def send(self, lines: list[bytes]) -> None:
        """To all who are connected, those who have just come included."""
        self.serve()
        data = b''.join(lines)
        for pending in self._pending.values():
            pending += data
        self.sent += len(lines) * len(self._pending)
        self.serve()

    def serve(self) -> None:
        """Let new clients in and send what waits, as far as it goes at once."""
        while self._listener is not None:
            try:
                client, _ = self._listener.accept()
            except OSError:  # nobody is waiting, or one has gone again
                break
            if len(self._pending) >= CLIENTS:
                client.close()
                continue
            client.setblocking(False)
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._pending[client] = bytearray()
        for client, pending in list(self._pending.items()):
            try:
                while pending:
                    del pending[: client.send(pending)]
            except BlockingIOError:
                if len(pending) > PENDING:
                    self.dropped += 1
                    self._drop(client)
            except OSError:  # it has gone
                self._drop(client)

    def close(self) -> None:
        """Bid all farewell."""
        for client in list(self._pending):
            self._drop(client)
        if self._listener is not None:
            self._listener.close()

    def _drop(self, client: socket.socket) -> None:
        del self._pending[client]
        client.close()
