"""The drive's own watchdog: how it notices that its host is silent, and what it does then.

Whichever of these the drive has, in this order: heartbeat consumer (0x1016), life guarding (0x100C, 0x100D), the event
timer of an RPDO (0x140n:05); with a reaction that it lets be set (0x6007), before one that it keeps for itself. As a
last resort one that the person at the drive has set, where the configuration says so. A reaction that the drive does
not tell is tried before the first motion (`guard_trial`).
"""

from dataclasses import dataclass
from enum import Enum
from typing import Final

from drivers.canopen.cia301.heartbeat import NmtState
from drivers.canopen.cia301.link import CanLink
from drivers.canopen.cia301.object_table import Need, ObjectTable
from drivers.canopen.cia301.objects import (
    BEHAVIOUR_ON_COMMUNICATION_ERROR,
    CONNECTION_LOSS_OPTION,
    CONSUMER_HEARTBEAT,
    GUARD_TIME,
    LIFE_TIME_FACTOR,
    PRODUCER_HEARTBEAT,
    DataType,
    DriveObject,
)
from drivers.canopen.cia301.pdo import communication
from drivers.canopen.settings import CanopenSettings
from drivers.errors import DriveConfigurationError, DriveError, WatchdogError

_QUICK_STOP, _DISABLE, _FAULT = 3, 2, 1  # 0x6007
_STAY_OPERATIONAL: Final = 1  # 0x1029:01: keep sending TPDOs, so that the fault is heard of
_LIFE_FACTOR: Final = 4
_SIGNS: Final = 4  # of life that the host gives while the drive waits for one
_PURPOSE: Final = "watchdog: stops when the host is silent"


class Kind(Enum):
    """How the drive notices."""

    HEARTBEAT = "heartbeat consumer 0x1016"
    LIFE = "life guarding 0x100C, 0x100D"
    RPDO = "event timer of the RPDO in use"
    IN_DRIVE = "set in the drive, by the configuration"


@dataclass(frozen=True, slots=True)
class Reaction:
    """What the drive does then.

    Attributes:
        told: whether the drive's dictionary says it.
    """

    told: bool
    words: str


class Guard:
    """The watchdog of one drive. It watches only while the power is to be on: with the power off nobody has to call.

    Attributes:
        tried: whether it has been seen to stop the drive since opening.
    """

    def __init__(
        self, table: ObjectTable, link: CanLink, settings: CanopenSettings, host_id: int, quick_stop_ends: bool
    ) -> None:
        self._table = table
        self._link = link
        self._settings = settings
        self._host_id = host_id
        self._quick_stop_ends = quick_stop_ends
        self.kind = Kind.IN_DRIVE
        self._reaction = Reaction(False, "")
        self._timers: tuple[DriveObject, ...] = ()
        self._sign_s = float("-inf")
        self.armed = False
        self.tried = False

    @property
    def is_told(self) -> bool:
        """Whether the drive's own dictionary says that it stops; else it has to be tried."""
        return self._reaction.told and self.kind is not Kind.IN_DRIVE

    @property
    def words(self) -> str:
        """What it is, for a person."""
        return f"{self.kind.value}, {self._settings.watchdog_s:g} s; then {self._reaction.words}"

    def prepare(self) -> None:
        """Choose how the drive is to watch, set what it does then, and try each object: on, read back, off again.

        Raises:
            WatchdogError: it has nothing of the kind, or the objects cannot be set; with each reason.
        """
        self._reaction = self._prepare_reaction()
        self._table.try_set(BEHAVIOUR_ON_COMMUNICATION_ERROR, _STAY_OPERATIONAL, "the fault is still told by PDO")
        refusals = []
        for kind in (Kind.HEARTBEAT, Kind.LIFE, Kind.RPDO):
            why = self._try(kind)
            if not why:
                break
            refusals.append(f"{kind.value}: {why}")
        else:
            self._accept_own(refusals)
        self._table.note(self.kind.value, Need.REQUIRED, _PURPOSE, True, f"then {self._reaction.words}")

    def watch_demands(self, numbers: tuple[int, ...]) -> None:
        """Tell which RPDOs carry demands: their event timers watch, where nothing else does."""
        if self.kind is Kind.RPDO:
            self._timers = tuple(_timer(number) for number in numbers)

    def arm(self) -> None:
        """From the next sign of the host on, the drive counts.

        Raises:
            WatchdogError: it does not.
        """
        self.armed = True  # even where reading back fails: it may have been set
        try:
            for item, value in self._watching():
                self._table.set(item, value, _PURPOSE)
        except DriveConfigurationError as error:
            raise WatchdogError(self._settings.device, f"the watchdog cannot be set: {error}") from error
        self.hurry()

    def disarm(self) -> None:
        """The drive no longer counts. Only with the power off."""
        for item, _ in reversed(self._watching()):
            self._table.set(item, 0, _PURPOSE)
            self._table.note(item, Need.REQUIRED, _PURPOSE, True, self._off_words)
        self.armed = False

    def sign(self, now_s: float) -> None:
        """Give a sign of life if one is due. The control loop alone does: one that hangs is silent."""
        if now_s - self._sign_s < self._settings.watchdog_s / _SIGNS:
            return
        self._sign_s = now_s
        if self.kind is Kind.HEARTBEAT:
            self._link.send_message(0x700 + self._host_id, bytes([NmtState.OPERATIONAL]))
        elif self.kind is Kind.LIFE and self.armed:
            self._link.send_message(0x700 + self._settings.node_id, b"", remote=True)

    def hurry(self) -> None:
        """The next sign is due at once: a drive counts only from the first after it was told to."""
        self._sign_s = float("-inf")

    @property
    def silences_heartbeat(self) -> bool:
        """Whether the drive answers requests instead of sending heartbeats of its own."""
        return self.kind is Kind.LIFE

    @property
    def _off_words(self) -> str:
        """What an object is set to while nothing watches: a bare 0 would read as a watchdog that is off for good."""
        return f"0 while the power is off; watches for {1000 * self._settings.watchdog_s:g} ms from switching on"

    def _watching(self) -> list[tuple[DriveObject, int]]:
        """The objects that make it watch, and their values."""
        time_ms = round(self._settings.watchdog_s * 1000)
        match self.kind:
            case Kind.HEARTBEAT:
                return [(CONSUMER_HEARTBEAT, self._host_id << 16 | time_ms)]
            case Kind.LIFE:
                return [(GUARD_TIME, max(time_ms // _LIFE_FACTOR, 1)), (LIFE_TIME_FACTOR, _LIFE_FACTOR)]
            case Kind.RPDO:
                return [(timer, time_ms) for timer in self._timers]
            case Kind.IN_DRIVE:
                return []

    def _try(self, kind: Kind) -> str:
        """Switch a kind on and off again; return why it cannot be used, "" where it can."""
        if kind is Kind.LIFE and not self._settings.bus.sends_remote_frames:
            return f"python-can sends no remote frames over {self._settings.bus.interface}"
        self.kind, self._timers = kind, (_timer(1),)
        try:
            if kind is Kind.LIFE:  # a node that sends heartbeats does not guard
                self._table.try_set(PRODUCER_HEARTBEAT, 0, "the drive is asked instead")
            self.arm()
            self.disarm()
        except DriveError as error:
            self.armed = False
            why = (error.__cause__ if isinstance(error.__cause__, DriveError) else error).message
            for item, _ in self._watching():  # none of them is required: whichever kind will do is
                self._table.note(item, Need.WISHED, _PURPOSE, False, why)
            return why
        return ""

    def _accept_own(self, refusals: list[str]) -> None:
        if not self._settings.watchdog_is_set_in_drive:
            raise WatchdogError(
                self._settings.device,
                f"it has no watchdog that can be set: {'; '.join(refusals)}. Without one it must not move: it would go "
                "on when this host dies. Where the drive's own tool has set one, say watchdog_is_set_in_drive = true; "
                "it is tried before the first motion",
            )
        self.kind = Kind.IN_DRIVE
        self._reaction = Reaction(False, "whatever was set with the drive's own tool")

    def _prepare_reaction(self) -> Reaction:
        if self._table.ask(CONNECTION_LOSS_OPTION, _PURPOSE) is None:
            return Reaction(False, f"what it does by itself, for it has no {CONNECTION_LOSS_OPTION}")
        codes = (_QUICK_STOP, _DISABLE, _FAULT) if self._quick_stop_ends else (_DISABLE, _FAULT)
        words = {_QUICK_STOP: "quick stop", _DISABLE: "power off", _FAULT: "fault"}
        for code in codes:
            if self._table.try_set(CONNECTION_LOSS_OPTION, code, _PURPOSE):
                return Reaction(True, f"{words[code]} (0x6007 = {code})")
        raise WatchdogError(
            self._settings.device,
            f"the watchdog cannot be set: {CONNECTION_LOSS_OPTION} takes none of quick stop (3), power off (2), fault "
            f"(1): {self._table.outcome(CONNECTION_LOSS_OPTION, _PURPOSE)}. Without it the drive must not move",
        )


def heartbeat_ms(settings: CanopenSettings) -> int:
    """How often the drive sends its own heartbeat [ms]."""
    return max(round(settings.watchdog_s * 1000) // 2, 1)


def _timer(number: int) -> DriveObject:
    """Event timer of an RPDO."""
    return communication(number, False, 5, DataType.U16, "event timer")
