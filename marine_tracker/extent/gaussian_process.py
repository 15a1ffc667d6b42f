"""Motion and outline of extended targets: Gaussian-process contour with noisy input (paper 004).

The state is x = [e n ve vn psi psi' f_1 .. f_M]: centre, velocity, heading and its rate, outline
(see `radial_function`). A cell z lies on the outline as seen from the centre c:

    z = c + p s r(b) + e,   b = theta - psi,   theta = bearing of z - c

with p along and t across theta, e ~ N(0, R). s is 1 for cells on the outline. For cells inside it,
s is random (Wahlstroem and Oezkan 2015, section V). Only the distance |z - c| carries information,
so each cell is one number:

    nu = |z - c| - s mu,  H_c = p' - (s mu' / |z - c|) t',  H_psi = -s mu',  H_f = s h
    S = H P H' + p' R p + s^2 V + var(s) (mu^2 + v)

mu, mu', h and V are those of `input_noise`. Cells are taken one after the other. Each one is
linearised at the state after the previous one.
"""

from typing import NamedTuple

import numpy as np

from ..geometry import to_range_bearing, unit_vector
from ..types import Array, IntArray, put, take
from .input_noise import VARIANTS, input_variance, noisy_radius
from .radial_function import Contour, radius
from .random_matrix import constant_velocity

HEADING, RATE, FIRST_RADIUS = 4, 5, 6  # index in the state where each begins
PLACE = np.array([0, 1, HEADING])  # entries of the state on which the angle depends
NEAREST = 0.5  # of mu: closer cells have no more effect on the angle than one at this distance
TINY = 1e-6  # m


class Model(NamedTuple):
    """The assumptions about a class of targets.

    contour     prior of the outline
    variant     one of VARIANTS
    noise       m^2/s^3, density of the white acceleration of each axis
    turn_noise  rad^2/s^3, the same of the heading
    full        whether the input variance counts the state's variance in addition to the cell's
    inside      mean and deviation of s
    gate        cells whose nu^2 / S exceeds it are left out
    """

    contour: Contour
    variant: str
    noise: float
    turn_noise: float
    full: bool = True
    inside: tuple[float, float] = (1.0, 0.0)
    gate: float = np.inf


class GpState(NamedTuple):
    """One row a target; n = 6 + M.

    time        [N]        s
    mean        [N, n]     x
    covariance  [N, n, n]
    semi_axes   [N, 2]     m, of the base, ahead and abeam
    """

    time: Array
    mean: Array
    covariance: Array
    semi_axes: Array


class Measurement(NamedTuple):
    """A cell as one number: innovation nu [N] m, jacobian H [N, n], noise [N] m^2 beside H P H'."""

    innovation: Array
    jacobian: Array
    noise: Array


def start(
    model: Model, time: Array, motion: Array, covariance: Array, f: Array, semi_axes: Array
) -> GpState:
    """New rows of time [N] s, motion [N, 6] = [e n ve vn psi psi'] with covariance [N, 6, 6].

    f [N, M], in units of the base with semi_axes [N, 2] m, has the prior's covariance. ValueError
    if the variant is not one of VARIANTS.
    """
    if model.variant not in VARIANTS:
        raise ValueError(f'variant is {model.variant!r}; it must be one of {", ".join(VARIANTS)}')
    n = FIRST_RADIUS + len(model.contour.angle)
    joint = np.zeros((len(time), n, n))
    joint[:, :FIRST_RADIUS, :FIRST_RADIUS] = covariance
    joint[:, FIRST_RADIUS:, FIRST_RADIUS:] = model.contour.covariance
    return GpState(
        np.array(time, float), np.concatenate([motion, f], 1), joint, np.array(semi_axes, float)
    )


def predict(state: GpState, time: Array, model: Model) -> GpState:
    """Predicts all rows to the times [N] s: straight motion, constant rate of turn, unchanged
    outline.
    """
    step = time - state.time
    _, kick = constant_velocity(step)
    mean, covariance = state.mean.copy(), state.covariance.copy()
    for moved, speed, noise in (
        (0, 2, model.noise),
        (1, 3, model.noise),
        (HEADING, RATE, model.turn_noise),
    ):
        mean[:, moved] += step * mean[:, speed]
        covariance[:, moved] += step[:, None] * covariance[:, speed]
        covariance[:, :, moved] += step[:, None] * covariance[:, :, speed]
        pair = np.array([moved, speed])
        covariance[:, pair[:, None], pair] += noise * kick
    return GpState(np.array(time, float), mean, covariance, state.semi_axes)


def measure(
    state: GpState, cell: Array, noise: Array, model: Model, rng: np.random.Generator | None = None
) -> Measurement:
    """Measurements of cells [N, 2] m with noise [N, 2, 2] m^2, one for each row of the state."""
    distance, bearing = to_range_bearing(cell - state.mean[:, :2])
    along = unit_vector(bearing)
    across = np.stack([along[:, 1], -along[:, 0]], -1)  # t = dp / dtheta
    angle, f = bearing - state.mean[:, HEADING], state.mean[:, FIRST_RADIUS:]
    distance = np.maximum(distance, TINY)
    known = radius(model.contour, state.semi_axes, f, angle[:, None]).mean[:, 0]
    at = noisy_radius(
        model.contour,
        state.semi_axes,
        f,
        angle,
        input_variance(
            across,
            np.maximum(distance, NEAREST * np.abs(known)),
            noise,
            state.covariance[:, PLACE[:, None], PLACE] if model.full else None,
        ),
        model.variant,
        rng,
    )
    inside, spread = model.inside
    jacobian = np.zeros_like(state.mean)
    jacobian[:, :2] = along - (inside * at.slope / distance)[:, None] * across
    jacobian[:, HEADING] = -inside * at.slope
    jacobian[:, FIRST_RADIUS:] = inside * at.weight
    radial = ((along[:, None] @ noise)[:, 0] * along).sum(-1)
    return Measurement(
        distance - inside * at.mean,
        jacobian,
        radial + inside**2 * at.variance + spread**2 * (at.mean**2 + at.variance),
    )


def update(
    state: GpState,
    rows: IntArray,
    cells: Array,
    count: IntArray,
    noise: Array,
    model: Model,
    rng: np.random.Generator | None = None,
) -> tuple[GpState, Array]:
    """Updates the K named rows, which are predicted to their cells' times, with their cells.

    cells [K, C, 2] m, of which the first count [K] of each row are used; noise [K, 2, 2] m^2, R of
    one cell. Returns the new state and the mean nu^2 / S [K] of the cells: about 1 if the model
    holds, nan without cells.
    """
    now = take(state, rows)
    total = np.zeros(len(rows))
    for j in range(int(count.max(initial=0))):
        has = (count > j).nonzero()[0]
        here = take(now, has)
        seen = measure(here, cells[has, j], noise[has], model, rng)
        cross = (here.covariance @ seen.jacobian[..., None])[..., 0]  # P H'
        spread = (cross * seen.jacobian).sum(-1) + seen.noise  # S
        squared = seen.innovation**2 / spread
        total[has] += squared
        gain = cross / spread[:, None] * (squared <= model.gate)[:, None]
        now.mean[has] += gain * seen.innovation[:, None]
        now.covariance[has] -= gain[:, :, None] * cross[:, None, :]
    nis = np.divide(total, count, out=np.full(len(rows), np.nan), where=count > 0)
    return put(state, rows, now), nis
