"""Draws joints: the same seed draws the same joint, whatever it hides and however much of it."""

from collections.abc import Sequence

import numpy as np

from sim_backend.second_plant.joint import (
    MECHANISMS,
    DrawnJoint,
    EffortChannel,
    Hidden,
    Level,
    Sensors,
    Told,
    Trial,
    control_drawn,
    physics_drawn,
)
from sim_backend.second_plant.mechanism import Need, Scales
from sim_backend.second_plant.protocol import KINDS, Bounds

STARTS = ("breakaway_ramp", "torque_staircase", "point_to_point")
RATES_HZ = (50.0, 100.0, 125.0, 200.0, 250.0, 500.0, 1000.0)


def draw_joint(
    seed: int, names: Sequence[str] = (), sizes: Sequence[float] = (), level: Level = "textbook"
) -> DrawnJoint:
    """A joint that hides the named mechanisms.

    Args:
        seed: of everything that is drawn.
        names: of `MECHANISMS`; none makes a complete joint.
        sizes: one for each name; 1 is a large one.
        level: of its friction laws.

    Raises:
        ValueError: an unknown name, or another number of sizes.
    """
    unknown = [name for name in names if name not in MECHANISMS]
    if unknown or len(names) != len(sizes):
        raise ValueError(f"mechanisms {', '.join(names)} of {len(sizes)} sizes; known are {', '.join(MECHANISMS)}")
    streams = [np.random.default_rng(one) for one in np.random.SeedSequence(seed).spawn(5)]
    needs = {need for name in names for need in MECHANISMS[name].needs}
    physics, scales, arm = physics_drawn(streams[0], level)
    sensors = sensors_drawn(streams[1], needs)
    control = control_drawn(streams[2], physics, scales, sensors)
    heaviest_kg_m2 = physics.rotor_kg_m2 + physics.arm_kg_m2 + scales.heaviest_kg * arm.length_m**2
    bounds = Bounds(
        float(streams[2].uniform(0.8, 1.3)),
        scales.top_rad_s,
        0.3 * scales.peak_a * scales.torque_per_a / heaviest_kg_m2,
        scales.moment_n_m / scales.torque_per_a,
        physics.static_n_m / scales.torque_per_a,
    )
    hidden = tuple(Hidden(name, size, int(streams[3].integers(2**31))) for name, size in zip(names, sizes, strict=True))
    told, trials = told_drawn(streams[4], needs), trials_drawn(streams[4], scales, needs, level)
    return DrawnJoint(seed, level, physics, scales, control, sensors, arm, told, trials, bounds, hidden)


def sensors_drawn(random: np.random.Generator, needs: set[Need]) -> Sensors:
    """How a joint is recorded; with what its mechanism needs to be there at all."""
    channels: tuple[EffortChannel, ...] = ("current", "torque", "duty", "estimate")
    effort = channels[int(random.choice(4, p=[0.45, 0.2, 0.2, 0.15]))]
    if "estimate" in needs:
        effort = "estimate"
    elif "current" in needs and effort not in ("current", "torque"):
        effort = "current"
    elif "voltage" in needs and effort not in ("duty", "estimate"):
        effort = "duty" if random.random() < 0.5 else "estimate"
    rate_hz = float(random.choice(RATES_HZ, p=[0.12, 0.22, 0.18, 0.22, 0.16, 0.08, 0.02]))
    return Sensors(
        effort=effort,
        supply_measured="nominal" not in needs and bool(random.random() < 0.5),
        rate_hz=rate_hz,
        jitter=float(random.choice([0.0, 0.02, 0.1])),
        hold_s=float(random.choice([0.0, 5e-4, 1e-3])),
        skew_s=float(random.uniform(-1e-3, 4e-3)),
        filter_hz=float(np.exp(random.uniform(np.log(50.0), np.log(400.0)))),
        noise=float(np.exp(random.uniform(np.log(0.001), np.log(0.01)))),
        counts_per_turn=float(random.choice([1000, 2000, 4096, 16384])),
        speed_told=bool(random.random() < 0.3),
        temperature_told="temperature" in needs or bool(random.random() < 0.5),
        session_told="session" in needs or bool(random.random() < 0.7),
    )


def told_drawn(random: np.random.Generator, needs: set[Need]) -> Told:
    """Which facts the owner knows."""
    nominal = "nominal" in needs
    shares = (0.8, 0.8, 0.8, 0.7, 0.5, 0.5, 0.7)
    ratio, counts, constant, length, inertia, mass, known = (bool(random.random() < share) for share in shares)
    tolerance = float(random.normal(1.0, 0.03))
    return Told(ratio, counts, constant, length, inertia, mass, nominal and known, tolerance)


def trials_drawn(random: np.random.Generator, scales: Scales, needs: set[Need], level: Level) -> tuple[Trial, ...]:
    """Kinds in turn from a shuffled list, loads, temperatures and the time between trials drawn."""
    count, levels = int(random.integers(16, 27)), int(random.integers(2, 5))
    loads_kg = np.linspace(0.0, scales.heaviest_kg, levels)
    kinds = [str(kind) for _ in range(4) for kind in random.permutation(list(KINDS))][:count]
    if "starts" in needs:
        kinds[::2] = [STARTS[at % len(STARTS)] for at in range(len(kinds[::2]))]
    pause_s, spread_k = float(random.uniform(20.0, 120.0)), float(random.uniform(1.0, 3.0))
    if "temperature" in needs:
        spread_k = float(random.uniform(5.0, 9.0))
    # friction that differs from trial to trial is beyond the base model, and to say so is right
    scatter = float(random.uniform(0.0, 0.03)) if level == "foreign" else 0.0
    session_s, trials = 0.0, []
    for number, kind in enumerate(kinds):
        seconds = round(float(random.uniform(6.0, 9.0)), 1)
        warm = 22.0 + 8.0 * (1.0 - np.exp(-session_s / 900.0)) + spread_k * float(random.standard_normal())
        factor = 1.0 + scatter * float(random.standard_normal())
        load_kg = round(float(random.choice(loads_kg)), 3)
        seed = int(random.integers(2**31))
        trials.append(Trial(f"t{number:02d}", kind, load_kg, seconds, float(warm), session_s, factor, seed))
        session_s += seconds + pause_s * float(random.uniform(0.5, 1.5))
    return tuple(trials)
