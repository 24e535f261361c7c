"""Which effort a study predicts: torque, force, current or terminal voltage, as its recordings measure it."""

from collections.abc import Callable, Sequence

import numpy as np

from compensator.lab.errors import UnusableDataError
from compensator.lab.recordings.facts import Effort, EffortQuantity, Facts
from compensator.lab.recordings.recording import Recording


def _torque(_: Facts) -> Effort:
    return Effort("torque", "joint torque", "N m", ("torque_n_m",))


def _force(_: Facts) -> Effort:
    return Effort("force", "force", "N", ("force_n",))


def _current(channel: str, quantity: EffortQuantity, title: str) -> Callable[[Facts], Effort]:
    def make(facts: Facts) -> Effort:
        if facts.torque_per_current_n_m_a is None:
            return Effort(quantity, title, "A", (channel,))
        return Effort(quantity, f"joint torque from {title}", "N m", (channel,), facts.torque_per_current_n_m_a)

    return make


def _terminal_voltage(_: Facts) -> Effort:
    return Effort("terminal_voltage", "terminal voltage", "V", ("voltage_v",))


def _duty_times_supply(_: Facts) -> Effort:
    return Effort("terminal_voltage", "terminal voltage (duty x supply)", "V", ("duty", "supply_v"))


# in order of preference: what is measured closest to the load comes first
_MAKERS: tuple[tuple[EffortQuantity, Callable[[Facts], Effort]], ...] = (
    ("torque", _torque),
    ("force", _force),
    ("current", _current("current_a", "current", "measured current")),
    ("current_estimate", _current("current_estimate_a", "current_estimate", "current from duty and speed")),
    ("terminal_voltage", _duty_times_supply),
    ("terminal_voltage", _terminal_voltage),
)


def choose_effort(recordings: Sequence[Recording], facts: Facts) -> Effort:
    """The effort asked for by the facts, else the best one that every recording measures.

    Raises:
        UnusableDataError: no such quantity in some recording; the message names it and the channels needed.
    """
    wanted = [make(facts) for quantity, make in _MAKERS if facts.effort in (None, quantity)]
    for effort in wanted:
        if all(_measured(recording, effort.channels) for recording in recordings):
            return effort
    needed = " or ".join(" x ".join(effort.channels) for effort in wanted)
    for recording in recordings:
        if not any(_measured(recording, effort.channels) for effort in wanted):
            raise UnusableDataError(
                f"recording '{recording.name}' has no effort channel: found {', '.join(sorted(recording.channels))}; "
                f"wanted {needed}; record one of them or map a column to it"
            )
    raise UnusableDataError(
        f"the {len(recordings)} recordings share no effort channel, though each has one; wanted in all of them "
        f"{needed}; choose trials that measure the same"
    )


def _measured(recording: Recording, channels: tuple[str, ...]) -> bool:
    return all(name in recording.channels and np.isfinite(recording.channels[name]).any() for name in channels)
