"""A free ROS domain, and an environment in which nodes find each other quickly."""

import contextlib
import os
import random
import socket
from collections.abc import Iterator, MutableMapping

from ..config import path

LOCK_PORT = 32768  # + domain: bound while a domain is in use, as domain_coordinator does
DDS_PORT = 7410  # + 250 * domain: the first participant's port for discovery
DOMAINS = range(1, 101)


@contextlib.contextmanager
def free_domain() -> Iterator[int]:
    """A domain that no other process on this machine uses, held while the context lasts.

    OSError if there is none.
    """
    for domain in random.sample(DOMAINS, len(DOMAINS)):
        lock = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        with contextlib.closing(lock):
            try:
                lock.bind(('', LOCK_PORT + domain))
                with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as dds:
                    dds.bind(('', DDS_PORT + 250 * domain))
            except OSError:
                continue
            yield domain
            return
    raise OSError('every ROS domain from 1 to 100 is in use; name one with --domain')


def set_local(environment: MutableMapping[str, str], domain: int) -> None:
    """Sets the variables for nodes on one machine. Variables set by the user stay, except the
    domain.
    """
    environment['ROS_DOMAIN_ID'] = str(domain)
    environment.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    environment.setdefault('FASTRTPS_DEFAULT_PROFILES_FILE', os.fspath(path('fastdds_local.xml')))
