"""Pictures of the HF scene: tracks of one run by each filter; errors and losses over time."""

from functools import partial
from typing import Any

import numpy as np

from ...evaluation.result import Picture
from .hf_trials import CROSSING, Outcome, Scene

# Colours of Okabe and Ito, safe for colour-blind readers.
STYLES = {
    'method2': ('#e69f00', '--'),
    'method1': ('#009e73', '-.'),
    'hf': ('#56b4e9', '-'),
    'hf_soft': ('#0072b2', '-'),
    'polar Kalman': ('#000000', ':'),
}
SHOWN = ('method2', 'method1', 'hf', 'hf_soft')
PERCENT, KM, KMH, DEG = 100, 1e3, 1 / 3.6, np.radians(1)


def pictures(on: Scene, outcomes: dict[str, Outcome]) -> list[Picture]:
    """The tracks of the first run, and the crossing ship over time in all runs."""
    return [
        Picture('alpha_beta_tracks', (10, 6.3), partial(tracks, on=on, outcomes=outcomes)),
        Picture('alpha_beta_errors', (11, 6), partial(errors, on=on, outcomes=outcomes)),
    ]


def tracks(figure: Any, on: Scene, outcomes: dict[str, Outcome]) -> None:
    """One plan for each mode: the true paths and the tracks. A track ends where it is lost."""
    way = (
        on.truth[..., 0, None]
        * np.stack([np.sin(on.truth[..., 2]), np.cos(on.truth[..., 2])], -1)
        / KM
    )
    panels = figure.subplots(2, 2, sharex=True, sharey=True)
    for axes, name in zip(panels.flat, SHOWN, strict=True):
        place = outcomes[name].place / KM
        for ship in range(way.shape[1]):
            axes.plot(*way[:, ship].T, color='0.75', linewidth=4, solid_capstyle='round')
            axes.plot(*place[:, ship].T, color=STYLES[name][0], linewidth=1.2)
            last = np.flatnonzero(np.isfinite(place[:, ship, 0]))[-1]
            if last < len(place) - 1:
                axes.plot(*place[last, ship], 'x', color='#d55e00', markersize=8, markeredgewidth=2)
            axes.annotate(
                f'{ship + 1}',
                way[0, ship],
                xytext=(5, 5),
                textcoords='offset points',
                fontsize=9,
                color='0.35',
            )
        lost = PERCENT * outcomes[name].lost[-1, :, CROSSING].mean()
        axes.set_title(f'{name}: ship 5 lost in {lost:.0f} % of the runs', fontsize=10)
        axes.set_aspect('equal')
        axes.margins(0.1)
        axes.grid(color='0.93')
    for axes in panels[:, 0]:
        axes.set_ylabel('north of the station, km')
    for axes in panels[1]:
        axes.set_xlabel('east of the station, km')
    figure.legend(
        handles=[
            figure.axes[0].plot([], [], color='0.75', linewidth=4, label='the ships')[0],
            figure.axes[0].plot(
                [], [], color='0.2', linewidth=1.2, label='tracks of the first run'
            )[0],
            figure.axes[0].plot(
                [], [], 'x', color='#d55e00', markersize=8, markeredgewidth=2, label='lost'
            )[0],
        ],
        loc='outside upper center',
        ncols=3,
        frameon=False,
    )


def errors(figure: Any, on: Scene, outcomes: dict[str, Outcome]) -> None:
    """RMS errors of the crossing ship over the runs whose track lives, and the share of lost
    tracks.
    """
    minutes = on.time / 60
    panels = figure.subplots(2, 2, sharex=True).flat
    for axes, what, part, size in zip(
        panels,
        ('range, km', 'radial speed, km/h', 'bearing, deg'),
        range(3),
        (KM, KMH, DEG),
        strict=False,
    ):
        for name, (colour, line) in STYLES.items():
            error = outcomes[name].error[:, :, CROSSING, part] / size
            alive = np.isfinite(error).sum(1)
            value = np.sqrt(np.nansum(error**2, 1) / np.maximum(alive, 1))
            value[alive < 5] = np.nan  # too few runs for a mean
            axes.plot(minutes, value, line, color=colour, label=name)
        axes.axhline(on.sigma[part] / size, color='0.6', linewidth=1, label='one plot')
        axes.set_title(f'RMS error of the {what}', fontsize=10)
        axes.set_ylim(0)
        axes.grid(color='0.93')
    axes = figure.axes[3]
    for name, (colour, line) in STYLES.items():
        axes.plot(
            minutes, PERCENT * outcomes[name].lost[:, :, CROSSING].mean(1), line, color=colour
        )
    axes.set_title('lost, % of the runs', fontsize=10)
    axes.set_ylim(-2, 102)
    axes.grid(color='0.93')
    for axes in figure.axes[2:]:
        axes.set_xlabel('minutes')
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc='outside upper center', ncols=len(labels), frameon=False)
