"""Sends lines over UDP and TCP, without ever waiting for a receiver."""

import contextlib
import errno
import os
import socket
from typing import NamedTuple

from .diagnostics import one_line

PENDING = 1 << 18  # bytes that may wait for a slow TCP client before it is dropped
CLIENTS = 50  # TCP clients at a time
FAMILIES = (socket.AF_INET6, socket.AF_INET)


class Endpoint(NamedTuple):
    """A host:port as given, and its addresses by family, as `socket` takes them. Each list is in
    the order to try.
    """

    text: str
    addresses: dict[socket.AddressFamily, list[tuple]]


def endpoints(name: str, text: str) -> list[Endpoint]:
    """The value of the parameter `name`: host:port, several separated by blanks.

    A name gets addresses of both families if possible. The resolver is asked for each family
    separately: asked for both at once, it gives no IPv4 address for `localhost` if the hosts file
    has only `::1`. ValueError names the parameter if one is not a host:port, or cannot be resolved.
    """
    return [Endpoint(word, _addresses(name, word)) for word in text.split()]


def _addresses(name: str, word: str) -> dict[socket.AddressFamily, list[tuple]]:
    host, colon, port = word.rpartition(':')
    if not (colon and host and port.isdecimal() and 0 < int(port[:6]) < 65536):
        raise ValueError(
            f'parameter {name} has {one_line(repr(word))}; it must be host:port, as '
            '127.0.0.1:10110, with a port from 1 to 65535'
        )
    found, refusal = {}, None
    for family in FAMILIES:
        try:
            answers = socket.getaddrinfo(
                host.strip('[]'), int(port), family=family, type=socket.SOCK_DGRAM
            )
        except (OSError, UnicodeError) as error:
            refusal = error
        else:
            found[family] = list(dict.fromkeys(address for *_, address in answers))
    if not found:
        raise ValueError(f'parameter {name} has {one_line(repr(word))}: {refusal}') from refusal
    return found


class Datagrams:
    """Sends each line as one datagram to every destination of the parameter `name`.

    A name with addresses in both families gets it in both, because it is not certain in which one a
    program listens. In each family it goes to the first address that takes it.

    sent     datagrams that at least one address took
    refused  datagrams that no address took because no program listens there, as far as hosts report
             it: the own host at once, others after a moment, so the first one counts as sent
    error    why the last one could not be sent
    """

    def __init__(self, name: str, text: str) -> None:
        self.destinations = endpoints(name, text)
        self.sent = self.refused = 0
        self.error = ''
        self._sockets: dict[tuple, socket.socket] = {}

    def send(self, lines: list[bytes]) -> int:
        """Returns how many could not be sent, without those that were refused."""
        failed = 0
        for destination in self.destinations:
            for line in lines:
                errors = [
                    self._send_to_first(family, addresses, line)
                    for family, addresses in destination.addresses.items()
                ]
                if 0 in errors:
                    self.sent += 1
                elif errno.ECONNREFUSED in errors:
                    self.refused += 1
                else:
                    failed += 1
                    self.error = f'{one_line(destination.text)}: {os.strerror(errors[-1])}'
        return failed

    def close(self) -> None:
        """Closes all sockets."""
        for one in self._sockets.values():
            one.close()
        self._sockets.clear()

    def _send_to_first(self, family: int, addresses: list[tuple], line: bytes) -> int:
        """Sends to the first address that takes it. Returns 0, else the error number of the last
        one.
        """
        for address in addresses:
            error = self._send(family, address, line)
            if error == 0:
                break
        return error

    def _send(self, family: int, address: tuple, line: bytes) -> int:
        try:
            if address not in self._sockets:
                self._sockets[address] = _connected(family, address)
            one = self._sockets[address]
            refused_before = one.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR)
            one.send(line)
            return one.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR) or refused_before
        except OSError as error:
            if not isinstance(error, BlockingIOError) and address in self._sockets:
                # The route of this machine may have changed: use a new socket for the next line.
                self._sockets.pop(address).close()
            return error.errno or errno.EIO


def _connected(family: int, address: tuple) -> socket.socket:
    """A datagram socket for one address. Connected, so it reports refused datagrams."""
    one = socket.socket(family, socket.SOCK_DGRAM)
    try:
        one.setblocking(False)
        one.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        one.connect(address)
    except OSError:
        one.close()
        raise
    return one


class Clients:
    """A TCP server that sends every line to all its clients. It does not read what they send.

    It listens on every address of its host:port; `[::]` is all networks, IPv4 included. A client
    that takes its lines too slowly is dropped, because it would get old ones. A new client is
    refused while there are CLIENTS clients; clients that have left are removed first.

    dropped, refused  number of clients
    """

    def __init__(self, name: str, text: str) -> None:
        self.sent = self.dropped = self.refused = 0
        self._pending: dict[socket.socket, bytearray] = {}
        self._listeners: list[socket.socket] = []
        if len(text.split()) > 1:
            raise ValueError(
                f'parameter {name} is {one_line(repr(text))}; it must be one host:port'
            )
        for endpoint in endpoints(name, text):
            errors = [
                error
                for family, addresses in endpoint.addresses.items()
                for address in addresses
                if (error := self._listen(family, address)) is not None
            ]
            # An address that this machine lacks may be missing, for example IPv6. One in use by
            # another program is an error.
            taken = [error for error in errors if error.errno == errno.EADDRINUSE]
            if taken or not self._listeners:
                self.close()
                raise ValueError(
                    f'parameter {name} is {one_line(repr(text))}: cannot listen there: '
                    f'{(taken or errors)[0].strerror}'
                )

    def __len__(self) -> int:
        return len(self._pending)

    def send(self, lines: list[bytes]) -> None:
        """Sends to all clients, including those that have just connected."""
        self.serve()
        data = b''.join(lines)
        for pending in self._pending.values():
            pending += data
        self.sent += len(lines) * len(self._pending)
        self.serve()

    def serve(self) -> None:
        """Accepts new clients and sends what waits, as far as possible without waiting."""
        for listener in self._listeners:
            with contextlib.suppress(OSError):  # no client waits, or it has left again
                while True:
                    client, _ = listener.accept()
                    self._let_in(client)
        for client, pending in list(self._pending.items()):
            try:
                while pending:
                    del pending[: client.send(pending)]
            except BlockingIOError:
                if len(pending) > PENDING:
                    self.dropped += 1
                    self._drop(client)
            except OSError:  # it has left
                self._drop(client)

    def close(self) -> None:
        """Closes all connections."""
        for client in list(self._pending):
            self._drop(client)
        for listener in self._listeners:
            listener.close()
        self._listeners.clear()

    def _listen(self, family: int, address: tuple) -> OSError | None:
        try:
            listener = socket.create_server(
                address[:2], family=family, dualstack_ipv6=address[0] == '::'
            )
        except OSError as error:
            return error
        listener.setblocking(False)
        self._listeners.append(listener)
        return None

    def _let_in(self, client: socket.socket) -> None:
        if len(self._pending) >= CLIENTS:
            for one in list(self._pending):
                if _has_left(one):
                    self._drop(one)
        if len(self._pending) >= CLIENTS:
            self.refused += 1
            client.close()
            return
        client.setblocking(False)
        with contextlib.suppress(OSError):
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._pending[client] = bytearray()

    def _drop(self, client: socket.socket) -> None:
        del self._pending[client]
        client.close()


def _has_left(client: socket.socket) -> bool:
    """Whether the client has closed its side: it has left, or may at least be dropped if there is
    no room.
    """
    try:
        while client.recv(1 << 16):
            pass
    except BlockingIOError:
        return False
    except OSError:
        pass
    return True
