"""Which effort a study predicts: torque, force, current or terminal voltage, as its recordings measure it."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from compensator.lab.errors import UnusableDataError
from compensator.lab.recordings.facts import Effort, Facts
from compensator.lab.recordings.recording import Recording

# in order of preference: what is measured closest to the load comes first
_EFFORTS = (
    Effort("torque", "joint torque", "N m", ("torque_n_m",)),
    Effort("force", "force", "N", ("force_n",)),
    Effort("current", "measured current", "A", ("current_a",)),
    Effort("current_estimate", "current from duty and speed", "A", ("current_estimate_a",)),
    Effort("terminal_voltage", "terminal voltage (duty x supply)", "V", ("duty", "supply_v")),
    Effort("terminal_voltage", "terminal voltage", "V", ("voltage_v",)),
)

_REMEDY = "record one of them or map a column to it, or leave the trial out"


def choose_effort(recordings: Sequence[Recording], facts: Facts) -> Effort:
    """The effort asked for by the facts, else the best one that every recording measures.

    Raises:
        UnusableDataError: no such quantity in some recording; the message names it and the channels needed.
    """
    wanted = [_known(effort, facts) for effort in _EFFORTS if facts.effort in (None, effort.quantity)]
    for effort in wanted:
        if all(_measured(recording, effort.channels) for recording in recordings):
            return effort
    for recording in recordings:
        check_effort(recording, wanted)
    raise UnusableDataError(
        f"the {len(recordings)} recordings share no effort channel, though each has one; wanted in all of them "
        f"{_in_words(wanted)}; choose trials that measure the same"
    )


def check_effort(recording: Recording, wanted: Sequence[Effort]) -> None:
    """Raise where a recording measures none of these.

    Raises:
        UnusableDataError: so; the message tells a channel that is not there from one that is empty.
    """
    if any(_measured(recording, effort.channels) for effort in wanted):
        return
    asked = {name for effort in wanted for name in effort.channels}
    empty = sorted(name for name in asked & set(recording.channels) if not _measured(recording, (name,)))
    found = ", ".join(sorted(set(recording.channels) - set(empty)))
    also = f", and {', '.join(empty)} with no value in any sample" if empty else ""
    remedy = "leave the trial out, or map a column that holds values" if empty else _REMEDY
    raise UnusableDataError(
        f"recording '{recording.name}' has no effort channel: found {found}{also}; wanted {_in_words(wanted)}; {remedy}"
    )


def _in_words(wanted: Sequence[Effort]) -> str:
    return " or ".join(" x ".join(effort.channels) for effort in wanted)


def _known(effort: Effort, facts: Facts) -> Effort:
    """A current as the torque that it makes, where that is known."""
    per_current = facts.torque_per_current_n_m_a
    if effort.unit != "A" or per_current is None:
        return effort
    return replace(effort, title=f"joint torque from {effort.title}", unit="N m", factor=per_current)


def _measured(recording: Recording, channels: tuple[str, ...]) -> bool:
    return all(name in recording.channels and np.isfinite(recording.channels[name]).any() for name in channels)
