"""Whether what comes in can be a recording of a joint: values within physics, a position, an effort, no wraps.

So is whether the measured effort can carry the loads that trials are said to have: g for kg is asked about. From one
end of a motion to the other the motor's torque changes by what the load's moment changes by, and by friction. Where the
angle zero lies is not always known. The least that a moment m g L can change over a travel is
m g L (1 - cos(travel / 2)): about the level arm.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bench.config.rig import Rig
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.mapping import Mapping
from compensator.lab.errors import UnusableDataError
from compensator.lab.recordings.channel_checks import check_channels
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.facts import STANDARD_GRAVITY_M_S2, Facts
from compensator.lab.recordings.gaps import typical_step_s
from compensator.lab.recordings.recording import CHANNELS, FloatArray, Recording

_IN_TRIALS_CSV = (
    'Say so in a mapping: trials_columns.load_kg with from = "load_kg", scale = 0.001; or confirm it there with '
    "scale = 1"
)
_IN_THE_MAPPING = 'Correct it in [[trials]]; or confirm it beside them: trials_columns.load_kg with from = "load_kg"'
_OF_A_COLUMN = 'Say so in the mapping: conditions.load_kg with unit = "g"; or confirm it there with unit = "kg"'
BY_FAR = 10.0  # a spring that carries nine tenths of the load is not asked about; g for kg makes 1000
FEWEST_ROWS = 20  # fewer are an example, and show nothing of a motion
TWO_TURNS_RAD = 4.0 * np.pi
LARGE_PART = 0.25  # of the range of position: a move that counts as there or back
THERE_AND_BACK = 2  # moves the other way


def load_question(recordings: Sequence[Recording], rig: Rig, mapping: Mapping) -> tuple[str, str]:
    """The trial whose load is asked about, and what is asked; two "" where the loads can be, or nothing tells.

    A mapping that states `trials_columns.load_kg`, or the unit of `conditions.load_kg`, confirms them.
    """
    held = mapping.conditions.get("load_kg")
    confirmed = "load_kg" in mapping.trials_columns or (held is not None and held.unit is not None)
    if rig.horizontal or rig.joint != "rotary" or confirmed:
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
        + (_OF_A_COLUMN if held else _IN_THE_MAPPING if mapping.trials else _IN_TRIALS_CSV)
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


@dataclass(frozen=True, slots=True)
class Plausible:
    """What a channel can be. Attributes: lowest, highest possible value; the unit that it may be in where it is not."""

    low: float
    high: float
    other: str


# far beyond what benches of joints have, and far below what a wrong unit makes of it
PLAUSIBLE: dict[str, Plausible] = {
    "duty": Plausible(-1.05, 1.05, "%"),
    "current_a": Plausible(-1000.0, 1000.0, "mA"),
    "current_command_a": Plausible(-1000.0, 1000.0, "mA"),
    "voltage_v": Plausible(-1500.0, 1500.0, "mV"),
    "supply_v": Plausible(-1.0, 1500.0, "mV"),
    "temperature_c": Plausible(-80.0, 250.0, "K"),
    "torque_n_m": Plausible(-1e5, 1e5, "mN m"),
    "force_n": Plausible(-1e7, 1e7, "mN"),
    "velocity_rad_s": Plausible(-1e4, 1e4, "deg/s"),
    "velocity_m_s": Plausible(-100.0, 100.0, "mm/s"),
    "position_m": Plausible(-100.0, 100.0, "mm"),
}
LOWEST_HZ, HIGHEST_HZ = 4.0, 2e5
MOST_CONDITIONS, LONGEST_CONDITION = 100, 1000  # characters
MOST_EVENTS, MOST_OF_EVENTS = 10_000, 2**20  # characters: whoever looks at a trial is sent all of them
LARGEST = 1e100  # of any channel in any unit; the powers of more are no numbers


def check_recordings(recordings: Sequence[Recording], rig: Rig, mapping: Mapping) -> None:
    """Look at every recording, before any of them is kept.

    A unit that the mapping states is taken as it is, except where the value is impossible in it.

    Raises:
        RecordingSetError: a value outside physics, a load that no effort carries, no position or no effort in any
            trial, a wrap, two units.
    """
    for recording in recordings:
        if problem := _words(recording):
            raise RecordingSetError(f"trial '{recording.name}'", problem)
    judged = [one for one in recordings if len(one) >= FEWEST_ROWS]
    for recording in judged:
        if problem := _endless(recording) or _rate(recording, mapping) or _outside(recording, mapping):
            raise RecordingSetError(f"trial '{recording.name}'", problem)
    if judged:
        facts = Facts(joint=rig.joint, horizontal=rig.horizontal, effort=rig.effort.quantity if rig.effort else None)
        _check_physics(judged, facts)
        trial, asked = load_question(judged, rig, mapping)
        if asked:
            raise RecordingSetError(f"trial '{trial}'", asked)
    for recording in judged:  # a wrap goes to and fro, too, and was looked for before
        if problem := _degrees(recording, mapping):
            raise RecordingSetError(f"trial '{recording.name}'", problem)


def _words(recording: Recording) -> str:
    """Text that is more than anybody reads; "" where it is not."""
    conditions, events = recording.conditions, recording.events
    if len(conditions) > MOST_CONDITIONS:
        return f"has {len(conditions)} conditions; at most {MOST_CONDITIONS} are kept. Leave columns out of trials.csv"
    for name, value in conditions.items():
        if (length := len(name) + len(str(value))) > LONGEST_CONDITION:
            return f"condition '{name[:20]}' has {length} characters; at most {LONGEST_CONDITION} are kept. Shorten it"
    length = sum(len(event.name) + len(event.detail) for event in events)
    if len(events) > MOST_EVENTS or length > MOST_OF_EVENTS:
        allowed = f"at most {MOST_EVENTS} of {MOST_OF_EVENTS} are kept"
        return f"has {len(events)} events of {length} characters; {allowed}. Leave the column 'event' out, or split it"
    return ""


def question(channel: str, largest: float, smallest: float, unit: str) -> str:
    """What is asked about a value outside physics; "" where it is inside."""
    wanted = PLAUSIBLE.get(channel)
    if wanted is None or (wanted.low <= smallest and largest <= wanted.high):
        return ""
    found = largest if largest > wanted.high else smallest
    return (
        f"{channel} reaches {found:.5g} {unit}; possible is {wanted.low:g} .. {wanted.high:g} {unit}. Is the column in "
        f"{wanted.other}"
    )


def back_and_forth(position: FloatArray) -> bool:
    """Whether a joint goes more than two turns, and comes back again and again: few do, but angles in degrees do."""
    known = position[np.isfinite(position)]
    span = float(np.ptp(known)) if len(known) else 0.0
    if span <= TWO_TURNS_RAD:
        return False
    levels = np.unique(np.round(known[:: max(1, len(known) // 2000)] / (LARGE_PART * span)), return_inverse=True)[1]
    turns = np.diff(np.sign(np.diff(levels[np.append(True, np.diff(levels) != 0)])))
    return int(np.count_nonzero(turns)) >= THERE_AND_BACK


def _endless(recording: Recording) -> str:
    for channel, values in recording.channels.items():
        if len(rows := np.flatnonzero(np.abs(values) > LARGEST)):
            found = f"{channel} is {values[rows[0]]:.4g} {CHANNELS[channel].unit} in row {rows[0] + 1}"
            return f"{found}, beyond anything that is measured (-{LARGEST:g} .. {LARGEST:g}); leave such cells empty"
    return ""


def _rate(recording: Recording, mapping: Mapping) -> str:
    rate_hz = 1.0 / typical_step_s(recording.channels["time_s"])
    if LOWEST_HZ <= rate_hz <= HIGHEST_HZ or _is_stated("time_s", mapping):
        return ""
    other = "ms" if rate_hz < LOWEST_HZ else "a clock of another unit"
    return (
        f"time_s has {rate_hz:.3g} samples a second; possible is {LOWEST_HZ:g} .. {HIGHEST_HZ:g}. Is the column in "
        f"{other}? {_how('time_s', 'ms', 's')}"
    )


def _outside(recording: Recording, mapping: Mapping) -> str:
    for channel, values in recording.channels.items():
        known = values[np.isfinite(values)]
        if not len(known) or (channel != "duty" and _is_stated(channel, mapping)):
            continue
        si = CHANNELS[channel].unit
        if asked := question(channel, float(known.max()), float(known.min()), si):
            return f"{asked}? {_how(channel, PLAUSIBLE[channel].other, si)}"
    return ""


def _degrees(recording: Recording, mapping: Mapping) -> str:
    position = recording.channels.get("position_rad")
    if position is None or "velocity_rad_s" in recording.channels or _is_stated("position_rad", mapping):
        return ""
    if not back_and_forth(position):
        return ""
    low, high = float(np.nanmin(position)), float(np.nanmax(position))
    return (
        f"position_rad goes back and forth between {low:.4g} and {high:.4g} rad, which is "
        f"{(high - low) / (2.0 * np.pi):.3g} turns. Is the column in degrees? {_how('position_rad', 'deg', 'rad')}"
    )


def _is_stated(channel: str, mapping: Mapping) -> bool:
    column = mapping.columns.get(channel)
    return column is not None and column.unit is not None


def _how(channel: str, other: str, si: str) -> str:
    return f'Say so in a mapping: columns.{channel} with unit = "{other}"; or confirm it there with unit = "{si}"'


def _check_physics(recordings: Sequence[Recording], facts: Facts) -> None:
    name = f"position_{facts.position_unit}"
    if not any(name in one.channels and np.isfinite(one.channels[name]).any() for one in recordings):
        there = ", ".join(sorted({channel for one in recordings for channel in one.channels}))
        other = "m" if facts.position_unit == "rad" else "rad"
        hint = (
            f'; the set has position_{other}: say joint = "{"linear" if other == "m" else "rotary"}" in the rig'
            if any(f"position_{other}" in one.channels for one in recordings)
            else "; map a column to it, or say position_from_speed = true in a mapping where a speed is measured"
        )
        raise RecordingSetError(
            "the trials", f"no trial has {name}, which a {facts.joint} joint needs; found {there}{hint}"
        )
    refusals: list[UnusableDataError] = []
    try:
        for one in recordings:
            try:
                effort = choose_effort([one], facts)
            except UnusableDataError as error:
                refusals.append(error)
                continue
            check_channels([one], effort, facts)
        if len(refusals) == len(recordings):
            raise refusals[0]
    except UnusableDataError as error:
        raise RecordingSetError("the trials", str(error)) from error
