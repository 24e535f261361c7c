"""What the lab is told about the joint, and of the effort that its models predict.

Everything is optional; what is missing limits what can be named.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from compensator.lab.recordings.recording import FloatArray, Recording

EffortQuantity = Literal["torque", "force", "current", "current_estimate", "terminal_voltage"]

BY_VOLTAGE: tuple[EffortQuantity, ...] = ("terminal_voltage", "current_estimate")  # the back-EMF is in it, or taken off

STANDARD_GRAVITY_M_S2 = 9.80665


@dataclass(frozen=True, slots=True)
class Facts:
    """The joint as its owner knows it.

    Attributes:
        joint: "rotary" (rad, N m) or "linear" (m, N).
        horizontal: gravity does no work on the joint.
        torque_per_current_n_m_a: joint torque per motor ampere, torque constant x gear ratio [N m/A].
        back_emf_v_s_rad: of the motor for each rad/s of the joint, back-EMF constant x gear ratio.
        gear_ratio: motor turns per joint turn.
        backlash_rad: free play at the joint; 0 where there is none, None where nobody measured it.
        stiffness_n_m_rad: torsional, of what drives the arm; None where nobody told.
        arm_m: axis to the tip load [m], where the trial's conditions do not tell.
        arm_inertia_kg_m2: of the arm without load, about the axis.
        arm_moment_n_m: weight of the arm without load, at 90 degrees; None where nobody told.
        supply_is_nominal: whether the supply voltage of the recordings is a number that nobody measured; None where
            the owner does not say, and before the recordings were seen.
        sensor_at_joint: the position sensor turns with the joint, not with the motor.
        position_count: what the position sensor resolves at the joint, in the position's unit; None where nobody told.
        effort: the quantity that the models predict; None takes the best that every trial has.
    """

    joint: Literal["rotary", "linear"] = "rotary"
    horizontal: bool = False
    torque_per_current_n_m_a: float | None = None
    back_emf_v_s_rad: float | None = None
    gear_ratio: float | None = None
    backlash_rad: float | None = None
    stiffness_n_m_rad: float | None = None
    arm_m: float | None = None
    arm_inertia_kg_m2: float | None = None
    arm_moment_n_m: float | None = None
    supply_is_nominal: bool | None = None
    sensor_at_joint: bool = False
    position_count: float | None = None
    effort: EffortQuantity | None = None

    @property
    def sensor_turns(self) -> float | None:
        """Turns of the position sensor for each of the joint; None where nobody told."""
        return 1.0 if self.sensor_at_joint else self.gear_ratio

    @property
    def position_unit(self) -> Literal["rad", "m"]:
        """Unit of position: rad or m."""
        return "rad" if self.joint == "rotary" else "m"


@dataclass(frozen=True, slots=True)
class Effort:
    """The predicted quantity: its name, its unit, and how it is had from a recording.

    Attributes:
        quantity: which one.
        title: in words, for axes.
        unit: of the values.
        channels: that a recording must have.
        factor: applied to the product of the channels.
    """

    quantity: EffortQuantity
    title: str
    unit: str
    channels: tuple[str, ...]
    factor: float = 1.0

    def of(self, recording: Recording) -> FloatArray:
        """The effort over the recording's own time stamps, shape (n,), in `unit`."""
        values = np.full(len(recording), self.factor)
        for name in self.channels:
            values = values * recording.channels[name]
        return values

    def is_measured(self, recording: Recording) -> bool:
        """Whether a recording has all its channels, with a value in some sample."""
        return all(_has_values(recording, name) for name in self.channels)


def lack_of_effort(recording: Recording, wanted: Sequence[Effort]) -> str:
    """What a recording has instead of any of these, and what to do; empty where it measures one of them.

    A channel that is there without a value is told from one that is not: it is no matter of its name.
    """
    if any(effort.is_measured(recording) for effort in wanted):
        return ""
    asked = {name for effort in wanted for name in effort.channels}
    empty = sorted(name for name in asked & set(recording.channels) if not _has_values(recording, name))
    found = ", ".join(sorted(set(recording.channels) - set(empty)))
    also = f", and {', '.join(empty)} with no value in any sample" if empty else ""
    remedy = "map a column that holds values" if empty else "record one of them or map a column to it"
    return (
        f"recording '{recording.name}' has no effort channel: found {found}{also}; wanted {in_words(wanted)}; "
        f"{remedy}, or leave the trial out"
    )


def in_words(wanted: Sequence[Effort]) -> str:
    """The channels of each effort."""
    return " or ".join(" x ".join(effort.channels) for effort in wanted)


def _has_values(recording: Recording, name: str) -> bool:
    return name in recording.channels and bool(np.isfinite(recording.channels[name]).any())
