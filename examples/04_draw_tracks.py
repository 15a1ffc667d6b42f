"""Draw five minutes of a busy strait: what the radar plotted, and what the tracker made of it.

    python examples/04_draw_tracks.py busy_strait.png

Grey dots are plots (most are sea clutter), coloured lines are confirmed tracks, with a vector of
three minutes. Needs matplotlib.
"""

import sys

import matplotlib
import numpy as np

from marine_tracker import service_for
from marine_tracker.geometry import NAUTICAL_MILE, unit_vector
from marine_tracker.simulation import radar, scenario

matplotlib.use('Agg')
import matplotlib.pyplot as plt

SCANS = 110  # five minutes
VECTOR_S = 180.0

strait = scenario.load('busy_strait')
service = service_for(strait.tracker_parameters())
memory = service.start()
plots, ways = [], {}
for scan, _ in radar.simulate(strait, seed=1):
    memory, output = service.step(memory, scan)
    report, estimate = output.report, output.estimate
    offset = scan.plots.range[:, None] * unit_vector(scan.plots.bearing)
    plots.append(scan.own_ship.position[0] + offset)
    for row in np.flatnonzero(report.tracks.number > 0):
        ways.setdefault(report.tracks.number[row], []).append(
            (*estimate.position[row], *estimate.velocity[row])
        )
    if len(plots) == SCANS:
        break

figure, axes = plt.subplots(figsize=(9, 9), facecolor='#0b1a24')
axes.set_facecolor('#0b1a24')
axes.plot(
    *np.concatenate(plots).T / NAUTICAL_MILE, '.', color='#7d8f99', markersize=1.2, alpha=0.35
)
shown = set(memory.tracker.tracks.number[memory.tracker.tracks.number > 0])
for number in sorted(shown):
    way = np.array(ways[number]) / NAUTICAL_MILE
    (line,) = axes.plot(way[:, 0], way[:, 1], linewidth=1.6)
    ahead = way[-1, :2] + VECTOR_S * way[-1, 2:]
    axes.plot(*np.array([way[-1, :2], ahead]).T, ':', color=line.get_color(), linewidth=1.2)
    axes.plot(*way[-1, :2], 'o', mfc='none', color=line.get_color(), markersize=7)
    axes.annotate(
        f'{number:02d}',
        way[-1, :2],
        xytext=(6, 4),
        textcoords='offset points',
        color=line.get_color(),
        fontsize=7,
    )
own = scan.own_ship.position[-1] / NAUTICAL_MILE
axes.plot(*own, 'o', mfc='none', color='white', markersize=9)
axes.plot(*own, 'o', mfc='none', color='white', markersize=5)
for ring in (3, 6, 9, 12):
    axes.add_patch(plt.Circle(own, ring, fill=False, color='#2f4a58', linewidth=0.8))
axes.set(
    aspect='equal',
    xlim=own[0] + [-12.5, 12.5],
    ylim=own[1] + [-12.5, 12.5],
    xlabel='east, NM',
    ylabel='north, NM',
)
axes.set_title(
    f'{len(shown)} tracks among {sum(map(len, plots)) // SCANS} plots a revolution', color='white'
)
axes.tick_params(colors='#7d8f99')
axes.xaxis.label.set_color('#7d8f99')
axes.yaxis.label.set_color('#7d8f99')
picture = sys.argv[1] if len(sys.argv) > 1 else 'busy_strait.png'
figure.savefig(picture, dpi=110, bbox_inches='tight')
print(f'{len(shown)} tracks drawn in {picture}')
