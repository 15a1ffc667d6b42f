"""What the demo runs: the nodes of a scenario or a recording, and what its page offers."""

import dataclasses
import os
from argparse import Namespace
from pathlib import Path
from typing import Any, NamedTuple

from ..evaluation import video_source
from ..parameters import (
    RadarSimulatorParameters,
    RecordingPlayerParameters,
    TrackerParameters,
    from_mapping,
)
from ..recording import csv_folder, mcap_name, spokes_file
from ..simulation import scenario as scenarios
from . import tracker_options

MOST_RECORDINGS = 100


class Shown(NamedTuple):
    """What the demo shows: a recording by its name, else a scenario by its name; and how fast."""

    scenario: str
    recording: str
    rate: float


class Offers(NamedTuple):
    """What can be chosen, by name: nobody who looks at the page names a path.

    scenarios   names of shipped ones and paths of files
    recordings  paths of folders, of files of spokes, and of topics
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
    known = {name: name for name in scenarios.shipped()}
    known.setdefault(scenario, os.path.abspath(scenario) if os.path.isfile(scenario) else scenario)
    found: dict[str, str] = {}
    if folder is not None and not os.path.isdir(folder):
        raise ValueError(f'--recordings {folder}: there is no such folder')
    if folder is None and recording and os.path.exists(recording):
        folder = os.path.dirname(os.path.abspath(recording))
    if folder is not None:
        inside = Path(os.path.abspath(folder))
        places = [*(file.parent for file in inside.glob('*/plots.csv')), *inside.glob('*.npz')]
        places += [place for place in inside.iterdir() if mcap_name.is_mcap(place)]
        found = {place.name: str(place) for place in sorted(places)[:MOST_RECORDINGS]}
    if recording:
        found[os.path.basename(os.path.abspath(recording))] = os.path.abspath(recording)
    return Offers(known, found)


class Plan(NamedTuple):
    """Nodes by name with their parameters, the tracker and its source; and a title."""

    nodes: dict[str, dict[str, Any]]
    title: str


def plan(args: Namespace, offered: Offers, shown: Shown) -> Plan:
    """What is to run. ValueError where something is wrong with it."""
    nodes: dict[str, dict[str, Any]] = {}
    if shown.recording:
        place = offered.recordings[shown.recording]
        source, given = 'recording_player', {'folder': place, 'rate': shown.rate}
        from_mapping(RecordingPlayerParameters, given)
        if spokes_file.is_spokes_file(place):
            video = tracker_options.video(args).parameters
            sweep = spokes_file.read(place).sweep
            for_tracker = dict(video_source.tracker_parameters(video, sweep))
            nodes['plot_extractor'] = dataclasses.asdict(video)
        elif mcap_name.is_mcap(place):
            from ..recording import mcap_topics

            for_tracker = mcap_topics.contents(place).of(TrackerParameters)
        else:
            for_tracker = dict(csv_folder.read(place).tracker_parameters)
    else:
        source, name = 'radar_simulator', offered.scenarios[shown.scenario]
        given = {'scenario': name, 'rate': shown.rate, 'seed': args.seed}
        from_mapping(RadarSimulatorParameters, given)
        chosen = scenarios.load(name)
        for_tracker = dict(chosen.tracker_parameters())
        if chosen.radar.video is not None:
            of_radar = video_source.for_scenario(chosen, tracker_options.video(args).parameters)
            for_tracker = video_source.scenario_tracker_parameters(chosen, of_radar)
            nodes['plot_extractor'] = dataclasses.asdict(of_radar)
    if args.estimator:
        for_tracker['estimator'] = args.estimator
    if args.extent:
        for_tracker['extent'] = args.extent
    checked = from_mapping(TrackerParameters, for_tracker)
    for_tracker = {name: getattr(checked, name) for name in for_tracker}  # ints become floats
    nodes = {'tracker': for_tracker, **nodes}
    if shown.rate != 1:
        for parameters in nodes.values():
            parameters['use_sim_time'] = True
    return Plan({**nodes, source: given}, shown.recording or shown.scenario)
