"""The page with the radar picture, as the demo starts and shows it."""

import importlib.util
import os
import re
import socket
import sys
import webbrowser

from .node_processes import Child

PORT = 8080  # of the page, if it is free


def wanted(no_display: bool) -> bool:
    """Whether to start the page's node; told on stderr where it is wanted but cannot run."""
    if no_display or importlib.util.find_spec('aiohttp'):
        return not no_display
    print("no radar picture: pip install 'marine_tracker[display]'", file=sys.stderr)
    return False


def free_port() -> int:
    """PORT, or 0 for any that is free where it is taken."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(('127.0.0.1', PORT))
        except OSError:
            return 0
        return PORT


def address_of(page: Child) -> str | None:
    """Where the page is, once its node has said so; the log's own position stays where it is."""
    said = os.pread(page.log.fileno(), 10_000, 0).decode(errors='replace')
    found = re.search(r'^ppi_display: (http\S+)$', said, re.M)
    return found[1] if found else None


def show(address: str) -> None:
    """Print it; open it where there is a desktop and somebody looks."""
    print(f'radar picture: {address}', flush=True)
    desktop = sys.platform == 'darwin' or {'DISPLAY', 'WAYLAND_DISPLAY'} & set(os.environ)
    if desktop and sys.stdout.isatty():
        webbrowser.open(address)
