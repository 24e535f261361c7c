"""Which effort a study predicts: torque, force, current or terminal voltage, as its recordings measure it."""

from collections.abc import Sequence
from dataclasses import replace

from compensator.lab.errors import UnusableDataError
from compensator.lab.recordings.facts import Effort, Facts, in_words, lack_of_effort
from compensator.lab.recordings.recording import Recording

# in order of preference: what is measured closest to the load comes first
EFFORTS = (
    Effort("torque", "joint torque", "N m", ("torque_n_m",)),
    Effort("force", "force", "N", ("force_n",)),
    Effort("current", "measured current", "A", ("current_a",)),
    Effort("current_estimate", "current from duty and speed", "A", ("current_estimate_a",)),
    Effort("terminal_voltage", "terminal voltage (duty x supply)", "V", ("duty", "supply_v")),
    Effort("terminal_voltage", "terminal voltage", "V", ("voltage_v",)),
)


def choose_effort(recordings: Sequence[Recording], facts: Facts) -> Effort:
    """The effort asked for by the facts, else the best one that every recording measures.

    Raises:
        UnusableDataError: no such quantity in some recording; the message names it and the channels needed.
    """
    wanted = [_known(effort, facts) for effort in EFFORTS if facts.effort in (None, effort.quantity)]
    for effort in wanted:
        if all(effort.is_measured(recording) for recording in recordings):
            return effort
    for recording in recordings:
        if lack := lack_of_effort(recording, wanted):
            raise UnusableDataError(lack)
    raise UnusableDataError(
        f"the {len(recordings)} recordings share no effort channel, though each has one; wanted in all of them "
        f"{in_words(wanted)}; choose trials that measure the same"
    )


def in_rig(wanted: Sequence[Effort]) -> str:
    """The channels of efforts, and how a rig asks for one of them."""
    named = " or ".join(dict.fromkeys(f'"{effort.quantity}"' for effort in wanted))
    return f"{in_words(wanted)}; if every trial has that, put quantity = {named} under [effort] into rig.toml"


def _known(effort: Effort, facts: Facts) -> Effort:
    """A current as the torque that it makes, where that is known."""
    per_current = facts.torque_per_current_n_m_a
    if effort.unit != "A" or per_current is None:
        return effort
    return replace(effort, title=f"joint torque from {effort.title}", unit="N m", factor=per_current)
