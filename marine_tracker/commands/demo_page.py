"""The page with the radar picture, as the demo shows it, and what can be chosen there."""

import importlib.util
import os
import re
import socket
import sys
import webbrowser
from pathlib import Path
from typing import NamedTuple

from .node_processes import Child

PORT = 8080  # of the page, if it is free
MOST_RECORDINGS = 100


class Shown(NamedTuple):
    """What the demo shows: a recording by its name, else a scenario by its name; and how fast."""

    scenario: str
    recording: str
    rate: float


class Offers(NamedTuple):
    """What can be chosen, by name: nobody who looks at the page names a path.

    scenarios   names of shipped ones and paths of files
    recordings  paths of folders
    """

    scenarios: dict[str, str]
    recordings: dict[str, str]

    def shown(self, scenario: str, recording: str | None, rate: float) -> Shown:
        """As the command line asks."""
        name = os.path.basename(os.path.abspath(recording)) if recording else ''
        return Shown(scenario, name, float(rate))


def offers(scenario: str, recording: str | None, folder: str | None) -> Offers:
    """The shipped scenarios and that of the command line; recordings of the folder, or those beside
    the one of the command line. ValueError for a folder that is none."""
    from ..simulation import scenario as scenarios

    known = {name: name for name in scenarios.shipped()}
    known.setdefault(scenario, os.path.abspath(scenario) if os.path.isfile(scenario) else scenario)
    found: dict[str, str] = {}
    if folder is not None and not os.path.isdir(folder):
        raise ValueError(f'--recordings {folder}: there is no such folder')
    if folder is None and recording and os.path.isdir(recording):
        folder = os.path.dirname(os.path.abspath(recording))
    if folder is not None:
        plots = sorted(Path(os.path.abspath(folder)).glob('*/plots.csv'))[:MOST_RECORDINGS]
        found = {file.parent.name: str(file.parent) for file in plots}
    if recording:
        found[os.path.basename(os.path.abspath(recording))] = os.path.abspath(recording)
    return Offers(known, found)


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
