"""Two hosts and two drives on one bus: is one host refused, or is each drive guarded by its own host alone?"""

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

from drivers.canopen.drive import CanopenDrive
from drivers.contract import Command, Mode
from drivers.errors import DriveError
from sim_backend.devices.canopen.drive import ServoDrive
from tests.devices.device_process import Thread
from tests.drivers.dictionaries.attempt import NODE, OFF, PERIOD_S, WATCHDOG_S, device, host

PUSH = Command(Mode.CURRENT, 0.2)
NODES = (NODE, NODE + 1)
_DEAD_S = WATCHDOG_S + 0.5  # longer than any watchdog here


@dataclass(frozen=True)
class Meeting:
    """What came of it.

    Attributes:
        refused: whether a host was, and what it said.
        guarded: whether the drive whose host fell silent stopped, though the other host went on.
    """

    refused: str = ""
    guarded: bool = False

    @property
    def is_safe(self) -> bool:
        """Refused for the other host, or guarded."""
        return "another host" in self.refused or self.guarded


class Running:
    """A host that moves its drive in a thread, until it is told to end or refused."""

    def __init__(self, drive: CanopenDrive) -> None:
        self.drive = drive
        self.error = ""
        self._is_over = False
        self._thread = Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def end(self) -> None:
        """End, without a word to the drive."""
        self._is_over = True
        self._thread.join()

    def _run(self) -> None:
        try:
            self.drive.enable(Mode.CURRENT)
            while not self._is_over:
                self.drive.exchange(PUSH)
                time.sleep(PERIOD_S)
        except DriveError as error:
            self.error = str(error)


@contextmanager
def both(sheet: Path, channel: str) -> Iterator[tuple[list[CanopenDrive], list[ServoDrive]]]:
    """Two drives with their hosts on one bus; the hosts are not yet open."""
    with ExitStack() as stack:
        devices = [stack.enter_context(device(sheet, node=node, channel=channel)) for node in NODES]
        hosts = [stack.enter_context(host(one, node=node)) for one, node in zip(devices, NODES, strict=True)]
        yield hosts, [one.device for one in devices]


def second_opens_while_first_moves(sheet: Path, channel: str) -> Meeting:
    """The commonest case."""
    with both(sheet, channel) as (hosts, drives):
        hosts[0].open(PERIOD_S)
        first = Running(hosts[0])
        first.start()
        time.sleep(0.1)
        refused = _refusal(lambda: hosts[1].open(PERIOD_S))
        meeting = Meeting(refused or first.error, guarded=False)
        first.end()
        return meeting if meeting.is_safe else _silence(hosts, drives)


def both_open_before_either_moves(sheet: Path, channel: str) -> Meeting:
    """Neither hears the other when it opens."""
    with both(sheet, channel) as (hosts, drives):
        for one in hosts:
            one.open(PERIOD_S)
        return _silence(hosts, drives)


def both_open_at_once(sheet: Path, channel: str) -> Meeting:
    """Two operators, one moment."""
    with both(sheet, channel) as (hosts, drives):
        errors: list[str] = []
        threads = [Thread(target=lambda one=one: errors.append(_refusal(lambda: one.open(PERIOD_S)))) for one in hosts]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        refused = "; ".join(filter(None, errors))
        return Meeting(refused) if refused else _silence(hosts, drives)


def second_looks_on_with_the_power_off(sheet: Path, channel: str) -> Meeting:
    """A second host that only reads samples sends SYNC all the same."""
    with both(sheet, channel) as (hosts, _drives):
        for one in hosts:
            one.open(PERIOD_S)
        first = Running(hosts[0])
        first.start()
        time.sleep(0.1)
        refused = _refusal(lambda: [hosts[1].exchange(OFF) for _ in range(3)])
        time.sleep(0.1)
        first.end()
        return Meeting(refused or first.error)


WAYS = (
    second_opens_while_first_moves,
    both_open_before_either_moves,
    both_open_at_once,
    second_looks_on_with_the_power_off,
)


def _silence(hosts: list[CanopenDrive], drives: list[ServoDrive]) -> Meeting:
    """Both move; the first falls silent while the other goes on. Whether its drive stops."""
    running = [Running(one) for one in hosts]
    for one in running:
        one.start()
        time.sleep(0.1)
    running[0].end()
    time.sleep(_DEAD_S)
    powered = drives[0].axis.power.on
    running[1].end()
    refused = next(filter(None, (one.error for one in running)), "")
    return Meeting(refused, guarded=not powered)


def _open(one: CanopenDrive, errors: list[str]) -> None:
    errors.append(_refusal(lambda: one.open(PERIOD_S)))


def _refusal(call: Callable[[], object]) -> str:
    try:
        call()
    except DriveError as error:
        return str(error)
    return ""
