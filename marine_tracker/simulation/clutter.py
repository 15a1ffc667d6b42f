"""False plots: uniform noise, and sea clutter that is dense around own ship."""

import numpy as np

from ..types import Array
from .scenario_radar import Clutter, ScenarioRadar

# Excess power of false plots, in units of noise: noise only just passes the threshold, sea clutter
# by more.
UNIFORM_EXCESS = 1.0
SEA_EXCESS = 5.0
WAVE_SPEED = 1.0  # m/s, standard deviation of the radial speeds of waves


def uniform_plots(
    clutter: Clutter, radar: ScenarioRadar, random: np.random.Generator
) -> tuple[Array, Array, Array]:
    """Range m, bearing rad and power above the threshold [M] of one revolution's noise plots.

    They are uniform over the area between blind and maximum range. M is Poisson.
    """
    count = random.poisson(clutter.uniform)
    near, far = radar.blind_range**2, radar.max_range**2
    distance = np.sqrt(near + (far - near) * random.random(count))
    return (
        distance,
        random.uniform(0, 2 * np.pi, count),
        random.exponential(UNIFORM_EXCESS, count),
    )


def sea_plots(
    clutter: Clutter, radar: ScenarioRadar, random: np.random.Generator
) -> tuple[Array, Array, Array]:
    """The same for sea clutter: range is exponential from the blind range, cut at the maximum.

    A radar resolves cells of equal angle. So an even false-alarm rate in cells is an even number
    per metre of range. The echo of the waves also gets weaker with range.
    """
    count = random.poisson(clutter.sea)
    within = -np.expm1(-(radar.max_range - radar.blind_range) / clutter.sea_scale)
    distance = radar.blind_range - clutter.sea_scale * np.log1p(-within * random.random(count))
    return (distance, random.uniform(0, 2 * np.pi, count), random.exponential(SEA_EXCESS, count))


def radial_speeds(
    radar: ScenarioRadar, noise: int, waves: int, random: np.random.Generator
) -> Array:
    """Radial speeds [noise + waves] m/s over ground of noise plots, then of sea clutter.

    Noise lies anywhere in the radar's Doppler band. Waves move towards the radar and away.
    """
    return np.concatenate(
        [
            random.uniform(-radar.max_radial_speed, radar.max_radial_speed, noise),
            random.normal(0.0, WAVE_SPEED, waves),
        ]
    )
