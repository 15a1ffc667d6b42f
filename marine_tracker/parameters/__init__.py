"""Every parameter of every node, described once: default, unit, limits, meaning.

ROS descriptors, the YAML files in config/, doc/parameters.md and the checks of the command line
all derive from the frozen dataclasses here. A wrong value raises ValueError at construction and
names the parameter, the value and the limit.
"""

from .ais import AisInputParameters, AisParameters
from .arpa import ArpaParameters
from .description import from_mapping, from_mappings
from .display import PpiDisplayParameters
from .sources_and_outputs import (
    NmeaOutputParameters,
    RadarSimulatorParameters,
    RecorderParameters,
    RecordingPlayerParameters,
    TrackerOutputParameters,
)
from .tracker import EXTENTS, GLINT_SIGMA, VESSEL_CLASSES, TrackerParameters
from .video import PlotExtractorParameters, VideoParameters

NODES: dict[str, tuple[type, ...]] = {
    'tracker': (TrackerParameters, ArpaParameters, AisParameters, TrackerOutputParameters),
    'radar_simulator': (RadarSimulatorParameters,),
    'plot_extractor': (VideoParameters, PlotExtractorParameters),
    'recording_player': (RecordingPlayerParameters,),
    'nmea_output': (NmeaOutputParameters,),
    'ppi_display': (PpiDisplayParameters,),
    'recorder': (RecorderParameters,),
    'ais_input': (AisInputParameters,),
}

__all__ = [
    'EXTENTS',
    'GLINT_SIGMA',
    'NODES',
    'VESSEL_CLASSES',
    'AisInputParameters',
    'AisParameters',
    'ArpaParameters',
    'NmeaOutputParameters',
    'PlotExtractorParameters',
    'PpiDisplayParameters',
    'RadarSimulatorParameters',
    'RecorderParameters',
    'RecordingPlayerParameters',
    'TrackerOutputParameters',
    'TrackerParameters',
    'VideoParameters',
    'from_mapping',
    'from_mappings',
]
