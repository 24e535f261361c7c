"""Record a joint that another program moves: its motion as a recording, with what the drive reports as the effort."""

from collections.abc import Callable
from math import isfinite, isnan, nan
from pathlib import Path
from time import perf_counter

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.config.drives.registry import drive_kind, drive_kinds
from bench.control.servo import current_servo, torque_constant_n_m_a
from bench.errors import ConfigurationError
from compensator.lab.recordings.recording import Condition, Recording
from drivers.contract import Sample, Status
from drivers.follower import Follower

FEWEST_ROWS = 2
EFFORTS = {"current_a", "current_estimate_a", "duty"}
LEAVES_S = 2.0  # another program that says nothing for as long is gone
_LOOK_S = 0.05  # how soon an end is noticed
Stopped = Callable[[], bool]


def follower_of(configuration: BenchConfiguration, link: Path, period_s: float) -> Follower:
    """What looks at the joint of a bench: standing between it and another program, or listening on their bus.

    Args:
        configuration: of the bench.
        link: name of the port that the other program opens.
        period_s: from one look to the next, at least [s].

    Raises:
        ConfigurationError: that cannot be done with its kind of drive, or its rig leaves out counts or gear.
        DriveError: the port is not there or in use, or nobody answers.
    """
    section = configuration.drive
    kind = drive_kind(section.kind)
    if kind.follow is None:
        able = ", ".join(sorted(name for name, one in drive_kinds().items() if one.follow is not None))
        raise ConfigurationError(
            f"drive.kind is '{section.kind}', which cannot be recorded while another program moves it; {able} can. A "
            "ROS 2 bag of it is read by 'friction-bench import BAG.mcap --joint NAME'"
        )
    return kind.follow(section, configuration.rig, link, period_s)


def record(
    follower: Follower,
    configuration: BenchConfiguration,
    name: str,
    conditions: dict[str, Condition],
    seconds_s: float,
    stopped: Stopped,
) -> Recording:
    """Look until there is enough; the first sample is time 0.

    Args:
        follower: open.
        configuration: of the bench.
        name: of the recording.
        conditions: what is held constant meanwhile.
        seconds_s: how long, from the first sample on [s].
        stopped: asked often; True ends it early.

    Raises:
        DriveConnectionError: the port is gone.
        ConfigurationError: there was nothing to be recorded.
    """
    samples: list[Sample] = []
    while not stopped() and (not samples or samples[-1].time_s - samples[0].time_s < seconds_s):
        sample = follower.look(_LOOK_S)
        if sample is not None:
            samples.append(sample)
    if len(samples) < FEWEST_ROWS:
        raise ConfigurationError(
            f"{follower.device}: {len(samples)} samples were taken, {FEWEST_ROWS} are wanted. Let the other program "
            f"{follower.wanted}"
        )
    return Recording(name, "followed", conditions, _channels(samples, configuration))


def pass_on(follower: Follower, stopped: Stopped) -> None:
    """Go on passing bytes until the other program has left: it may hold a load. On a shared bus nothing is passed.

    Raises:
        DriveConnectionError: the port is gone.
    """
    began_s = perf_counter()
    while follower.is_between and not stopped() and min(follower.silent_s, perf_counter() - began_s) < LEAVES_S:
        follower.look(_LOOK_S)


def _channels(samples: list[Sample], configuration: BenchConfiguration) -> dict[str, np.ndarray]:
    """What was measured; a quantity that never was is left out."""
    servo, constant_n_m_a = current_servo(configuration.rig), torque_constant_n_m_a(configuration.rig)
    if isnan(constant_n_m_a) and any(isfinite(one.torque_n_m) and isnan(one.current_a) for one in samples):
        raise ConfigurationError(
            f"rig '{configuration.rig.name}': a torque is told and no current; motor.torque_constant_n_m_a makes one "
            "of the other. Add it to the rig (1 where all is to be said in N m)"
        )
    rows = {
        "time_s": [one.time_s - samples[0].time_s for one in samples],
        "position_rad": [one.position_rad for one in samples],
        "velocity_rad_s": [one.velocity_rad_s for one in samples],
        "duty": [one.duty for one in samples],
        "current_a": [one.torque_n_m / constant_n_m_a if isnan(one.current_a) else one.current_a for one in samples],
        "current_estimate_a": [nan if servo is None else servo.estimate_a(one, one.velocity_rad_s) for one in samples],
        "supply_v": [one.supply_v for one in samples],
        "temperature_c": [one.temperature_c for one in samples],
        "enabled": [float(one.status is Status.ENABLED) for one in samples],
        "age_s": [one.age_s for one in samples],
    }
    found = {name: np.asarray(values, dtype=float) for name, values in rows.items()}
    return {name: values for name, values in found.items() if np.isfinite(values).any()}
