"""A chart of an incident: ways of own ship and targets, and the manoeuvre that would have done."""

from pathlib import Path

import numpy as np

from ..evaluation.incident import Incident, names
from ..files import Place, written
from ..geometry import NAUTICAL_MILE


def draw(found: Incident, title: str, file: Place) -> None:
    """Draws into an image file; a dot is where each was at the moment, in NM from own ship there.

    ValueError without matplotlib (extra `plot`).
    """
    try:
        from matplotlib.figure import Figure
    except ModuleNotFoundError as error:
        raise ValueError('drawing needs matplotlib: pip install "marine_tracker[plot]"') from error
    picture = found.output.picture
    centre = picture.own.position

    def miles(position: np.ndarray) -> np.ndarray:
        return (position - centre) / NAUTICAL_MILE

    figure = Figure(figsize=(9, 9), layout='constrained')
    axes = figure.add_subplot(aspect='equal', xlabel='east, NM', ylabel='north, NM', title=title)
    until = [one for one in found.pictures if one.time <= found.time]
    axes.plot(*miles(np.array([one.own.position for one in until])).T, color='black', linewidth=1.5)
    axes.plot(0, 0, 'o', color='black', label='own ship')
    numbers = found.output.report.tracks.number
    for row, (id_, name) in enumerate(zip(picture.targets.id, names(picture, numbers))):
        way = np.concatenate(
            [one.motion.position[one.targets.id == id_] for one in until] or [np.empty((0, 2))]
        )
        colour = 'crimson' if row == found.subject else '0.55'
        axes.plot(*miles(way).T, color=colour, linewidth=1.0)
        place = miles(picture.motion.position[row])
        axes.plot(*place, 'o', color=colour, markersize=4)
        axes.annotate(name, tuple(place), xytext=(4, 4), textcoords='offset points', color=colour)
    if found.remedies:
        best = found.remedies[0]
        axes.plot(
            *miles(best.way).T,
            '--',
            color='tab:green',
            label=f'{best.kind}, {best.before / 60:.0f} min before',
        )
    axes.legend(loc='upper right')
    path = Path(file)
    with written(path, 'wb') as image:
        figure.savefig(image, format=path.suffix.lstrip('.') or 'png', dpi=110)
