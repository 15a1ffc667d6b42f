"""Where the demo's plots come from: simulator or recording, and plots out of spokes."""

import dataclasses
import os
from argparse import Namespace
from typing import Any

from ..evaluation import video_source
from ..parameters import (
    RadarSimulatorParameters,
    RecordingPlayerParameters,
    TrackerParameters,
    VideoParameters,
    from_mapping,
)
from ..recording import csv_folder, spokes_file
from ..simulation import scenario
from . import tracker_options

TRACKER, EXTRACTOR = 'tracker', 'plot_extractor'


def nodes(args: Namespace) -> dict[str, dict[str, Any]]:
    """The nodes to run, tracker first, with their parameters. ValueError if one is wrong."""
    given = tracker_options.video(args).parameters
    if args.recording:
        source, values, for_tracker, extraction = _recorded(args, given)
    else:
        source, values, for_tracker, extraction = _simulated(args, given)
    if args.estimator:
        for_tracker['estimator'] = args.estimator
    if args.extent:
        for_tracker['extent'] = args.extent
    checked = from_mapping(TrackerParameters, for_tracker)
    for_tracker = {name: getattr(checked, name) for name in for_tracker}  # ints become floats
    chosen = {TRACKER: for_tracker, source: values}
    if extraction is not None:
        chosen[EXTRACTOR] = dataclasses.asdict(extraction)
    if args.rate != 1:
        for name in (TRACKER, EXTRACTOR):
            if name in chosen:
                chosen[name]['use_sim_time'] = True
    return chosen


def _recorded(
    args: Namespace, given: VideoParameters
) -> tuple[str, dict[str, Any], dict[str, Any], VideoParameters | None]:
    values = {'folder': os.path.abspath(args.recording), 'rate': args.rate}
    from_mapping(RecordingPlayerParameters, values)
    if not spokes_file.is_spokes_file(args.recording):
        found = dict(csv_folder.read(args.recording).tracker_parameters)
        return 'recording_player', values, found, None
    sweep = spokes_file.read(args.recording).sweep
    found = video_source.tracker_parameters(given, sweep)
    return 'recording_player', values, found, given


def _simulated(
    args: Namespace, given: VideoParameters
) -> tuple[str, dict[str, Any], dict[str, Any], VideoParameters | None]:
    name = args.scenario
    values = {
        'scenario': os.path.abspath(name) if os.path.isfile(name) else name,
        'rate': args.rate,
        'seed': args.seed,
    }
    from_mapping(RadarSimulatorParameters, values)
    chosen = scenario.load(name)
    if chosen.radar.video is None:
        return 'radar_simulator', values, dict(chosen.tracker_parameters()), None
    given = video_source.for_scenario(chosen, given)
    found = video_source.scenario_tracker_parameters(chosen, given)
    return 'radar_simulator', values, found, given
