"""Pictures of the IMO report: distributions of errors, tracks, courses after a turn."""

from functools import partial

import numpy as np

from ..evaluation.result import Picture
from ..geometry import NAUTICAL_MILE, unit_vector
from ..service import service_for
from ..simulation import radar, scenario
from .accuracy import FIGURES, UNITS, a823_limits, a823_trial, msc192_limits
from .figures import RIGHT_WITHIN, Results
from .manoeuvres import RIGHT

COLOURS = ('#1f5fa8', '#c2571a', '#3b7d3a', '#8a4fa3')
A823_COLOUR, MSC192_COLOUR, FIT_COLOUR = '#b00020', '#e08a00', '0.35'


def pictures(results: Results, seed: int) -> list[Picture]:
    """Pictures of everything that was run."""
    found = [
        Picture(
            f'errors_{minutes}_min_{number}',
            (10, 6),
            partial(_errors, results=results, key=(minutes, number)),
        )
        for minutes, number in results.steady
    ]
    if results.steady:
        found.append(
            Picture(
                'tracks', (10, 10), partial(_tracks, estimator=results.estimators[0], seed=seed)
            )
        )
    if results.turns:
        found.append(Picture('target_turns', (10, 3.6), partial(_turns, results=results)))
    return found


def _errors(canvas, results, key):
    """For each figure, the share of runs whose error is at most a given value."""
    minutes, number = key
    outcome = results.steady[key]
    canvas.suptitle(
        f'Scenario {number} after {minutes} min: share of {len(outcome.errors)} runs '
        'whose error is not larger'
    )
    limits = (
        (a823_limits(number, minutes), A823_COLOUR, 'A.823'),
        (msc192_limits(outcome.truth, minutes), MSC192_COLOUR, 'MSC.192'),
    )
    names = ('straight-line fit', *results.estimators)
    for k, axes in enumerate(canvas.subplots(2, 3).flat):
        for column, (name, colour) in enumerate(zip(names, (FIT_COLOUR, *COLOURS))):
            errors = np.sort(outcome.errors[:, column, k])
            axes.plot(
                errors,
                np.arange(1, len(errors) + 1) / len(errors),
                color=colour,
                label=name,
                linestyle='--' if column == 0 else '-',
            )
        for limit, colour, name in limits:
            if not np.isnan(limit[k]):
                axes.axvline(limit[k], color=colour, linewidth=1, label=name)
        axes.axhline(0.95, color='0.8', linewidth=1)
        axes.set(xlabel=f'{FIGURES[k]}, {UNITS[k]}', xlim=(0, None), ylim=(0, 1.01))
        axes.grid(color='0.92')
        if k == 0:
            axes.legend(fontsize=7)


def _tracks(canvas, estimator, seed):
    """One run of each scenario, relative to own ship: plots, and the shown motion of the target."""
    canvas.suptitle(f'One run of each scenario, 3 min, relative to own ship ({estimator})')
    for number, axes in enumerate(canvas.subplots(2, 2).flat, 1):
        trial = a823_trial(number, 180.0)
        loaded = scenario.build(trial.values, 'trial')
        service = service_for(loaded.tracker_parameters(), estimator=estimator)
        memory = service.start()
        places = []
        for scan, _ in radar.simulate(loaded, seed):
            memory, output = service.step(memory, scan)
            places += [r * unit_vector(b) for r, b in zip(scan.plots.range, scan.plots.bearing)]
        picture = output.picture
        truth, own = loaded.truth_at(trial.moment), loaded.own_ship_at(trial.moment)
        axes.plot(
            *np.array(places).T / NAUTICAL_MILE, '.', color='0.6', markersize=3, label='plots'
        )
        lines = [
            (
                truth.position[0] - own.position[0],
                truth.velocity[0] - own.velocity[0],
                FIT_COLOUR,
                'truth',
                '--',
            )
        ]
        lines += [
            (
                position - picture.own.position,
                velocity - picture.own.velocity,
                COLOURS[0],
                'shown, to its CPA',
                '-',
            )
            for position, velocity in zip(picture.motion.position, picture.motion.velocity)
        ]
        for position, velocity, colour, name, style in lines:
            ahead = max(-(position @ velocity) / (velocity @ velocity), 180.0)
            way = np.stack([position, position + ahead * velocity]) / NAUTICAL_MILE
            axes.plot(*way.T, style, color=colour, linewidth=1.2, label=name)
        axes.plot(0.0, 0.0, 'o', color='black', fillstyle='none', label='own ship')
        axes.set(
            title=f'scenario {number}',
            xlabel='east, NM',
            ylabel='north, NM',
            aspect='equal',
            adjustable='datalim',
        )
        axes.grid(color='0.92')
    axes.legend(fontsize=7)


def _turns(canvas, results):
    """95 % of the course errors during and after the turns of targets."""
    canvas.suptitle('Course error of 95 % of targets that turn')
    for turn, axes in zip(results.turns, canvas.subplots(1, len(results.turns), sharey=True)):
        for row, (name, colour) in enumerate(zip(results.estimators, COLOURS)):
            axes.plot(turn.after, turn.in_95[row], color=colour, label=name)
        axes.axvspan(-turn.angle / turn.rate, 0, color='0.93')
        axes.axhline(RIGHT, color=A823_COLOUR, linewidth=1)
        axes.axvline(RIGHT_WITHIN, color=A823_COLOUR, linewidth=1, linestyle=':')
        axes.set(
            title=f'{turn.angle:g} deg at {turn.rate:g} deg/s',
            xlabel='s after the turn',
            xlim=(-turn.angle / turn.rate - 40, None),
            ylim=(0, 60),
        )
        axes.grid(color='0.92')
    canvas.axes[0].set_ylabel('deg')
    canvas.axes[0].legend(fontsize=7)
