"""Recordings whose equation is known: motion as sums of sines, effort from formulas written here, noise, an encoder.

Nothing of the lab's columns or of the simulation is used, so that both sides of a test are independent. Every
quantity is evaluated on the exact motion; only what a bench would measure is disturbed.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import Recording

Array = NDArray[np.float64]
G_M_S2 = 9.80665
TURN_COUNTS = 4096 * 16


@dataclass(frozen=True)
class Truth:
    """What happens in one trial, exactly. Arrays have shape (n,)."""

    time_s: Array
    q: Array
    v: Array
    a: Array
    load_kg: float
    arm_m: float
    temperature_c: Array

    @property
    def weight_n_m(self) -> float:
        return self.load_kg * G_M_S2 * self.arm_m


Law = Callable[[Truth], Array]


@dataclass(frozen=True)
class Joint:
    """A rigid joint under gravity with General Kinetic Friction, SI; `extra` is what a model may be missing."""

    inertia: float = 0.02
    arm_moment: float = 0.25
    offset: float = 0.01
    coulomb: float = 0.08
    viscous: float = 0.03
    static_excess: float = 0.04
    stribeck_speed: float = 0.25
    stribeck_exponent: float = 1.0
    extra: Law | None = None

    def effort(self, x: Truth) -> Array:
        """Joint torque [N m]."""
        falling = np.exp(-((np.abs(x.v) / self.stribeck_speed) ** self.stribeck_exponent))
        torque = (self.inertia + x.load_kg * x.arm_m**2) * x.a + (self.arm_moment + x.weight_n_m) * np.sin(x.q)
        torque += self.offset + self.viscous * x.v + (self.coulomb + self.static_excess * falling) * np.sign(x.v)
        return torque if self.extra is None else torque + self.extra(x)


@dataclass(frozen=True)
class Bench:
    """How a trial is run and measured.

    Attributes:
        noise: standard deviation of the effort's noise; noise_memory: its AR(1) coefficient per sample.
        quantum: of the position; 0 measures it exactly.
        delay_s: by which the position is old.
    """

    rate_hz: float = 200.0
    duration_s: float = 12.0
    noise: float = 0.006
    noise_memory: float = 0.6
    quantum: float = 2.0 * np.pi / TURN_COUNTS
    arm_m: float = 0.3
    delay_s: float = 0.0


@dataclass(frozen=True)
class Plan:
    """One trial: sines (amplitude, frequency [Hz], phase) about a centre, and what is held constant."""

    name: str
    sines: Sequence[tuple[float, float, float]]
    centre: float = 0.0
    load_kg: float = 0.0
    temperature_c: float | None = 25.0
    warming_k: float = 0.0
    conditions: Mapping[str, float | str | bool] = field(default_factory=dict)


def motion(plan: Plan, time_s: Array) -> tuple[Array, Array, Array]:
    """Position, velocity and acceleration, exactly."""
    q, v, a = np.full_like(time_s, plan.centre), np.zeros_like(time_s), np.zeros_like(time_s)
    for amplitude, frequency_hz, phase in plan.sines:
        w = 2.0 * np.pi * frequency_hz
        q += amplitude * np.sin(w * time_s + phase)
        v += amplitude * w * np.cos(w * time_s + phase)
        a -= amplitude * w**2 * np.sin(w * time_s + phase)
    return q, v, a


def truth_of(plan: Plan, bench: Bench, time_s: Array) -> Truth:
    warm = 25.0 if plan.temperature_c is None else plan.temperature_c
    temperature = warm + plan.warming_k * time_s / bench.duration_s
    return Truth(time_s, *motion(plan, time_s), plan.load_kg, bench.arm_m, temperature)


def noise_of(bench: Bench, count: int, random: np.random.Generator) -> Array:
    """AR(1) noise of standard deviation `bench.noise`."""
    white = random.standard_normal(count + 200) * np.sqrt(1.0 - bench.noise_memory**2)
    return bench.noise * lfilter([1.0], [1.0, -bench.noise_memory], white)[200:]


def record(plan: Plan, joint: Joint, bench: Bench, random: np.random.Generator) -> Recording:
    """One trial as it would be measured."""
    time_s = np.arange(0.0, bench.duration_s, 1.0 / bench.rate_hz)
    torque = joint.effort(truth_of(plan, bench, time_s)) + noise_of(bench, len(time_s), random)
    position = motion(plan, time_s - bench.delay_s)[0]
    if bench.quantum > 0.0:
        position = bench.quantum * np.round(position / bench.quantum)
    channels = {"time_s": time_s, "position_rad": position, "torque_n_m": torque}
    if plan.temperature_c is not None:
        channels["temperature_c"] = np.round(truth_of(plan, bench, time_s).temperature_c, 1)
    conditions = {"load_kg": plan.load_kg, "arm_m": bench.arm_m, **plan.conditions}
    return Recording(plan.name, "sines", conditions, channels)


def plans(
    loads_kg: Sequence[float] = (0.0, 0.1, 0.25),
    repeats: int = 1,
    temperatures_c: Sequence[float] = (25.0, 40.0, 32.0, 28.0, 36.0),
    seed: int = 1,
) -> list[Plan]:
    """Slow wide, middling and fast trials with every load; cold and warm trials interleaved."""
    random = np.random.default_rng(seed)
    kinds = (
        ((1.3, 0.10), (0.25, 0.31)),
        ((0.7, 0.30), (0.35, 0.57)),
        ((0.35, 0.70), (0.25, 1.10)),
    )
    made: list[Plan] = []
    for load_kg in loads_kg:
        for style, pairs in enumerate(kinds):
            sines = [(amplitude, hz, float(random.uniform(0, 2 * np.pi))) for amplitude, hz in pairs]
            for repeat in range(1, repeats + 1):
                warm = temperatures_c[len(made) % len(temperatures_c)]
                conditions = {"style": float(style), "repeat": repeat} if repeats > 1 else {"style": float(style)}
                name = f"load-{1000 * load_kg:.0f}g-{style}-{repeat}"
                made.append(Plan(name, sines, 0.15, load_kg, warm, conditions=conditions))
    return made


def recordings(
    joint: Joint | None = None, bench: Bench | None = None, trials: Sequence[Plan] | None = None, seed: int = 0
) -> list[Recording]:
    """A set of trials of one joint."""
    random = np.random.default_rng(seed)
    chosen = plans() if trials is None else trials
    return [record(plan, joint or Joint(), bench or Bench(), random) for plan in chosen]


def at_temperature(trials: Sequence[Plan], temperature_c: float | None) -> list[Plan]:
    return [replace(plan, temperature_c=temperature_c) for plan in trials]


FACTS = Facts(arm_m=0.3)
