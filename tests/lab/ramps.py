"""A joint without gravity, pushed from rest by ramps and swung: its static friction may depend on rest and rate."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing

RATE_HZ, COUNT_RAD = 200.0, 1e-4
INERTIA, COULOMB, VISCOUS, STATIC = 0.02, 0.05, 0.03, 0.1
STROKE_S = 0.6
REPEATS = 2
HORIZONTAL = Facts(horizontal=True)
MODEL = ("inertia", "offset", "coulomb", "viscous")  # of sliding

Static = Callable[[float, float], float]
"""(rest [s], rate [N m/s]) -> static friction [N m]."""


def constant(_rest_s: float, _rate: float) -> float:
    return STATIC


@dataclass(frozen=True)
class Ramp:
    """What one start of a ramp trial should be found as."""

    direction: float
    effort: float
    rest_s: float
    rate: float


def ramp_trial(
    name: str,
    dwell_s: float,
    rate: float,
    static: Static,
    random: np.random.Generator,
    noise: float = 5e-4,
    load_kg: float = 0.0,
    ways: Sequence[float] = (1.0, -1.0),
) -> tuple[Recording, list[Ramp]]:
    """Rest, ramp until the joint lets go, a stroke; first forwards, then, without other ways, back."""
    inertia = INERTIA * (1.0 + load_kg)
    torque, speed, made = [np.zeros(int(0.5 * RATE_HZ))], [np.zeros(int(0.5 * RATE_HZ))], []
    for direction in ways:
        before = dwell_s + (0.0 if made else 0.5)
        level = rise_s = 0.0
        for _ in range(20):  # friction depends on the rest, which ends when the ramp reaches it
            level = static(before + rise_s, rate)
            rise_s = level / rate
        rest, rise = int(dwell_s * RATE_HZ), int(rise_s * RATE_HZ)
        stroke_s = np.arange(int(STROKE_S * RATE_HZ)) / RATE_HZ
        # it lets go with what the static level exceeds the Coulomb level by, and the ramp goes on, then ends softly
        share = stroke_s / STROKE_S
        free = ((level - COULOMB) * stroke_s + 0.5 * rate * stroke_s**2) / inertia
        stroke = direction * free * (1.0 - 3.0 * share**2 + 2.0 * share**3)
        speed += [np.zeros(rest + rise), stroke]
        acceleration = np.gradient(stroke, 1.0 / RATE_HZ)
        moving = inertia * acceleration + VISCOUS * stroke + COULOMB * direction
        torque += [np.zeros(rest), direction * rate * np.arange(rise) / RATE_HZ, moving]
        made.append(Ramp(direction, direction * level, before + rise_s, rate))
    torque.append(np.zeros(int(0.5 * RATE_HZ)))
    speed.append(np.zeros(int(0.5 * RATE_HZ)))
    effort, velocity = np.concatenate(torque), np.concatenate(speed)
    return _recording(name, velocity, effort + noise * random.standard_normal(len(effort)), load_kg), made


def swing(name: str, hz: float, random: np.random.Generator, load_kg: float = 0.0) -> Recording:
    """A sine."""
    time_s = np.arange(0.0, 8.0, 1.0 / RATE_HZ)
    velocity = 1.5 * np.cos(2.0 * np.pi * hz * time_s)
    effort = (
        INERTIA * (1.0 + load_kg) * np.gradient(velocity, time_s) + VISCOUS * velocity + COULOMB * np.sign(velocity)
    )
    return _recording(name, velocity, effort + 5e-4 * random.standard_normal(len(effort)), load_kg)


def ramp_recordings(
    static: Static = constant,
    dwells_s: Sequence[float] = (0.3, 1.5, 6.0),
    rates: Sequence[float] = (0.05, 0.15, 0.5),
    seed: int = 1,
    load_kg: float = 0.0,
) -> list[Recording]:
    """Swings, and ramps through rests and rates, under a load that does nothing but to be accelerated."""
    random = np.random.default_rng(seed)
    made = [swing(f"swing-{hz}", hz, random, load_kg) for hz in (0.15, 0.3, 0.5, 0.7)]
    for repeat, dwell_s, rate in product(range(REPEATS), dwells_s, rates):
        scatter = 1.0 + 0.01 * random.standard_normal()
        name = f"ramp-{load_kg}-{dwell_s}-{rate}-{repeat}"
        one = ramp_trial(name, dwell_s, rate, lambda t, r, s=scatter: s * static(t, r), random, load_kg=load_kg)
        made.append(one[0])
    return made


def ramp_fit(
    static: Static = constant,
    dwells_s: Sequence[float] = (0.3, 1.5, 6.0),
    rates: Sequence[float] = (0.05, 0.15, 0.5),
    seed: int = 1,
) -> Fit:
    """A model of sliding, fitted to swings and ramps."""
    made = ramp_recordings(static, dwells_s, rates, seed)
    return fit_model(make_dataset(made, HORIZONTAL, Processing(cutoff_hz=12.0)), MODEL)


def _recording(name: str, velocity: np.ndarray, effort: np.ndarray, load_kg: float) -> Recording:
    """One trial; each kilogram of load adds once more the inertia of the arm."""
    time_s = np.arange(len(velocity)) / RATE_HZ
    position = COUNT_RAD * np.round(np.cumsum(velocity) / RATE_HZ / COUNT_RAD)
    conditions = {"load_kg": load_kg, "arm_m": INERTIA**0.5}
    return Recording(name, "ramps", conditions, {"time_s": time_s, "position_rad": position, "torque_n_m": effort})
