"""Own ship's yaw averaged out, and her manoeuvres not."""

import numpy as np
import pytest

from marine_tracker.arpa.own_motion import lately, own_motion
from marine_tracker.arpa.yaw import HISTORY, mean_velocity
from marine_tracker.geometry import unit_vector
from marine_tracker.types import OwnShip, append, take

SPEED = 7.5


def sailing(course_deg, until, spacing=0.7, noise=0.0, speed=SPEED, rng=None):
    """Samples from 0 s on of a ship whose course at times [K] s is course_deg(times)."""
    times = np.arange(0.0, until, spacing)
    velocity = np.multiply(speed, unit_vector(np.radians(course_deg(times))).T).T
    if noise:
        velocity = velocity + rng.normal(0, noise, velocity.shape)
    position = np.cumsum(spacing * velocity, 0)
    return OwnShip(times, position, velocity)


def yaw(amplitude, period, phase=0.0, about=40.0):
    return lambda time: about + amplitude * np.sin(2 * np.pi * time / period + phase)


def off_deg(samples, time, course_deg):
    """How far the course of own_motion is from the one given, deg."""
    known = take(samples, (samples.time <= time) & (samples.time > time - HISTORY))
    made = own_motion(known, time, 0.0).velocity
    return abs((np.degrees(np.arctan2(*made)) - course_deg + 180) % 360 - 180)


@pytest.mark.parametrize('period', [28.0, 36.0, 44.0, 52.0, 61.0])
def test_yaw_of_nine_degrees_leaves_no_half_degree_in_the_course(period):
    samples = sailing(yaw(9.0, period), 300.0)
    assert max(off_deg(samples, time, 40.0) for time in np.arange(130.0, 295.0, 2.5)) < 0.5


def test_an_irregular_seaway_leaves_less_than_a_fifth_of_the_yaw():
    """Swings of many periods about 40 s, RMS 5 deg; of 8 seas 95 % of the errors."""
    errors = []
    for seed in range(8):
        rng = np.random.default_rng(seed)
        rate, phase = 2 * np.pi / 40 * rng.normal(1, 0.15, 15), rng.uniform(0, 2 * np.pi, 15)

        def course(time, rate=rate, phase=phase):
            return 5.0 * np.sqrt(2 / 15) * np.sin(np.outer(time, rate) + phase).sum(1)

        samples = sailing(course, 300.0, noise=0.05, rng=rng)
        errors += [off_deg(samples, time, 0.0) for time in np.arange(130.0, 295.0, 5.0)]
    assert np.quantile(errors, 0.95) < 1.0


def test_averaging_begins_within_a_minute_and_a_half_of_the_first_sample():
    samples = sailing(yaw(8.0, 55.0, 1.0), 200.0)
    assert all(off_deg(samples, time, 40.0) < 2.5 for time in np.arange(90.0, 195.0, 3.0))


@pytest.mark.parametrize(('angle', 'rate'), [(50.0, 0.8), (-20.0, 0.4), (110.0, 2.5), (35.0, 0.15)])
def test_a_manoeuvre_without_yaw_is_followed_at_once(angle, rate):
    """At most 4 deg of lag while she turns, half a degree from 20 s after it on."""
    rng, begin = np.random.default_rng(2), 160.0
    end = begin + abs(angle) / rate

    def course(time):
        return 10.0 + np.sign(angle) * np.clip((time - begin) * rate, 0, abs(angle))

    samples = sailing(course, end + 100, noise=0.05, rng=rng)
    times = np.arange(begin, end + 95, 2.5)
    off = np.array([off_deg(samples, time, course(time)) for time in times])
    assert off.max() < 4.0
    assert off[times > end + 20].max() < 1.0


def test_a_manoeuvre_in_a_seaway_is_no_later_than_the_yaw_is_wide():
    """40 deg to starboard in yaw of 7 deg: right within the yaw once she is on the new course."""
    begin, end = 160.0, 220.0

    def to(time):
        return np.clip((time - begin) * 40 / 60, 0, 40)

    for phase in np.arange(0.0, 6.0, 1.2):
        swing = yaw(7.0, 38.0, phase, 0.0)
        samples = sailing(lambda time, swing=swing: to(time) + swing(time), 340.0)
        times = np.arange(begin, 335.0, 2.5)
        off = np.array([off_deg(samples, time, to(time)) for time in times])
        assert off.max() < 25.0
        assert off[times > end + 5].max() < 12.0
        assert off[times > end + 75].max() < 1.5


def test_a_change_of_speed_is_followed_too():
    def speed(time):
        return np.clip(9.0 - 0.05 * (time - 150), 4.0, 9.0)

    times = np.arange(0.0, 330.0, 0.9)
    velocity = speed(times)[:, None] * unit_vector(np.full(len(times), 1.0))
    samples = OwnShip(times, np.cumsum(0.9 * velocity, 0), velocity)
    for time in np.arange(140.0, 325.0, 4.0):
        known = take(samples, (samples.time <= time) & (samples.time > time - HISTORY))
        made = np.hypot(*own_motion(known, time, 0.0).velocity)
        assert made == pytest.approx(speed(time), abs=0.3)


def test_a_zigzag_on_purpose_is_no_yaw():
    samples = sailing(yaw(35.0, 60.0), 200.0)
    assert mean_velocity(samples, 195.0) is None


def test_too_few_samples_tell_no_yaw():
    assert mean_velocity(sailing(yaw(8.0, 40.0), 200.0, spacing=13.0), 198.0) is None
    assert mean_velocity(sailing(yaw(0.0, 40.0), 20.0), 19.5) is None


def test_what_was_before_a_gap_does_not_count():
    """Ten seconds after 40 s of silence in which she turned, only the new course is told."""
    before, after = sailing(yaw(5.0, 35.0), 120.0), sailing(yaw(0.0, 35.0, about=100.0), 172.0)
    samples = append(before, take(after, after.time > 160))
    assert mean_velocity(samples, 171.0) is None
    assert off_deg(samples, 171.0, 100.0) < 0.1


def test_its_covariance_covers_the_error_of_noise():
    """400 runs of 0.3 m/s white noise: errors as the deviations say, within a quarter."""
    rng, errors, told = np.random.default_rng(4), [], []
    for _ in range(400):
        found = mean_velocity(sailing(yaw(0.0, 1.0), 119.0, noise=0.3, rng=rng), 118.9)
        if found is not None:
            errors.append(found[0] - SPEED * unit_vector(np.radians(40.0)))
            told.append(np.trace(found[1]) / 2)
    assert len(errors) > 200
    assert np.std(errors) == pytest.approx(np.sqrt(np.mean(told)), rel=0.25)


def test_samples_are_kept_as_long_as_they_count():
    samples = sailing(yaw(6.0, 40.0), 400.0)
    kept = OwnShip(np.zeros(0), np.zeros((0, 2)), np.zeros((0, 2)))
    for begin in np.arange(0.0, 390.0, 3.0):
        part = take(samples, (samples.time >= begin) & (samples.time < begin + 3.0))
        kept = lately(kept, part, begin + 3.0)
    assert kept.time[0] == pytest.approx(390.0 - HISTORY, abs=1.0)
    assert (np.diff(kept.time) > 0).all()
