"""One actuator on its bus: a frame out, a frame in."""

from collections.abc import Callable, Sequence
from math import nan, pi
from struct import Struct
from time import perf_counter

from drivers.actuator.reading import Identity, Reading
from drivers.can_bus.port import CanPort
from drivers.contract import Mode
from drivers.damiao import protocol
from drivers.damiao.protocol import MODELS, Ranges, Register, register_frame
from drivers.damiao.settings import DamiaoSettings
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveError, WatchdogError
from drivers.host_time import host_was_away
from drivers.joint import JointScale

_ATTEMPTS = 2
_NEAR = 1e-4  # of a range, relative
_MARGIN = 0.02  # of the range of positions, within which the next turn may be lost
SIMULATED_SOFTWARE = 0xFFFF_FFFF


class DamiaoActuator:
    """An actuator, opened: disabled, its ranges known, its watchdog set.

    Args:
        port: open.
        settings: which actuator.
        joint: scales and signs.
        leave: called when it is closed; gives the port back.

    Raises:
        DriveError: at the first step that fails.
    """

    modes = frozenset({Mode.TORQUE})
    measured = frozenset({"time_s", "position_rad", "velocity_rad_s", "torque_n_m", "temperature_c"})
    notes: tuple[str, ...] = (
        "it tells its torque, and no current: where a current is shown, it is that over motor.torque_constant_n_m_a",
    )

    def __init__(self, port: CanPort, settings: DamiaoSettings, joint: JointScale, leave: Callable[[], None]) -> None:
        self.bus = port
        self._settings, self._leave = settings, leave
        self._counts_rad = joint.counts_per_turn / (2.0 * pi)
        self._brakes = self._has_missed = False
        software = int(self._read(Register.SOFTWARE, protocol.WORD))
        self.ranges = self._checked_ranges()
        self.identity = Identity(
            "Damiao", settings.model or "MIT-protocol actuator", str(software), "", software == SIMULATED_SOFTWARE
        )
        self.switch_off()
        self._forgive_lost_host()
        self._set(Register.CONTROL_MODE, protocol.MIT_MODE, DriveConfigurationError)
        self._set(Register.TIMEOUT, round(settings.watchdog_s / protocol.TIMEOUT_STEP_S), WatchdogError)

    @property
    def steps(self) -> dict[str, float]:
        """Smallest step of each quantity: 16 bits over the range of positions, 12 over the others."""
        ranges = self.ranges
        return {
            "position_rad": 2.0 * ranges.position_rad / 0xFFFF * self._counts_rad,
            "velocity_rad_s": 2.0 * ranges.speed_rad_s / 0xFFF * self._counts_rad,
            "torque_n_m": 2.0 * ranges.torque_n_m / 0xFFF,
            "temperature_c": 1.0,
        }

    def begin(self) -> None:
        """A call of the contract begins; it never speaks unasked, so nothing waits unless an answer was late."""
        if self._has_missed:
            self.bus.drain()
            self._has_missed = False

    def switch_on(self, mode: Mode, here: Reading) -> None:  # noqa: ARG002
        """Enable it, at a torque of 0."""
        self._brakes = False
        self._ask(protocol.ENABLE)
        self.exchange(Mode.TORQUE, 0.0)

    def switch_off(self) -> None:
        """Disable it."""
        self._ask(protocol.DISABLE)

    def exchange(self, mode: Mode, value: float) -> Reading:
        """Send the torque, or the question that moves nothing, and take the answer."""
        [reading] = exchange_all([(self, mode, value)])
        return reading

    def braking(self) -> tuple[Mode, float]:
        """A torque of 0 with damping: the whole torque at the highest speed."""
        self._brakes = True
        return Mode.TORQUE, 0.0

    def ask(self) -> Reading:
        """The question that moves nothing."""
        return self.exchange(Mode.OFF, 0.0)

    def clear_fault(self) -> None:
        """Clear its errors."""
        self._ask(protocol.CLEAR_ERRORS)

    def shout_off(self) -> None:
        """Disable it, and wait for nothing."""
        try:
            self.bus.send(self._settings.motor_id, protocol.DISABLE)
        except DriveConnectionError:
            return

    def close(self) -> None:
        """Give the bus back, where nobody else uses it."""
        self._leave()

    def tell(self, mode: Mode, value: float) -> None:
        """Send a demand, or ask.

        Raises:
            DriveConfigurationError: the torque is beyond the range of its frame.
        """
        if mode is Mode.OFF:
            self.bus.send(protocol.REGISTERS_ID, register_frame(self._settings.motor_id, protocol.ASK))
            return
        if abs(value) > self.ranges.torque_n_m:
            raise DriveConfigurationError(
                self._settings.device,
                f"torque demand is {value:g} N m; -{self.ranges.torque_n_m:g} .. {self.ranges.torque_n_m:g} N m is its "
                "range. Limit the demand",
            )
        damping = self.ranges.torque_n_m / self.ranges.speed_rad_s if self._brakes else 0.0
        self.bus.send(self._settings.motor_id, protocol.command(self.ranges, value, damping))

    def missed(self) -> None:
        """An answer was missed: what comes late is no answer to the next question."""
        self._has_missed = True
        self.bus.drain()

    def reading(self, asked_s: float) -> Reading:
        """What was heard last, in SI."""
        heard = self.bus.last(self._settings.feedback_id)
        data = b"" if heard is None else heard.data
        if len(data) != 8 or data[0] & 0x0F != self._settings.motor_id & 0x0F:
            raise DriveConnectionError(
                self._settings.device,
                f"an answer with {len(data)} bytes: {data.hex(' ')}; 8 of motor {self._settings.motor_id} are wanted. "
                "Has each actuator a feedback_id (MST_ID) of its own?",
            )
        found = protocol.feedback(data, self.ranges)
        fault = protocol.error_name(found.state)
        if abs(found.position_rad) > (1.0 - _MARGIN) * self.ranges.position_rad:
            fault = fault or "its position is at the end of the range of its frame (PMAX), beyond which it is not told"
        return Reading(
            asked_s, found.position_rad * self._counts_rad, found.speed_rad_s * self._counts_rad, nan, nan,
            found.torque_n_m, nan, found.temperature_c, found.state == protocol.ENABLED, fault,
        )  # fmt: skip

    def _checked_ranges(self) -> Ranges:
        """What it says that its frames mean.

        Raises:
            DriveConfigurationError: the model has other ranges.
        """
        registers = (Register.POSITION_RANGE, Register.SPEED_RANGE, Register.TORQUE_RANGE)
        found = Ranges(*(float(self._read(one, protocol.FLOAT)) for one in registers))
        wanted = MODELS.get(self._settings.model, found)
        if any(abs(one - other) > _NEAR * other for one, other in zip(found, wanted, strict=True)):
            raise DriveConfigurationError(
                self._settings.device,
                f"its ranges are {found.position_rad:g} rad, {found.speed_rad_s:g} rad/s, {found.torque_n_m:g} N m; a "
                f"{self._settings.model} has {wanted.position_rad:g} rad, {wanted.speed_rad_s:g} rad/s, "
                f"{wanted.torque_n_m:g} N m. Set drive.model to what it is, or leave it out to take what it says",
            )
        return found

    def _forgive_lost_host(self) -> None:
        """Clear the error that says only that the last host went away: this one is here, and the power is off."""
        if self.ask().fault.startswith("communication lost"):
            self.clear_fault()

    def _set(self, register: Register, value: int, error: type[DriveError]) -> None:
        """Write a register, and see that it is set."""
        try:
            self._register(protocol.WRITE, register, protocol.WORD.pack(value))
            found = int(self._read(register, protocol.WORD))
        except DriveConnectionError as failed:
            raise error(self._settings.device, f"{register.name} cannot be set: {failed}") from failed
        if found != value:
            raise error(self._settings.device, f"its {register.name} reads back as {found}, set was {value}")

    def _read(self, register: Register, layout: Struct) -> float:
        value: float = layout.unpack(self._register(protocol.READ, register)[4:])[0]
        return value

    def _register(self, what: int, register: Register, data: bytes = bytes(4)) -> bytes:
        settings = self._settings
        for _ in range(_ATTEMPTS):
            self.bus.drain()
            before = {settings.feedback_id: self.bus.number(settings.feedback_id)}
            self.bus.send(protocol.REGISTERS_ID, register_frame(settings.motor_id, what, register, data))
            self.bus.wait_beyond(before, settings.answer_timeout_s)
            heard = self.bus.last(settings.feedback_id)
            if heard is not None and protocol.is_register(heard.data, settings.motor_id, register):
                return heard.data
        raise no_answer(settings, register.name, perf_counter(), settings.answer_timeout_s)

    def _ask(self, data: bytes) -> None:
        """Send a frame that is answered with feedback, twice where it is not."""
        settings, began_s = self._settings, perf_counter()
        for _ in range(_ATTEMPTS):
            before = {settings.feedback_id: self.bus.number(settings.feedback_id)}
            self.bus.send(settings.motor_id, data)
            if not self.bus.wait_beyond(before, settings.answer_timeout_s):
                return
            self.missed()
        raise no_answer(settings, "feedback", began_s, _ATTEMPTS * settings.answer_timeout_s)


def exchange_all(demands: Sequence[tuple[DamiaoActuator, Mode, float]]) -> list[Reading]:
    """Send every torque, then wait for all answers.

    Raises:
        DriveConnectionError: one of them does not answer.
        DriveConfigurationError: a torque is beyond the range of its frame; what was before it has been sent.
    """
    bus, settings = demands[0][0].bus, demands[0][0]._settings
    asked_s = perf_counter()
    for _ in range(_ATTEMPTS):
        before = {one._settings.feedback_id: bus.number(one._settings.feedback_id) for one, _, _ in demands}
        for actuator, mode, value in demands:
            actuator.tell(mode, value)
        missing = bus.wait_beyond(before, settings.answer_timeout_s)
        if not missing:
            return [actuator.reading(asked_s) for actuator, _, _ in demands]
        for actuator, _, _ in demands:
            actuator.missed()
    ids = ", ".join(f"{one:#x}" for one in missing)
    raise no_answer(settings, f"feedback (MST_ID {ids})", asked_s, _ATTEMPTS * settings.answer_timeout_s)


def no_answer(settings: DamiaoSettings, what: str, began_s: float, longest_s: float) -> DriveConnectionError:
    """An answer has not come."""
    away = host_was_away(perf_counter() - began_s, longest_s, settings.answer_timeout_s)
    return DriveConnectionError(
        settings.device,
        f"{what}: found no answer within {settings.answer_timeout_s:g} s, asked {_ATTEMPTS} times at most; check the "
        f"cable, the power, motor_id (ESC_ID {settings.motor_id}), feedback_id (MST_ID {settings.feedback_id:#x}) and "
        f"the bit rate{away}",
    )
