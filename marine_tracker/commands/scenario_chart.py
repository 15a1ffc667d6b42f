"""A chart of a scenario: the paths of all ships, in the frame of own ship's start."""

from pathlib import Path

import numpy as np

from ..files import Place, written
from ..geometry import NAUTICAL_MILE
from ..simulation.scenario import Scenario

STEPS = 241


def draw(loaded: Scenario, file: Place) -> None:
    """Draws the paths of own ship and targets into an image file, out to the radar's range.

    A dot marks each start. The circles are the radar's range at the start and at the end.

    Raises ValueError without matplotlib (extra `plot`).
    """
    try:
        from matplotlib.figure import Figure
    except ModuleNotFoundError as error:
        raise ValueError('drawing needs matplotlib: pip install "marine_tracker[plot]"') from error
    times = np.linspace(0.0, loaded.duration, STEPS)
    own = loaded.own_ship_at(times).position / NAUTICAL_MILE
    ways = np.full((len(loaded.fleet.names), STEPS, 2), np.nan)
    for step, time in enumerate(times):
        truth = loaded.truth_at(time)
        ways[truth.target - 1, step] = truth.position / NAUTICAL_MILE

    figure = Figure(figsize=(9, 9), layout='constrained')
    axes = figure.add_subplot(
        aspect='equal',
        xlabel='east, NM',
        ylabel='north, NM',
        title=f'{loaded.name} ({loaded.duration / 60:g} min)',
    )
    reach = loaded.radar.max_range / NAUTICAL_MILE
    around = np.linspace(0, 2 * np.pi, 361)
    for centre, style in ((own[0], '-'), (own[-1], ':')):
        axes.plot(
            centre[0] + reach * np.sin(around),
            centre[1] + reach * np.cos(around),
            style,
            color='0.8',
            linewidth=1,
        )
    for number, way in enumerate(ways, 1):
        known = np.flatnonzero(~np.isnan(way[:, 0]))
        if not len(known):
            continue
        (line,) = axes.plot(*way.T, linewidth=1.2)
        axes.plot(*way[known[0]], 'o', color=line.get_color(), markersize=4)
        axes.annotate(
            f'{number}',
            way[known[0]],
            xytext=(4, 4),
            textcoords='offset points',
            annotation_clip=True,
            fontsize=7,
            color=line.get_color(),
        )
    for shore in loaded.shores:
        axes.plot(*(shore.corners.T / NAUTICAL_MILE), color='0.45', linewidth=2)
    axes.plot(*(loaded.fixed.place.T / NAUTICAL_MILE), '.', color='0.6', markersize=2)
    axes.plot(*own.T, color='black', linewidth=2)
    axes.plot(*own[0], 'o', color='black', markersize=7, fillstyle='none')
    low, high = (edge(own[[0, -1]], axis=0) for edge in (np.min, np.max))
    axes.set(
        xlim=(low[0] - 1.03 * reach, high[0] + 1.03 * reach),
        ylim=(low[1] - 1.03 * reach, high[1] + 1.03 * reach),
    )
    axes.grid(color='0.92')
    kind = Path(file).suffix.removeprefix('.').lower() or 'png'
    if kind not in figure.canvas.get_supported_filetypes():
        raise ValueError(f'--plot is {file}; its name must end in that of an image, like .png')
    with written(file, 'wb') as image:
        figure.savefig(image, format=kind, dpi=110)
