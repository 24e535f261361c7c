"""Answers that `tests.fuzz.wires` has found to end a driver with something that is no error of the drive."""

from types import SimpleNamespace
from typing import Any
from unittest import mock

import pytest

from drivers.canopen.cia301.object_access import ObjectAccess
from drivers.damiao.drive import DamiaoActuator
from drivers.errors import DriveConfigurationError, DriveConnectionError
from drivers.feetech.frames import SCS, packet
from drivers.servos.bus import ServoBus
from drivers.servos.frames import Item


class Answering:
    """A serial port that has one answer for all."""

    def __init__(self, answer: bytes) -> None:
        self._answer, self._waiting, self.in_waiting = answer, b"", 0

    def write(self, _question: bytes) -> None:
        self._waiting = self._answer

    def read(self, count: int = 1) -> bytes:
        taken, self._waiting = self._waiting[:count], self._waiting[count:]
        return taken

    def __getattr__(self, _name: str) -> Any:
        return lambda *_words: None


def test_an_sdo_answer_without_data_is_none() -> None:
    access = ObjectAccess(mock.Mock(), 5, "drive", 0.1)
    access.take(b"")
    access.take(bytes.fromhex("43"))
    assert access._client.responses.empty()


@pytest.mark.parametrize("size", [1, 3])
def test_a_servo_that_answers_more_or_less_than_was_asked_for_is_not_understood(size: int) -> None:
    answer = packet(1, 0, bytes(size))
    with mock.patch("serial.Serial", return_value=Answering(answer)):
        bus = ServoBus("port", 1_000_000, 0.01, SCS)
        bus.begin()
        with pytest.raises(DriveConnectionError):
            bus.read(1, Item(56, 2, "position"))


@pytest.mark.parametrize("told", [0.0, -1.0, float("nan"), float("inf")])
def test_a_range_that_means_nothing_is_refused(told: float) -> None:
    settings = SimpleNamespace(model="")
    actuator: Any = SimpleNamespace(_read=lambda *_words: told, _settings=settings, device="motor 1")
    with pytest.raises(DriveConfigurationError, match=r"motor 1.*its ranges are"):
        DamiaoActuator._checked_ranges(actuator)
