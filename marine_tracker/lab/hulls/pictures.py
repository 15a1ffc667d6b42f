"""Tracked hulls with the cells that the radar saw of them: one scan of both scenarios."""

from typing import Any

import numpy as np

from .traffic import Snapshot

NEAR = 350.0  # m around a ship that is shown enlarged


def paint(figure: Any, hulls: Snapshot | None, coast: Snapshot | None) -> None:
    """Left the whole coast; right the ships of `hulls`, each enlarged."""
    assert hulls is not None and coast is not None
    left, right = figure.subfigures(1, 2, width_ratios=(1, 1.25))
    axes = left.add_subplot(
        aspect='equal',
        title='coast: cells, tracks and their outlines',
        xlabel='east, m',
        ylabel='north, m',
    )
    _draw(axes, coast, 1.0)
    axes.plot(*coast.own, 'k^', markersize=7, label='own ship')
    axes.legend(loc='upper left', fontsize=8)
    for number, middle in enumerate(hulls.truth):
        axes = right.add_subplot(2, 3, number + 1, aspect='equal')
        _draw(axes, hulls, 8.0)
        axes.set(
            xlim=middle[0] + NEAR * np.array([-0.5, 0.5]),
            ylim=middle[1] + NEAR * np.array([-0.5, 0.5]),
            xticks=[],
            yticks=[],
        )
        axes.set_title(f'at {np.hypot(*(middle - hulls.own)):.0f} m', fontsize=9)
        to_own = (hulls.own - middle) / np.hypot(*(hulls.own - middle))
        axes.annotate(
            '',
            middle + 0.42 * NEAR * to_own,
            middle + 0.28 * NEAR * to_own,
            arrowprops={'arrowstyle': '->', 'color': '0.4'},
        )
    right.suptitle(
        f'hulls: {NEAR:.0f} m around each ship; the arrow points to the radar', fontsize=10
    )


def _draw(axes, of: Snapshot, size: float) -> None:
    axes.scatter(*of.cells.T, s=size, color='#e69f00', linewidths=0, label='cells')
    axes.plot(*of.position.T, '+', color='#0072b2', label='tracks')
    for middle, outline in zip(of.position[of.extended], of.outline[of.extended]):
        corners = middle + np.concatenate([outline, outline[:1]])
        axes.plot(*corners.T, color='#0072b2', linewidth=1.2)
    for place, outline in zip(of.truth, of.true_outline):
        if np.isfinite(outline).all():
            axes.plot(*(place + outline).T, color='0.35', linewidth=1, linestyle='--')
    axes.plot([], [], color='#0072b2', linewidth=1.2, label='their hulls')
    axes.plot([], [], color='0.35', linewidth=1, linestyle='--', label='true hulls')
