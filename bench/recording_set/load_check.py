"""Whether the measured effort can carry the loads that trials are said to have: g for kg is asked about.

From one end of a motion to the other the motor's torque changes by what the load's moment changes by, and by friction.
Where the angle zero lies is not always known. The least that a moment m g L can change over a travel is
m g L (1 - cos(travel / 2)): about the level arm.
"""

from collections.abc import Sequence

import numpy as np

from bench.config.rig import Rig
from bench.recording_set.mapping import Mapping
from compensator.lab.recordings.facts import STANDARD_GRAVITY_M_S2
from compensator.lab.recordings.recording import Recording

_IN_TRIALS_CSV = (
    'Say so in a mapping: trials_columns.load_kg with from = "load_kg", scale = 0.001; or confirm it there with '
    "scale = 1"
)
_IN_THE_MAPPING = 'Correct it in [[trials]]; or confirm it beside them: trials_columns.load_kg with from = "load_kg"'
BY_FAR = 10.0  # a spring that carries nine tenths of the load is not asked about; g for kg makes 1000


def load_question(recordings: Sequence[Recording], rig: Rig, mapping: Mapping) -> tuple[str, str]:
    """The trial whose load is asked about, and what is asked; two "" where the loads can be, or nothing tells.

    A mapping that states `trials_columns.load_kg` confirms them.
    """
    if rig.horizontal or rig.joint != "rotary" or "load_kg" in mapping.trials_columns:
        return "", ""
    changes = [(_least_change_n_m(one, rig), one) for one in recordings]
    change_n_m, heaviest = max(changes, key=lambda change: change[0])
    torques_n_m = [_largest_torque_n_m(one, rig) for one in recordings]
    highest_n_m = max((torque for torque in torques_n_m if torque is not None), default=0.0)
    # a motor may push to both sides: its torque changes by twice the largest
    if any(torque is None for torque in torques_n_m) or not change_n_m > BY_FAR * 2.0 * highest_n_m > 0.0:
        return "", ""
    return heaviest.name, (
        f"load_kg is {heaviest.conditions['load_kg']:g} kg: over this motion its moment changes by at least "
        f"{change_n_m:.3g} N m, and no trial has more than {highest_n_m:.3g} N m at the joint. Is it in g? "
        + (_IN_THE_MAPPING if mapping.trials else _IN_TRIALS_CSV)
    )


def _least_change_n_m(recording: Recording, rig: Rig) -> float:
    """What the load's moment changes by over the motion, at least [N m]; 0 where load, arm or angle are not told."""
    load_kg, arm_m = recording.conditions.get("load_kg"), recording.conditions.get("arm_m", rig.arm.length_m)
    position_rad = recording.channels.get("position_rad", np.empty(0))
    known = position_rad[np.isfinite(position_rad)]
    if not isinstance(load_kg, float | int) or not isinstance(arm_m, float | int) or not len(known):
        return 0.0
    if recording.conditions.get("balanced"):
        return 0.0
    travel_rad = min(float(np.ptp(known)), 2.0 * np.pi)
    return load_kg * STANDARD_GRAVITY_M_S2 * arm_m * (1.0 - float(np.cos(0.5 * travel_rad)))


def _largest_torque_n_m(recording: Recording, rig: Rig) -> float | None:
    """The most that the motor gave, at the joint [N m]; None where nothing tells."""
    constant, ratio, resistance_ohm = rig.motor.torque_constant_n_m_a, rig.gear.ratio, rig.motor.resistance_ohm
    if (torque_n_m := _largest(recording, "torque_n_m")) is not None:
        return torque_n_m
    if constant is None or ratio is None:
        return None
    for channel in ("current_a", "current_estimate_a"):
        if (current_a := _largest(recording, channel)) is not None:
            return constant * ratio * current_a
    voltage_v = _largest(recording, "duty", "supply_v") or _largest(recording, "voltage_v")
    if voltage_v is None or resistance_ohm is None:
        return None
    return constant * ratio * 2.0 * voltage_v / resistance_ohm  # while it brakes, the back-EMF adds as much again


def _largest(recording: Recording, *channels: str) -> float | None:
    """The largest size of a product of channels; None where one is not measured."""
    if not all(channel in recording.channels for channel in channels):
        return None
    sizes = np.abs(np.prod([recording.channels[channel] for channel in channels], axis=0))
    known = sizes[np.isfinite(sizes)]
    return float(known.max()) if len(known) else None
