"""Target tracking for marine radar, as an ARPA does it. The names below are the public API.

    from marine_tracker import Service, TrackerParameters

    service = Service(TrackerParameters(estimator='imm'))
    memory = service.start()
    for scan in scans:
        memory, output = service.step(memory, scan)

`Tracker` and `Arpa` are its two halves. Names are imported when they are first asked for: the
command line and the nodes set up their process before numpy is loaded.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .arpa.arpa import Arpa, Picture
    from .estimators.contract import Estimator
    from .parameters import ArpaParameters, TrackerParameters
    from .service import Output, Service, service_for
    from .tracking.tracker import Report, Tracker
    from .types import OwnShip, Plots, PolarPlots, Scan, Tracks

__all__ = [
    'Arpa',
    'ArpaParameters',
    'Estimator',
    'Output',
    'OwnShip',
    'Picture',
    'Plots',
    'PolarPlots',
    'Report',
    'Scan',
    'Service',
    'Tracker',
    'TrackerParameters',
    'Tracks',
    'service_for',
]

_HOME = {
    '.arpa.arpa': ('Arpa', 'Picture'),
    '.estimators.contract': ('Estimator',),
    '.parameters': ('ArpaParameters', 'TrackerParameters'),
    '.service': ('Output', 'Service', 'service_for'),
    '.tracking.tracker': ('Report', 'Tracker'),
    '.types': ('OwnShip', 'Plots', 'PolarPlots', 'Scan', 'Tracks'),
}


def __getattr__(name: str) -> Any:
    for module, names in _HOME.items():
        if name in names:
            return getattr(importlib.import_module(module, __name__), name)
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
