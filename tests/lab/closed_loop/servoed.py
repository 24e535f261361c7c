"""A joint under a servo, stepped by itself in small explicit steps: what the lab's simulation is held against."""

from dataclasses import astuple, dataclass

import numpy as np
from numba import njit

from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import FloatArray, Recording

FACTS = Facts(arm_m=0.5)
STEP_S = 1e-4
RATE_HZ = 200


@dataclass(frozen=True)
class Joint:
    """Torque [N m] of a joint's parts, and the servo that holds it."""

    inertia: float = 0.05
    moment: float = 0.6
    coulomb: float = 0.2
    viscous: float = 0.1
    share_of_weight: float = 0.0  # friction in proportion to what the gear carries of the weight
    stiffness: float = 40.0
    integral: float = 0.0
    damping: float = 1.5
    dead_band: float = 0.0
    count_rad: float = 1e-9  # of the encoder, for servo and record alike


def target_of(time_s: FloatArray, seed: int) -> FloatArray:
    """A smooth set point [rad] of a few sines."""
    random = np.random.default_rng(seed)
    amplitudes, rates, phases = random.uniform(0.2, 0.5, 3), random.uniform(1.0, 5.0, 3), random.uniform(0.0, 6.0, 3)
    return 0.3 + np.sum(amplitudes[:, None] * np.sin(rates[:, None] * time_s + phases[:, None]), axis=0)


def run(joint: Joint, seconds: float = 6.0, seed: int = 0) -> dict[str, FloatArray]:
    """Channels of one trial, sampled at RATE_HZ; torque is what the servo gives, less what feed-forward it adds."""
    time_s = np.arange(round(seconds / STEP_S)) * STEP_S
    target = target_of(time_s, seed)
    wanted = np.gradient(target, STEP_S)
    every = round(1.0 / RATE_HZ / STEP_S)
    kept = _stepped(astuple(joint), target, wanted, every)
    return dict(zip(("time_s", "target_rad", "position_rad", "torque_n_m"), kept, strict=True))


# compiled, as each trial has 60 000 steps; with nothing of the lab's or of the simulation's code
@njit(cache=True)
def _stepped(joint: tuple[float, ...], target: FloatArray, wanted: FloatArray, every: int) -> FloatArray:
    inertia, moment, coulomb, viscous, share, stiffness, integral, damping, dead_band, count_rad = joint
    q, v, summed = target[0], wanted[0], 0.0
    kept = np.empty((4, (len(target) + every - 1) // every))
    for index in range(len(target)):
        r = target[index]
        read = count_rad * round(q / count_rad)
        error = r - read if abs(r - read) > dead_band else 0.0
        summed += error * STEP_S
        torque = stiffness * error + integral * summed + damping * (wanted[index] - v)
        if index % every == 0:
            kept[0, index // every], kept[1, index // every] = index * STEP_S, r
            kept[2, index // every], kept[3, index // every] = read, torque
        weight = moment * np.sin(q)
        dry = (coulomb + share * abs(weight)) / inertia * STEP_S
        free = v + STEP_S * (torque - weight - viscous * v) / inertia
        v = np.sign(free) * max(abs(free) - dry, 0.0)
        q += STEP_S * v
    return kept


def recordings(joint: Joint, trials: int = 4) -> list[Recording]:
    """Trials of one joint, each of a set point of its own."""
    return [Recording(f"trial-{seed}", "sines", {}, run(joint, seed=seed)) for seed in range(trials)]
