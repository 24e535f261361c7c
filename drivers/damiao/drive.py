"""The drive contract on one Damiao actuator, and a listener to one that another host drives."""

from collections.abc import Callable
from math import inf, pi
from struct import Struct
from time import perf_counter

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.reading import Reading
from drivers.can_bus.follower import BusFollower
from drivers.can_bus.port import CanPort, Heard, on_bus
from drivers.contract import Mode
from drivers.damiao import protocol
from drivers.damiao.protocol import MODELS, Register, register_frame
from drivers.damiao.settings import DamiaoSettings
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveError, WatchdogError
from drivers.host_time import ATTEMPTS
from drivers.joint import JointScale
from drivers.mit.actuator import MitActuator, reading_of
from drivers.mit.frames import CLEAR_ERRORS, DISABLE, ENABLE, Frame, Ranges, command
from drivers.polled_drive import Identity

_NEAR = 1e-4  # of a range, relative
SIMULATED_SOFTWARE = 0xFFFF_FFFF
_MODES = frozenset({Mode.TORQUE})
_OPENING_QUESTIONS = 16


class DamiaoActuator(MitActuator):
    """An actuator, opened: disabled, its ranges known, its watchdog set.

    Arguments as of `MitActuator`.

    Raises:
        DriveError: at the first step that fails.
    """

    def __init__(self, port: CanPort, settings: DamiaoSettings, joint: JointScale, leave: Callable[[], None]) -> None:
        super().__init__(port, settings, joint, settings.feedback_id, leave)
        self._settings = settings
        self.enable, self.disable, self.clear = ((settings.motor_id, one) for one in (ENABLE, DISABLE, CLEAR_ERRORS))
        software = int(self._read(Register.SOFTWARE, protocol.WORD))
        self.ranges = self._checked_ranges()
        self.identity = Identity(
            "Damiao", settings.model or "MIT-protocol actuator", str(software), "", software == SIMULATED_SOFTWARE
        )
        self.switch_off()
        self.check_alone()
        self._forgive_lost_host()
        self._set(Register.CONTROL_MODE, protocol.MIT_MODE, DriveConfigurationError)
        self._set(Register.TIMEOUT, round(settings.watchdog_s / protocol.TIMEOUT_STEP_S), WatchdogError)

    def torque_frame(self, torque_n_m: float, damping: float) -> Frame:
        """The frame of a torque."""
        return self._settings.motor_id, command(self.ranges, torque_n_m, damping)

    def question(self) -> Frame:
        """The register frame that asks for feedback."""
        return protocol.REGISTERS_ID, register_frame(self._settings.motor_id, protocol.ASK)

    def addresses(self) -> str:
        """ESC_ID and MST_ID."""
        settings = self._settings
        return f"motor_id (ESC_ID {settings.motor_id}), feedback_id (MST_ID {settings.feedback_id:#x})"

    def taken(self, heard: Heard, asked_s: float) -> Reading:
        """Feedback in SI."""
        data = heard.data
        if len(data) != 8 or data[0] & 0x0F != self._settings.motor_id & 0x0F:
            raise DriveConnectionError(
                self.device,
                f"an answer with {len(data)} bytes: {data.hex(' ')}; 8 of motor {self._settings.motor_id} are wanted. "
                "Has each actuator a feedback_id (MST_ID) of its own?",
            )
        state, moves, temperature_c = protocol.feedback(data, self.ranges)
        return self.in_si(asked_s, moves, temperature_c, state == protocol.ENABLED, protocol.error_name(state))

    def _checked_ranges(self) -> Ranges:
        """What it says that its frames mean."""
        registers = (Register.POSITION_RANGE, Register.SPEED_RANGE, Register.TORQUE_RANGE)
        found = Ranges(*(float(self._read(one, protocol.FLOAT)) for one in registers))
        if not all(0.0 < one < inf for one in found):
            raise DriveConfigurationError(
                self.device,
                f"its ranges are {found.position_rad:g} rad, {found.speed_rad_s:g} rad/s, {found.torque_n_m:g} N m: "
                "none may be 0. Set them with the maker's tool (PMAX, VMAX, TMAX)",
            )
        wanted = MODELS.get(self._settings.model, found)
        if any(abs(one - other) > _NEAR * other for one, other in zip(found, wanted, strict=True)):
            raise DriveConfigurationError(
                self.device,
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
            raise error(self.device, f"{register.name} cannot be set: {failed}") from failed
        if found != value:
            raise error(self.device, f"its {register.name} reads back as {found}, set was {value}")

    def _read(self, register: Register, layout: Struct) -> float:
        value: float = layout.unpack(self._register(protocol.READ, register)[4:])[0]
        return value

    def _register(self, what: int, register: Register, data: bytes = bytes(4)) -> bytes:
        motor_id, began_s = self._settings.motor_id, perf_counter()
        for _ in range(ATTEMPTS):
            self.bus.drain()
            before = {self.answer_id: self.bus.number(self.answer_id)}
            self.bus.send(protocol.REGISTERS_ID, register_frame(motor_id, what, register, data))
            self.bus.wait_beyond(before, self.answer_timeout_s)
            heard = self.bus.last(self.answer_id)
            if heard is not None and protocol.is_register(heard.data, motor_id, register):
                return heard.data
        raise self.no_answer(register.name, began_s)


class DamiaoDrive(ActuatorDrive[DamiaoActuator]):
    """One actuator with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it."""

    def __init__(self, settings: DamiaoSettings, joint: JointScale) -> None:
        answer_s = 3 * settings.answer_timeout_s + 0.1
        family = Family(
            settings.device, "Damiao", _MODES, "communication timeout", settings.watchdog_s, 2 * answer_s,
            _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(
            family,
            joint,
            lambda: on_bus(settings.bus, lambda port, leave: DamiaoActuator(port, settings, joint, leave)),
        )


def follow(settings: DamiaoSettings, joint: JointScale) -> BusFollower:
    """Listen to it.

    Raises:
        DriveError: its model is left out, or the bus does not open.
    """
    if not settings.model:
        raise DriveConfigurationError(
            settings.device,
            "drive.model is left out. Its ranges are not asked for while another host drives it: set drive.model to "
            f"one of {', '.join(protocol.MODELS)}",
        )
    ranges, counts_rad = protocol.MODELS[settings.model], joint.counts_per_turn / (2.0 * pi)

    def taken(_port: CanPort, heard: Heard) -> Reading | None:
        data = heard.data
        is_other = len(data) != 8 or data[0] & 0x0F != settings.motor_id & 0x0F
        if is_other or protocol.is_register(data, settings.motor_id, data[3]):
            return None
        state, moves, temperature_c = protocol.feedback(data, ranges)
        is_on = state == protocol.ENABLED
        return reading_of(heard.at_s, moves, counts_rad, temperature_c, is_on, protocol.error_name(state))

    return BusFollower(settings.bus, settings.feedback_id, (f"Damiao {settings.model}", settings.device), taken, joint)
