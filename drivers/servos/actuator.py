"""A servo on its bus: goals out, one piece of its table in, in one go."""

from abc import abstractmethod
from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Protocol, TypeVar

from drivers.actuator.actuator import Actuator
from drivers.actuator.reading import Reading
from drivers.contract import Mode
from drivers.servos.bus import ServoBus
from drivers.servos.frames import Item


class ServoSettings(Protocol):
    """What the settings of every protocol have."""

    @property
    def port(self) -> str:
        """Serial port."""

    @property
    def baud_rate(self) -> int:
        """Of the line."""

    @property
    def servo_id(self) -> int:
        """Of the servo."""

    @property
    def answer_timeout_s(self) -> float:
        """Longest wait for one answer [s]."""

    @property
    def device(self) -> str:
        """The name used in messages."""


class ServoActuator(Actuator):
    """What the servos of every protocol do alike.

    Args:
        bus: open.
        servo_id: which servo.
        leave: called when the servo is closed; gives the bus back.
    """

    bus: ServoBus
    piece: Item
    torque_enable: Item

    def __init__(self, bus: ServoBus, servo_id: int, leave: Callable[[], None]) -> None:
        self.bus, self.servo_id = bus, servo_id
        self._leave = leave
        self._mode = Mode.OFF

    @abstractmethod
    def goal(self, mode: Mode, value: float) -> tuple[int, bytes]:
        """Where a demand goes, and its bytes."""

    @abstractmethod
    def reading(self, data: bytes, asked_s: float) -> Reading:
        """The piece in SI."""

    def begin(self) -> None:
        """A call of the contract begins."""
        self.bus.begin()

    def switch_off(self) -> None:
        """Power off."""
        self._mode = Mode.OFF
        self._write(self.torque_enable, 0)

    @staticmethod
    def exchange_all(demands: Sequence[tuple["ServoActuator", Mode, float]]) -> list[Reading]:
        """Write the goals of servos on one bus, and read the piece of each, in one go."""
        first = demands[0][0]
        goals: dict[int, dict[int, bytes]] = {}
        for servo, mode, value in demands:
            if mode is not Mode.OFF:
                address, data = servo.goal(mode, value)
                goals.setdefault(address, {})[servo.servo_id] = data
        asked_s = perf_counter()
        answers = first.bus.exchange(goals, tuple(servo.servo_id for servo, _, _ in demands), first.piece)
        return [servo.reading(answer.data, asked_s) for (servo, _, _), answer in zip(demands, answers, strict=True)]

    def braking(self) -> tuple[Mode, float]:
        """A goal of 0: a duty of 0 brakes, a current of 0 does not; a position is kept."""
        return (Mode.OFF if self._mode is Mode.POSITION else self._mode), 0.0

    def shout_off(self) -> None:
        """Power off, and wait for no answer."""
        self.bus.shout(self.servo_id, self.torque_enable, 0)

    def _write_goal(self, mode: Mode, value: float) -> None:
        address, data = self.goal(mode, value)
        self._write(Item(address, len(data), f"{mode.value} goal"), int.from_bytes(data, "little"))

    def _write(self, item: Item, value: int) -> None:
        self.bus.write(self.servo_id, item, value)

    def _word(self, item: Item) -> int:
        return self.bus.read(self.servo_id, item)


ServoT = TypeVar("ServoT", bound=ServoActuator)
