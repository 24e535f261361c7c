"""What the base model of a joint is made of, and what its rivals are, as columns over true or measured motion.

They serve the oracle alone: they are written from the same books as the mechanisms, and know no lab.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import savgol_filter

from sim_backend.second_plant.mechanism import Scales
from sim_backend.second_plant.protocol import OPEN_KINDS
from sim_backend.second_plant.recording import SecondRecording

FloatArray = NDArray[np.float64]
FILMS = (0.01, 0.03, 0.06, 0.12)  # Stribeck speeds, as shares of the top speed
MOVING, SLOW = 0.01, 0.05  # of the top speed
SMOOTH_S = 0.08  # over which measured motion is differentiated
NEAR_RAD = 0.02  # to a reversal


@dataclass(frozen=True)
class Rows:
    """Motion of all trials, one after the other; arrays of shape (n,)."""

    angle: FloatArray
    speed: FloatArray
    acceleration: FloatArray
    passed: FloatArray
    load_kg: FloatArray
    warm_c: FloatArray
    session_s: FloatArray
    way: FloatArray  # since the last reversal
    effort: FloatArray
    effort_rate: FloatArray
    trial: NDArray[np.int64]
    moving: NDArray[np.bool_]
    stratum: NDArray[np.int64]  # 0 steady motion, 1 slow or near a reversal, 2 commanded by current

    @classmethod
    def of(cls, recordings: list[SecondRecording], scales: Scales) -> "Rows":
        """Join the trials of a joint; motion is that of the recorded position, and the effort in the same band."""
        parts = [_of_one(one, number) for number, one in enumerate(recordings)]
        angle, rate, acceleration, passed, load_kg, warm_c, session_s, way, effort, effort_rate, number = (
            np.concatenate(values) for values in zip(*parts, strict=True)
        )
        speed, trial = np.abs(rate), number.astype(np.int64)
        is_open = np.array([one.kind in OPEN_KINDS for one in recordings])[trial]
        near = (speed < SLOW * scales.top_rad_s) | (way < NEAR_RAD)
        stratum = np.where(is_open, 2, np.where(near, 1, 0))
        return cls(
            angle, rate, acceleration, passed, load_kg, warm_c, session_s, way, effort, effort_rate,
            trial, speed > MOVING * scales.top_rad_s, stratum,
        )  # fmt: skip


def _of_one(one: SecondRecording, number: int) -> list[FloatArray]:
    time_s = one.channels["time_s"]
    angle, speed, acceleration = (_rate(time_s, one.channels["position_rad"], order) for order in range(3))
    effort, effort_rate = (_rate(time_s, one.effort, order) for order in range(2))
    count = len(time_s)
    return [
        angle,
        speed,
        acceleration,
        one.truth.passed_n_m,
        np.full(count, one.load_kg),
        np.full(count, one.gear_c),
        one.session_s + time_s,
        _way(angle, speed),
        effort,
        effort_rate,
        np.full(count, float(number)),
    ]


def _rate(time_s: FloatArray, values: FloatArray, order: int) -> FloatArray:
    """Derivative of an order, by local cubics over `SMOOTH_S` (Savitzky, Golay 1964); stamps need not be even."""
    period_s = float(np.median(np.diff(time_s)))
    even = np.arange(time_s[0], time_s[-1], period_s)
    width = max(2 * int(0.5 * SMOOTH_S / period_s) + 1, 5)
    smooth: FloatArray = savgol_filter(np.interp(even, time_s, values), width, 3, deriv=order, delta=period_s)
    return np.asarray(np.interp(time_s, even, smooth), dtype=np.float64)


def _way(angle: FloatArray, speed: FloatArray) -> FloatArray:
    """Way since the last change of direction."""
    turned = np.flatnonzero(np.diff(np.sign(speed)) != 0.0) + 1
    last = np.zeros(len(angle), dtype=np.int64)
    last[turned] = turned
    return np.asarray(np.abs(angle - angle[np.maximum.accumulate(last)]))


def base_columns(rows: Rows, scales: Scales) -> FloatArray:
    """Inertia, weight, offset, Coulomb, viscous and Stribeck friction, delay of the effort; shape (n, columns)."""
    direction, size = np.sign(rows.speed), np.abs(rows.speed)
    weight = np.sin(rows.angle)
    films = [
        np.exp(-((size / (share * scales.top_rad_s)) ** power)) * direction
        for share in FILMS
        for power in (0.7, 1.0, 2.0)
    ]
    columns = [
        rows.acceleration, rows.acceleration * rows.load_kg, weight, weight * rows.load_kg, np.ones(len(size)),
        direction, rows.speed, *films, rows.effort_rate,
    ]  # fmt: skip
    return np.stack(columns, axis=1)


def rival_columns(rows: Rows, scales: Scales) -> dict[str, FloatArray]:
    """First-order columns of each textbook mechanism, by its name; shape (n, columns)."""
    q, v, load = rows.angle, rows.speed, rows.passed
    direction, pull = np.sign(v), np.abs(rows.passed)
    film = np.exp(-np.abs(v) / (FILMS[1] * scales.top_rad_s))
    wave = {order: (np.cos(order * scales.turns * q), np.sin(order * scales.turns * q)) for order in (1, 2, 3, 6, 12)}
    torque = load + direction * scales.coulomb_n_m
    span_s = float(rows.session_s.max())
    named = {
        "asymmetric_viscous": [np.abs(v)],
        "square_drag": [v * np.abs(v)],
        "tooth_loss": [pull * direction],
        "tooth_loss_square": [pull**2 * direction],
        "bearing_loss": [rows.load_kg * direction],
        "quadrant_coulomb": [np.sign(load * v) * direction],
        "back_driving_loss": [pull * direction * (load * v < 0.0)],
        "cold_coulomb": [(rows.warm_c - 25.0) * direction],
        "lubricant": [(rows.warm_c - 25.0) * v],
        "running_in": [np.exp(-rows.session_s / (share * span_s)) * direction for share in (0.2, 0.5, 1.0)],
        "eccentric_gear": [part * direction for part in wave[1]],
        "cogging": [part for parts in wave.values() for part in parts],
        "spring": [q],
        "turned_centre": [np.cos(q), np.cos(q) * rows.load_kg],
        "saturation": [torque * np.abs(torque) ** 2, torque * np.abs(torque)],
        "hot_winding": [(rows.warm_c - 25.0) * torque],
        "long_bristles": [np.exp(-rows.way / reach) * direction for reach in (0.003, 0.01, 0.03)],
        "backlash": [np.sign(load)],
        "twist": [_second_rate(load, rows.trial)],
        "lag": [rows.acceleration * film, rows.acceleration * direction * film],
        "ageing_contact": [np.exp(-rows.way / 0.005) * direction],
        "eccentric_encoder": [v**2 * wave[1][0], v**2 * wave[1][1], rows.acceleration * wave[1][0]],
        "sensor_gain": [np.abs(torque)],
        "blanking": [np.sign(torque)],
        "sag": [torque**3],
    }
    return {name: np.stack(columns, axis=1) for name, columns in named.items()}


def _second_rate(values: FloatArray, trial: NDArray[np.int64]) -> FloatArray:
    """Second difference inside each trial."""
    rate = np.zeros(len(values))
    rate[1:-1] = values[2:] - 2.0 * values[1:-1] + values[:-2]
    rate[np.flatnonzero(np.diff(trial))] = 0.0
    rate[np.flatnonzero(np.diff(trial)) + 1] = 0.0
    return rate
