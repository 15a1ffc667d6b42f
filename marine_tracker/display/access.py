"""Who may look and who may command.

A page of somebody else that is open in the same browser reaches 127.0.0.1 as well. So the origin
that the browser tells must be this server's own; and its name must be one that nobody else can
give to this machine (a foreign name that points here is how such pages get around the first check).
"""

import ipaddress
import secrets
import socket
from urllib.parse import urlsplit


def new_token() -> str:
    """What a viewer needs to command; told when the server starts."""
    return secrets.token_urlsafe(12)


def same_token(given: str, token: str) -> bool:
    """Compared in constant time."""
    return secrets.compare_digest(given.encode(errors='replace'), token.encode())


def host_trusted(host: str) -> bool:
    """Whether the header Host has an address as numbers, or a name of this machine."""
    try:
        name = (urlsplit(f'//{host}').hostname or '').rstrip('.').lower()
    except ValueError:
        return False
    if not name:
        return False
    try:
        ipaddress.ip_address(name)
        return True
    except ValueError:
        own = socket.gethostname().lower()
        return name in {'localhost', own, own.split('.')[0], f'{own.split(".")[0]}.local'}


def origin_trusted(origin: str | None, host: str) -> bool:
    """Whether the page that asks came from this server. No origin: not a browser's page."""
    if origin is None:
        return True
    try:
        from_there = urlsplit(origin)
    except ValueError:
        return False
    return from_there.scheme in ('http', 'https') and from_there.netloc.lower() == host.lower()


def is_loopback(address: str | None) -> bool:
    """Whether a peer's address is on this machine."""
    try:
        place = ipaddress.ip_address((address or '').split('%')[0])
    except ValueError:
        return False
    mapped = getattr(place, 'ipv4_mapped', None)
    return (mapped or place).is_loopback
