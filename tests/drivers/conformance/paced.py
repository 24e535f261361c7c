"""A joint in step with a host that a busy machine keeps waiting: one control period passes with each cycle.

The simulated device waits for the host (`--patience`); here the host's time does, too. Else the reference of a trial
would run on while the joint waits, and the servo would kick it after. For the same reason a cycle waits for its own
answer. Nothing else of driver, wire or loop is touched.
"""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from unittest import mock

from bench.control import station
from bench.control.drive_factory import Equipment
from drivers.contract import Command, Drive, Sample

make_equipment = station.make_equipment
TURN_S = 0.05  # that a device may wait for its turn of the processor


class Paced:
    """A drive whose stamps count cycles.

    Args:
        drive: whose samples these are.
    """

    def __init__(self, drive: Drive) -> None:
        self._drive = drive
        self._period_s = 0.0
        self._cycles = 0
        self._number = 0

    def open(self, period_s: float) -> None:
        self._period_s = period_s
        self._drive.open(period_s)

    def exchange(self, command: Command) -> Sample:
        sample = self._drive.exchange(command)
        while sample.number and sample.number == self._number:  # handed over twice: the drive had no turn to answer
            time.sleep(TURN_S)  # a word of the host lets its time go on: few of them
            sample = self._drive.exchange(command)  # it raises where the drive is silent for too long
        self._cycles += 1
        self._number = sample.number
        return sample._replace(time_s=self._cycles * self._period_s)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._drive, name)


@contextmanager
def paced_drives() -> Iterator[None]:
    """Every drive that is made meanwhile is one of these."""

    def make(*arguments: Any) -> Equipment:
        drive, technician = make_equipment(*arguments)
        return Equipment(Paced(drive), technician)

    with mock.patch.object(station, "make_equipment", make):
        yield
