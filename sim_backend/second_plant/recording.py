"""What is recorded of a joint: true traces seen through its sensors, at stamps as irregular as they come."""

from dataclasses import dataclass, replace
from math import pi

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from sim_backend.second_plant.joint import DrawnJoint, Trial
from sim_backend.second_plant.led import led
from sim_backend.second_plant.physics import Physics
from sim_backend.second_plant.protocol import KINDS, plan_of
from sim_backend.second_plant.simulate import TICK_S, Traces, run

FloatArray = NDArray[np.float64]
FREE_SWING_TETHER_RAD = 3.0


@dataclass(frozen=True)
class SecondRecording:
    """One trial as it is recorded, and what truly was at the same stamps.

    Attributes:
        name, kind: of the trial.
        load_kg, gear_c, session_s: its conditions.
        channels: name with unit -> samples, shape (n,).
        effort: the one that stands for the effort, in N m, A or V, shape (n,).
        truth: without counts, filtered and delayed like the effort, at the stamps of the samples.
    """

    name: str
    kind: str
    load_kg: float
    gear_c: float
    session_s: float
    channels: dict[str, FloatArray]
    effort: FloatArray
    truth: Traces


def record(joint: DrawnJoint, quiet: bool = False, without: frozenset[str] = frozenset()) -> list[SecondRecording]:
    """Every trial of a joint.

    Args:
        joint: drawn.
        quiet: without measurement noise and without scatter from trial to trial.
        without: names of hidden mechanisms that are left out.
    """
    return [
        _recorded(joint, trial, simulated(joint, trial, without)[1], quiet)
        for trial in (_even(joint) if quiet else joint.trials)
    ]


def record_beside(joint: DrawnJoint, plain: DrawnJoint) -> tuple[list[SecondRecording], list[SecondRecording]]:
    """Every trial of a joint, quiet, and what another one would need for the same motion.

    Args:
        joint: drawn.
        plain: the same joint, hiding nothing.
    """
    found = []
    for trial in _even(joint):
        _, traces = simulated(joint, trial)
        needed = led(plain.physics_of(trial), traces.reading_rad)
        found.append((_recorded(joint, trial, traces, True), _recorded(plain, trial, needed, True)))
    return [one for one, _ in found], [other for _, other in found]


def simulated(joint: DrawnJoint, trial: Trial, without: frozenset[str] = frozenset()) -> tuple[Physics, Traces]:
    """The joint of one trial and what truly happens in it."""
    random = np.random.default_rng((trial.seed, 1))
    motion = KINDS[trial.kind](int(trial.seconds / TICK_S), joint.bounds, random)
    physics = joint.physics_of(trial, without)
    others = np.random.default_rng((trial.seed, 2))
    plan = plan_of(motion, others, physics.bias_s, physics.rub_s, float(others.uniform(0.2, 0.8)))
    tether_rad = FREE_SWING_TETHER_RAD if trial.kind == "free_swing" else joint.control.tether_rad
    return physics, run(physics, joint.control._replace(tether_rad=tether_rad), plan)


def _even(joint: DrawnJoint) -> list[Trial]:
    """Its trials without scatter of friction between them."""
    return [replace(trial, friction_factor=1.0) for trial in joint.trials]


def _recorded(joint: DrawnJoint, trial: Trial, traces: Traces, quiet: bool) -> SecondRecording:
    random = np.random.default_rng((trial.seed, 3))
    sensors, times = joint.sensors, np.arange(len(traces.reading_rad), dtype=np.float64) * TICK_S
    stamps = _stamps(joint, float(times[-1]), random)
    # values are as old as the drive's last update
    taken = np.floor(stamps / sensors.hold_s + 1e-9) * sensors.hold_s if sensors.hold_s > 0.0 else stamps
    count_rad = joint.control.count_rad
    position = np.interp(taken, times, traces.reading_rad)
    channels = {"time_s": stamps, "position_rad": np.round(position / count_rad) * count_rad}
    effort = _efforts(joint, traces, times, taken - sensors.skew_s, random, quiet)
    channels |= effort
    if sensors.speed_told:
        channels["velocity_rad_s"] = np.interp(taken, times, _filtered(traces.speed_rad_s, 40.0))
    if sensors.temperature_told:
        channels["temperature_c"] = np.round(np.interp(taken, times, traces.winding_c), 1)
    product = np.prod([values for name, values in effort.items()], axis=0)
    seen_as = taken - sensors.skew_s
    truth = Traces(*(np.interp(seen_as, times, _filtered(values, sensors.filter_hz)) for values in traces))
    return SecondRecording(
        trial.name, trial.kind, trial.load_kg, trial.gear_c, trial.session_s, channels, product, truth
    )


def _stamps(joint: DrawnJoint, last_s: float, random: np.random.Generator) -> FloatArray:
    period_s = 1.0 / joint.sensors.rate_hz
    even = np.arange(0.05, last_s - 0.01, period_s)
    off = joint.sensors.jitter * np.clip(random.standard_normal(len(even)), -3.0, 3.0)
    return even + period_s * off


def _filtered(values: FloatArray, hertz: float) -> FloatArray:
    """First order, from the steady state of the first value on."""
    fade = float(np.exp(-2.0 * pi * hertz * TICK_S))
    filtered: FloatArray = lfilter([1.0 - fade], [1.0, -fade], values - values[0])
    filtered += values[0]
    return filtered


def _efforts(
    joint: DrawnJoint, traces: Traces, times: FloatArray, taken: FloatArray, random: np.random.Generator, quiet: bool
) -> dict[str, FloatArray]:
    """The channels that the effort is the product of."""
    sensors, scales = joint.sensors, joint.scales
    noise = 0.0 if quiet else sensors.noise

    def seen(values: FloatArray, peak: float) -> FloatArray:
        sampled = np.interp(taken, times, _filtered(values, sensors.filter_hz))
        return sampled + noise * peak * random.standard_normal(len(taken))

    supply_v = np.full(len(taken), joint.physics.supply_v)
    if sensors.supply_measured:
        supply_v = np.interp(taken, times, traces.supply_v) + noise * 0.1 * supply_v * random.standard_normal(
            len(taken)
        )
    if sensors.effort == "current":
        return {"current_a": seen(traces.current_a, scales.peak_a)}
    if sensors.effort == "torque":
        peak_n_m = scales.peak_a * scales.torque_per_a
        return {"torque_n_m": joint.told.tolerance * seen(scales.torque_per_a * traces.current_a, peak_n_m)}
    duty = np.clip(traces.duty, -1.0, 1.0)
    if sensors.effort == "duty":
        return {"duty": seen(duty, scales.peak_v / joint.physics.supply_v), "supply_v": supply_v}
    volt = duty * (traces.supply_v if sensors.supply_measured else joint.physics.supply_v)
    estimate = (volt - scales.emf_per_rad_s * _filtered(traces.speed_rad_s, 100.0)) / scales.resistance_ohm
    return {"current_estimate_a": seen(estimate, scales.peak_a)}
