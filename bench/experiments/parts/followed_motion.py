"""A motion with the load estimated all along: what the sinusoid and the steady speeds have in common."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import isnan

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.config.reflected_load import load_current_a, per_kg_a, torque_n_m_a
from bench.control.cycle import Reading
from bench.experiments.parts.joint import Joint, Part
from bench.experiments.parts.load_follower import LoadFollower
from bench.experiments.parts.profile import SetPoint
from bench.json_types import Value
from compensator.motion.load_estimator import LoadEstimate


@dataclass(frozen=True, slots=True)
class Followed:
    """One cycle of motion."""

    reading: Reading
    estimate: LoadEstimate


class FollowedJoint:
    """A joint whose load is estimated in every cycle.

    Args:
        configuration: of the bench; with friction curves.
    """

    def __init__(self, configuration: BenchConfiguration) -> None:
        self._configuration = configuration
        self._joint = Joint(configuration)
        self._follower = LoadFollower(configuration)

    def begin(self) -> Part[str]:
        """See `LoadFollower`."""
        return (yield from self._follower.begin(self._joint))

    def follow(self, set_points: Iterable[SetPoint]) -> Part[list[Followed]]:
        """Track one set point per cycle, estimate the load, and record it."""
        followed = []
        for point in set_points:
            given = self._follower.estimate
            reading = yield from self._joint.step(*point, given.load_current_a, given.half_width_a)
            followed.append(Followed(reading, self._follower.observe(reading, point.position_rad)))
        return followed

    def end(self) -> Part[None]:
        """Back to angle 0, where the joint may be left without power."""
        yield from self._joint.rest_at(0.0)


def errors(followed: Sequence[Followed], load_kg: float, configuration: BenchConfiguration) -> dict[str, Value]:
    """How far the current, and the estimate, are from the load that hangs there; in load at 90 degrees.

    Returns:
        mean_error_kg, mean_absolute_error_kg, rms_error_kg: of the estimate; and the same of the plain current, with
        `uncompensated_` before.
        in_band: share of the cycles in which the 95 % band holds the load.
        estimates: cycles with an estimate.
    """
    rig = configuration.rig
    rows = [
        (
            one.estimate.load_current_a,
            one.reading.current_a,
            load_current_a(load_kg, one.reading.sample.position_rad, rig),
            one.estimate.half_width_a,
        )
        for one in followed
        if not isnan(one.estimate.load_current_a)
    ]
    if not rows:
        return {"estimates": 0}
    given, plain, truth, half = np.array(rows).T
    per_kg = per_kg_a(rig)
    found: dict[str, Value] = {"estimates": len(rows), "in_band": float(np.mean(np.abs(given - truth) <= half))}
    for prefix, error_kg in (("", (given - truth) / per_kg), ("uncompensated_", (plain - truth) / per_kg)):
        found |= {
            f"{prefix}mean_error_kg": float(np.mean(error_kg)),
            f"{prefix}mean_absolute_error_kg": float(np.mean(np.abs(error_kg))),
            f"{prefix}rms_error_kg": float(np.sqrt(np.mean(error_kg**2))),
        }
    return found


def _error_results() -> dict[str, str]:
    sizes = {"mean": "mean", "mean_absolute": "mean absolute", "rms": "root mean square"}
    of = {"": "of the estimate", "uncompensated_": "of the plain current, taken for that of the load"}
    return {
        f"{prefix}{name}_error_kg": f"{size} error {what}"
        for prefix, what in of.items()
        for name, size in sizes.items()
    }


ERROR_RESULTS = {
    "estimates": "cycles with an estimate",
    "in_band": "share of the cycles in which the 95 % band holds the load",
    **_error_results(),
    "search_failure": "why the load was not found at the beginning; empty where it was",
}
"""What the results of a trial are that estimates the load in motion."""


def refuse_unknown_joint(configuration: BenchConfiguration) -> None:
    """Raise `ConfigurationError` where the load cannot be estimated in motion."""
    torque_n_m_a(configuration.rig)
    LoadFollower(configuration)
