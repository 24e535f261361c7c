"""Profile torque (4): the drive approaches the target torque at a slope."""

from sim_backend.devices.axis import TICK_S
from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.modes.mode import HALT, TARGET_REACHED, Mode, Seen


class ProfileTorque(Mode):
    """Target torque (0x6071) at the torque slope (0x6087, permille/s); halt takes it to zero."""

    def __init__(self, dictionary: Dictionary) -> None:
        self._dictionary = dictionary
        self._now = 0.0
        self._reached = False

    def start(self, seen: Seen) -> None:  # noqa: ARG002
        """Begin without torque."""
        self._now = 0.0

    def torque(self, seen: Seen) -> float:  # noqa: ARG002
        """Return the torque [permille]."""
        halted = self._dictionary.number(0x6040) & HALT
        target = 0 if halted else self._dictionary.number(0x6071)
        step = self._dictionary.number(0x6087) * TICK_S
        self._now += max(-step, min(step, target - self._now))
        self._reached = self._now == target
        return self._now

    def status(self) -> int:
        """Whether the target is reached."""
        return TARGET_REACHED if self._reached else 0
