"""Motions of the second plant's own trials, at the controller's ticks: each kind is a function in a table.

Bounds of a motion: angle, speed and acceleration that the joint can follow.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from sim_backend.second_plant.controller import CLOSED, OPEN
from sim_backend.second_plant.simulate import TICK_S, Plan

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Bounds:
    """What a motion must stay within.

    Attributes:
        angle_rad, speed_rad_s, acceleration_rad_s2: of the joint.
        hold_a: current that holds the arm at 90 degrees.
        break_a: current that overcomes the static friction.
    """

    angle_rad: float
    speed_rad_s: float
    acceleration_rad_s2: float
    hold_a: float
    break_a: float


@dataclass(frozen=True)
class Motion:
    """Position asked for, and the current of the open-loop parts (NaN elsewhere), shape (ticks,)."""

    target_rad: FloatArray
    open_a: FloatArray


def _closed(target: FloatArray) -> Motion:
    return Motion(target, np.full(len(target), np.nan))


def _times(ticks: int) -> FloatArray:
    return np.arange(ticks, dtype=np.float64) * TICK_S


def _quintic(start: float, end: float, ticks: int) -> FloatArray:
    s = np.linspace(0.0, 1.0, max(ticks, 2))
    return start + (end - start) * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


def _rounded(wave: FloatArray, width_s: float) -> FloatArray:
    """Averaged twice over a width: corners become parabolas and jumps become ramps with round ends."""
    width = max(int(width_s / TICK_S), 2)
    for _ in range(2):
        wave = np.convolve(np.pad(wave, (width - 1, 0), mode="edge"), np.full(width, 1.0 / width), mode="valid")
    return wave


def point_to_point(ticks: int, b: Bounds, random: np.random.Generator) -> Motion:
    """Quintic moves between drawn places, with rests between."""
    place, parts, made = 0.0, [], 0
    while made < ticks:
        goal = float(random.uniform(-1.0, 1.0)) * b.angle_rad
        way = abs(goal - place)
        share = float(random.uniform(0.3, 1.0))  # of the speed; a quintic peaks at 1.875 way/T and 5.77 way/T^2
        seconds = max(1.875 * way / (share * b.speed_rad_s), (5.77 * way / b.acceleration_rad_s2) ** 0.5, 0.1)
        move = _quintic(place, goal, int(seconds / TICK_S))
        rest = np.full(int(float(random.uniform(0.05, 0.6)) / TICK_S), goal)
        parts += [move, rest]
        made += len(move) + len(rest)
        place = goal
    return _closed(np.concatenate(parts)[:ticks])


def _within(wave: FloatArray, b: Bounds, share: float) -> FloatArray:
    """Scale a wave to a share of the bound that it meets first, and fade it in."""
    rate = np.gradient(wave, TICK_S)
    most = max(
        float(np.abs(wave).max()) / b.angle_rad,
        float(np.abs(rate).max()) / b.speed_rad_s,
        float(np.abs(np.gradient(rate, TICK_S)).max()) / b.acceleration_rad_s2,
    )
    fade = np.clip(_times(len(wave)) / 0.5, 0.0, 1.0)
    return wave * share / most * fade**3 * (10.0 - 15.0 * fade + 6.0 * fade**2)


def swept_sine(ticks: int, b: Bounds, random: np.random.Generator) -> Motion:
    """A sine whose frequency rises or falls, its amplitude falling with the frequency."""
    low, high = float(random.uniform(0.15, 0.4)), float(random.uniform(1.5, 5.0))
    hertz = low * (high / low) ** (_times(ticks) / (ticks * TICK_S))
    if random.random() < 0.3:
        hertz = hertz[::-1]
    wave = np.sin(2.0 * pi * np.cumsum(hertz) * TICK_S) * (low / hertz) ** 1.3
    return _closed(_within(wave, b, float(random.uniform(0.6, 1.0))))


def multisine(ticks: int, b: Bounds, random: np.random.Generator) -> Motion:
    """Sines of random phase, amplitudes falling with frequency (Schoukens, Pintelon 2012)."""
    count, base = int(random.integers(4, 12)), float(random.uniform(0.1, 0.3))
    wave = np.zeros(ticks)
    for order in range(1, count + 1):
        phase = 2.0 * pi * base * order * _times(ticks) + float(random.uniform(0.0, 2.0 * pi))
        wave += np.sin(phase) / order
    return _closed(_within(wave - wave[0], b, float(random.uniform(0.5, 1.0))))


def speed_steps(ticks: int, b: Bounds, random: np.random.Generator) -> Motion:
    """Pseudo-random levels of speed, corners rounded, turned back at the ends."""
    speed, place, made = np.zeros(ticks), 0.0, 0
    while made < ticks:
        length = min(int(float(random.uniform(0.3, 1.2)) / TICK_S), ticks - made)
        level = b.speed_rad_s * float(random.choice([0.05, 0.15, 0.4, 0.8])) * float(random.choice([-1.0, 1.0]))
        if abs(place + level * length * TICK_S) > b.angle_rad:
            level = -abs(level) if place > 0.0 else abs(level)
        room = b.angle_rad - place if level > 0.0 else b.angle_rad + place
        length = max(min(length, int(room / abs(level) / TICK_S)), 1)
        speed[made : made + length] = level
        place += level * length * TICK_S
        made += length
    rest = np.zeros(int(0.3 / TICK_S))
    speed = _rounded(np.concatenate([rest, speed]), max(2.0 * b.speed_rad_s / b.acceleration_rad_s2, 0.05))[:ticks]
    return _closed(np.clip(np.cumsum(speed) * TICK_S, -1.3 * b.angle_rad, 1.3 * b.angle_rad))


def slow_triangle(ticks: int, b: Bounds, random: np.random.Generator) -> Motion:
    """Slow constant speeds up and down with a rest at each corner."""
    rate = b.speed_rad_s * float(np.exp(random.uniform(np.log(0.03), np.log(0.25))))
    reach = min(b.angle_rad, rate * ticks * TICK_S / 4.0)
    centre = float(random.uniform(-1.0, 1.0)) * (b.angle_rad - reach)
    leg, rest = int(2.0 * reach / rate / TICK_S), int(float(random.uniform(0.0, 1.0)) / TICK_S)
    up, top = np.linspace(-reach, reach, max(leg, 2)), np.full(rest, reach)
    period = np.concatenate([up, top, up[::-1], -top])
    shift = len(up) // 2
    wave = np.tile(period, ticks // len(period) + 2)[shift : shift + ticks]
    return _closed(centre + _rounded(wave, 0.05))


def breakaway_ramp(ticks: int, b: Bounds, random: np.random.Generator) -> Motion:
    """Rests of drawn lengths, each followed by a current that ramps until the joint has left its place."""
    place = float(random.uniform(-0.6, 0.6)) * b.angle_rad
    target, open_a = np.full(ticks, place), np.full(ticks, np.nan)
    at = int(0.4 / TICK_S)
    while at < ticks:
        seconds = float(np.exp(random.uniform(np.log(0.2), np.log(2.0))))
        count = min(int(seconds / TICK_S), ticks - at)
        sign = float(random.choice([-1.0, 1.0]))
        ramp = b.hold_a * np.sin(place) + sign * 2.0 * b.break_a * np.linspace(-0.2, 1.0, count)
        open_a[at : at + count] = ramp
        at += count + int(float(np.exp(random.uniform(np.log(0.2), np.log(2.5)))) / TICK_S)
    return Motion(target, open_a)


def free_swing(ticks: int, b: Bounds, random: np.random.Generator) -> Motion:
    """Lift the arm and let it go at no current, again and again."""
    target, open_a = np.zeros(ticks), np.full(ticks, np.nan)
    at, place = 0, 0.0
    while at < ticks:
        goal = float(random.uniform(0.6, 1.0)) * b.angle_rad * float(random.choice([-1.0, 1.0]))
        seconds = max(2.2 * abs(goal - place) / b.speed_rad_s, (6.0 * abs(goal - place) / b.acceleration_rad_s2) ** 0.5)
        move = _quintic(place, goal, int(seconds / TICK_S))
        target[at : at + len(move)] = move[: ticks - at]
        at += len(move)
        rest, free = int(0.3 / TICK_S), int(float(random.uniform(0.8, 1.6)) / TICK_S)
        target[at : at + rest] = goal
        at += rest
        released = np.clip(1.0 - np.arange(free) * TICK_S / 0.1, 0.0, 1.0) * b.hold_a * np.sin(goal)
        down = _quintic(goal, 0.0, free)  # what the controller would ask for; it is off
        target[at : at + free] = down[: max(ticks - at, 0)]
        open_a[at : at + free] = released[: max(ticks - at, 0)]
        at += free
        place = 0.0
        back = int(0.8 / TICK_S)  # from wherever the arm hangs now, to hanging down
        target[at : at + back] = 0.0
        at += back
    return Motion(target, open_a)


def torque_staircase(ticks: int, b: Bounds, random: np.random.Generator) -> Motion:
    """Steps of current about the one that holds the arm, within and beyond the friction."""
    place = float(random.uniform(-0.8, 0.8)) * b.angle_rad
    target, open_a = np.full(ticks, place), np.full(ticks, np.nan)
    at, count, rise = (
        int(0.5 / TICK_S),
        int(0.2 / TICK_S),
        np.clip(np.arange(int(0.2 / TICK_S)) * TICK_S / 0.1, 0.0, 1.0),
    )
    while at < ticks:
        before = 0.0
        for share in (0.3, 0.6, 0.9, 1.2, 1.5):
            level = share * float(random.choice([-1.0, 1.0])) * b.break_a
            stair = b.hold_a * np.sin(place) + before + (level - before) * rise
            open_a[at : at + count] = stair[: max(ticks - at, 0)]
            before = level
            at += count
        at += int(0.8 / TICK_S)
    return Motion(target, open_a)


KINDS: dict[str, Callable[[int, Bounds, np.random.Generator], Motion]] = {
    "point_to_point": point_to_point,
    "swept_sine": swept_sine,
    "multisine": multisine,
    "speed_steps": speed_steps,
    "slow_triangle": slow_triangle,
    "breakaway_ramp": breakaway_ramp,
    "free_swing": free_swing,
    "torque_staircase": torque_staircase,
}


OPEN_KINDS = ("breakaway_ramp", "free_swing", "torque_staircase")
"""Kinds of which parts are commanded by current."""


def plan_of(motion: Motion, random: np.random.Generator, walk_s: float, rub_s: float, busy_s: float) -> Plan:
    """What is asked at every tick, and the disturbances of the trial.

    Args:
        motion: of the trial.
        random: draws the disturbances.
        walk_s: correlation time of the walk.
        rub_s: mean time between switches of the telegraph.
        busy_s: mean time between switches of the other axis.
    """
    ticks = len(motion.target_rad)
    speed = np.gradient(motion.target_rad, TICK_S)
    speed = np.convolve(np.pad(speed, 10, mode="edge"), np.full(21, 1.0 / 21.0), mode="valid")
    fade = float(np.exp(-TICK_S / walk_s))
    walk = lfilter([(1.0 - fade**2) ** 0.5], [1.0, -fade], random.standard_normal(ticks))
    return Plan(
        np.where(np.isnan(motion.open_a), CLOSED, OPEN).astype(np.int64),
        motion.target_rad,
        speed,
        np.gradient(speed, TICK_S),
        np.nan_to_num(motion.open_a),
        np.asarray(walk),
        _telegraph(ticks, rub_s, random),
        _telegraph(ticks, busy_s, random),
    )


def _telegraph(ticks: int, mean_s: float, random: np.random.Generator) -> FloatArray:
    switches = random.random(ticks) < TICK_S / mean_s
    return (np.cumsum(switches) % 2).astype(float)
