"""One actuator of the MIT protocol on its bus: a frame out, a frame in."""

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from math import nan, pi
from time import perf_counter
from typing import Protocol

from drivers.actuator.actuator import Actuator
from drivers.actuator.open_buses import check_alone
from drivers.actuator.reading import Reading
from drivers.can_bus.port import CanPort, Heard
from drivers.contract import Mode
from drivers.errors import DriveConfigurationError, DriveConnectionError
from drivers.host_time import ATTEMPTS, no_answer
from drivers.joint import JointScale
from drivers.mit.frames import Frame, Motion, Ranges
from drivers.polled_drive import Identity

_MARGIN = 0.02  # of the range of positions, within which the next turn may be lost
NO_CURRENT = (
    "it tells its torque, and no current: where a current is shown, it is that over motor.torque_constant_n_m_a"
)


class MitSettings(Protocol):
    """What the settings of every kind have."""

    @property
    def device(self) -> str:
        """The name used in messages."""

    @property
    def answer_timeout_s(self) -> float:
        """Longest wait for one answer [s]."""


class MitActuator(Actuator):
    """What actuators of every vendor do alike; a kind says what its frames are.

    Args:
        port: open.
        settings: which actuator.
        joint: scales and signs.
        answer_id: of the frames with which it answers.
        leave: called when it is closed; gives the port back.

    Attributes:
        ranges: what its numbers mean; set by the kind, before it is switched on.
        enable, disable, clear: the frames that power its stage, take the power away, and clear its errors; set by the
            kind.
        bits: of position, speed and torque in its answers.
    """

    modes = frozenset({Mode.TORQUE})
    measured = frozenset({"time_s", "position_rad", "velocity_rad_s", "torque_n_m", "temperature_c"})
    notes: tuple[str, ...] = (NO_CURRENT,)
    bits = (16, 12, 12)
    temperature_step_c = 1.0
    identity: Identity
    bus: CanPort
    ranges: Ranges
    enable: Frame
    disable: Frame
    clear: Frame

    def __init__(
        self, port: CanPort, settings: MitSettings, joint: JointScale, answer_id: int, leave: Callable[[], None]
    ) -> None:
        self.bus = port
        self.answer_id = answer_id
        self.device, self.answer_timeout_s = settings.device, settings.answer_timeout_s
        self._leave = leave
        self._counts_rad = joint.counts_per_turn / (2.0 * pi)
        self._brakes = self._has_missed = False

    @abstractmethod
    def torque_frame(self, torque_n_m: float, damping: float) -> Frame:
        """The frame of a torque [N m] with a damping [N m s/rad]."""

    @abstractmethod
    def question(self) -> Frame:
        """The frame that is answered, and changes neither motion nor power."""

    @abstractmethod
    def taken(self, heard: Heard, asked_s: float) -> Reading:
        """An answer in SI. Raises `DriveConnectionError` where it is none."""

    @abstractmethod
    def addresses(self) -> str:
        """Its addresses as the settings name them, for messages."""

    @property
    def steps(self) -> dict[str, float]:
        """Smallest step of each quantity: so many bits over its range."""
        fulls = self.ranges[:3]
        position, speed, torque = (2.0 * full / ((1 << bits) - 1) for full, bits in zip(fulls, self.bits, strict=True))
        return {
            "position_rad": position * self._counts_rad,
            "velocity_rad_s": speed * self._counts_rad,
            "torque_n_m": torque,
            "temperature_c": self.temperature_step_c,
        }

    def begin(self) -> None:
        """A call of the contract begins; it never speaks unasked, so nothing waits unless an answer was late."""
        if self._has_missed:
            self.bus.drain()
            self._has_missed = False

    def switch_on(self, mode: Mode, here: Reading) -> None:  # noqa: ARG002
        """Enable it, at a torque of 0."""
        self._brakes = False
        self.told(self.enable)
        self.exchange(Mode.TORQUE, 0.0)

    def switch_off(self) -> None:
        """Disable it."""
        self.told(self.disable)

    @staticmethod
    def exchange_all(demands: Sequence[tuple["MitActuator", Mode, float]]) -> list[Reading]:
        """Send every torque, then wait for all answers.

        Raises:
            DriveConnectionError: one of them does not answer.
            DriveConfigurationError: a torque is beyond the range of its frame; what was before it has been sent.
        """
        first = demands[0][0]
        bus, asked_s = first.bus, perf_counter()
        for _ in range(ATTEMPTS):
            before = {one.answer_id: bus.number(one.answer_id) for one, _, _ in demands}
            for actuator, mode, value in demands:
                actuator.tell(mode, value)
            missing = bus.wait_beyond(before, first.answer_timeout_s)
            if not missing:
                return [actuator.reading(asked_s) for actuator, _, _ in demands]
            for actuator, _, _ in demands:
                actuator.missed()
        silent = next(actuator for actuator, _, _ in demands if actuator.answer_id in missing)
        raise silent.no_answer("feedback", asked_s)

    def braking(self) -> tuple[Mode, float]:
        """A torque of 0 with damping: the whole torque at the highest speed."""
        self._brakes = True
        return Mode.TORQUE, 0.0

    def clear_fault(self) -> None:
        """Clear its errors."""
        self.told(self.clear)

    def shout_off(self) -> None:
        """Disable it, and wait for nothing."""
        try:
            self.bus.send(*self.disable)
        except DriveConnectionError:
            return

    def tell(self, mode: Mode, value: float) -> None:
        """Send a demand, or ask.

        Raises:
            DriveConfigurationError: the torque is beyond the range of its frame.
        """
        if mode is Mode.OFF:
            self.bus.send(*self.question())
            return
        full_n_m = self.ranges.torque_n_m
        if abs(value) > full_n_m:
            raise DriveConfigurationError(
                self.device,
                f"torque demand is {value:g} N m; -{full_n_m:g} .. {full_n_m:g} N m is its range. Limit the demand",
            )
        self.bus.send(*self.torque_frame(value, self.ranges.braking_damping if self._brakes else 0.0))

    def told(self, frame: Frame) -> None:
        """Send a frame that is answered, twice where it is not.

        Raises:
            DriveConnectionError: it is not answered.
        """
        began_s = perf_counter()
        for _ in range(ATTEMPTS):
            before = {self.answer_id: self.bus.number(self.answer_id)}
            self.bus.send(*frame)
            if not self.bus.wait_beyond(before, self.answer_timeout_s):
                return
            self.missed()
        raise self.no_answer("feedback", began_s)

    def check_alone(self) -> None:
        """Ask once, and see that one answers: two of one id would both turn, and be taken for one.

        Raises:
            DriveConfigurationError: more than one does.
        """
        check_alone(
            self.device,
            self.addresses(),
            lambda: self.bus.answers(lambda: self.bus.send(*self.question()), self.answer_id, self.answer_timeout_s),
        )

    def missed(self) -> None:
        """An answer was missed: what comes late is no answer to the next question."""
        self._has_missed = True
        self.bus.drain()

    def reading(self, asked_s: float) -> Reading:
        """What was heard last, in SI."""
        heard = self.bus.last(self.answer_id)
        assert heard is not None
        return self.taken(heard, asked_s)

    def in_si(self, asked_s: float, found: Motion, temperature_c: float, is_on: bool, fault: str) -> Reading:
        """A reading; at the end of the range of positions it has a fault, as nobody knows what is beyond."""
        if abs(found.position_rad) > (1.0 - _MARGIN) * self.ranges.position_rad:
            fault = fault or "its position is at the end of the range of its frame, beyond which it is not told"
        return reading_of(asked_s, found, self._counts_rad, temperature_c, is_on, fault)

    def no_answer(self, what: str, began_s: float) -> DriveConnectionError:
        """An answer has not come."""
        check = f"{self.addresses()} and the bit rate"
        return no_answer(self.device, f"{what}: found no answer", check, self.answer_timeout_s, began_s)


def reading_of(
    asked_s: float, found: Motion, counts_rad: float, temperature_c: float, is_on: bool, fault: str
) -> Reading:
    """What an answer says, with so many counts of the sensor a radian."""
    return Reading(
        asked_s, found.position_rad * counts_rad, found.speed_rad_s * counts_rad, nan, nan, found.torque_n_m, nan,
        temperature_c, is_on, fault,
    )  # fmt: skip


def chosen_ranges(device: str, model: str, models: Mapping[str, Ranges], written: tuple[float, float, float]) -> Ranges:
    """The ranges of a model, or written ones.

    Args:
        device: name used in messages.
        model: its name; "" where the ranges are written.
        models: ranges by name.
        written: of position [rad], speed [rad/s] and torque [N m]; 0 where they are the model's.

    Raises:
        DriveConfigurationError: neither, or both, or not all three: what a torque means would be a guess.
    """
    if model and not any(written):
        return models[model]
    if not model and all(written):
        return Ranges(*written)
    raise DriveConfigurationError(
        device,
        f"it does not tell what its numbers mean. drive.model is '{model}', position_range_rad, speed_range_rad_s and "
        f"torque_range_n_m are {written[0]:g}, {written[1]:g}, {written[2]:g}; either a model or all three are wanted, "
        "as its manual has them for its firmware: a wrong range is a wrong torque",
    )
