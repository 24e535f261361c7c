"""The drive contract on an actuator, whatever its protocol."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Generic

from drivers.actuator.session import ActuatorSession, ActuatorT
from drivers.contract import Command, Description, Drive, Mode, Sample, Watchdog
from drivers.errors import DriveConnectionError
from drivers.host_time import CycleTime, Lateness
from drivers.joint import JointScale
from drivers.polled_drive import Identity, PolledDrive

_IN_COUNTS = frozenset({"position_rad", "velocity_rad_s"})


@dataclass(frozen=True, slots=True)
class Family:
    """What is known of a kind of actuator before it is opened.

    Attributes:
        modes: that it has at most; which of them, it says itself.
        watchdog: what the maker calls it; "" where there is none.
        watchdog_s: silence after which it stops by itself [s]; None: it never does.
        longest_call_s: by then every call has returned or raised [s]; opening alone may take longer.
        longest_open_s: as long as that.
    """

    device: str
    vendor: str
    modes: frozenset[Mode]
    watchdog: str
    watchdog_s: float | None
    longest_call_s: float
    longest_open_s: float


class ActuatorDrive(PolledDrive[ActuatorSession[ActuatorT]], Generic[ActuatorT]):
    """One actuator with its joint.

    Args:
        family: what is known of it.
        joint: scales and signs.
        connect: makes the actuator; the power is off then, and its watchdog set.
    """

    def __init__(self, family: Family, joint: JointScale, connect: Callable[[], ActuatorT]) -> None:
        super().__init__(
            family.device,
            family.modes,
            Lateness(family.device, family.watchdog, family.watchdog_s),
            connect=lambda: ActuatorSession(family.device, connect, joint, family.watchdog_s),
            describe=lambda session, cycle: _describe(family, joint, session, cycle),
        )

    def open(self, period_s: float) -> None:
        """Connect, identify, switch off, set the watchdog; it has the modes then that it says that it has."""
        super().open(period_s)
        if self._session is not None:
            self._modes = self._session.actuator.modes

    @property
    def bus(self) -> object | None:
        """The bus that it shares; None while it is not open."""
        return None if self._session is None else self._session.actuator.bus

    def exchange_together(self, commands: Sequence[tuple[Drive, Command]]) -> list[Sample]:
        """Send a command to each of some drives on its bus, in one exchange.

        Raises:
            DriveError: as `exchange`.
        """
        drives = [drive for drive, _ in commands if isinstance(drive, ActuatorDrive)]
        assert len(drives) == len(commands)
        told = [command for _, command in commands]
        sessions = [drive._ready(command) for drive, command in zip(drives, told, strict=True)]
        sent_s = perf_counter()
        samples = _exchange_all(sessions, told)
        for drive in drives:
            drive._lateness.told(sent_s)
        return samples


def _describe(
    family: Family, joint: JointScale, session: ActuatorSession[ActuatorT] | None, cycle: CycleTime | None
) -> Description:
    """Identity and capabilities; what only the actuator knows is empty until it is open."""
    actuator = None if session is None else session.actuator
    identity = Identity(family.vendor, "") if actuator is None else actuator.identity
    notes = () if actuator is None or cycle is None else (*actuator.notes, cycle.note)
    steps = {} if actuator is None else actuator.steps
    return Description(
        device=family.device,
        **identity._asdict(),
        modes=family.modes if actuator is None else actuator.modes,
        measured=frozenset() if actuator is None else actuator.measured,
        resolution={name: step * (joint.count_rad if name in _IN_COUNTS else 1.0) for name, step in steps.items()},
        max_rate_hz=0.0 if cycle is None else 1.0 / cycle.quickest_s,
        watchdog_s=family.watchdog_s,
        longest_call_s=family.longest_call_s,
        longest_open_s=family.longest_open_s,
        watchdog=Watchdog.NONE if family.watchdog_s is None else Watchdog.CONFIGURED,
        notes=tuple(filter(None, notes)),
    )


def _exchange_all(sessions: Sequence[ActuatorSession[ActuatorT]], commands: Sequence[Command]) -> list[Sample]:
    """One cycle of several sessions, whose commands have been found to be allowed.

    Raises:
        DriveConnectionError: one of them does not answer; each is told once to be off.
    """
    demands = [
        (session.actuator, *session.demand(command.mode, command.value))
        for session, command in zip(sessions, commands, strict=True)
    ]
    try:
        readings = sessions[0].actuator.exchange_all(demands)
    except DriveConnectionError:
        for session in sessions:
            session.give_up()
        raise
    return [session.take(reading) for session, reading in zip(sessions, readings, strict=True)]
