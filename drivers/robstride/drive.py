"""The drive contract on one RobStride actuator, and a listener to one that another host drives."""

from collections.abc import Callable
from math import nan, pi
from struct import Struct
from time import perf_counter

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.reading import Reading
from drivers.can_bus.follower import BusFollower
from drivers.can_bus.port import CanPort, Heard, on_bus
from drivers.contract import Mode
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveError, WatchdogError
from drivers.host_time import ATTEMPTS
from drivers.joint import JointScale
from drivers.mit.actuator import MitActuator, chosen_ranges, reading_of
from drivers.mit.frames import Frame
from drivers.polled_drive import Identity
from drivers.robstride import protocol
from drivers.robstride.protocol import Kind, Parameter
from drivers.robstride.settings import RobstrideSettings

_SAME_RAD = 0.05  # two words for one angle, of a joint at rest
_NEAR = 1e-3
_SLOW_S = 0.2  # between two questions for the supply voltage
SIMULATED_SERIAL = "5349 4d55 4c41 5445"  # of our own simulated device: "SIMULATE"
_OPENING_QUESTIONS = 16
_HOST_BITS = 0xFF


class RobstrideActuator(MitActuator):
    """An actuator, opened: stopped, its ranges looked at, its watchdog set.

    Arguments as of `MitActuator`.

    Raises:
        DriveError: at the first step that fails.
    """

    measured = MitActuator.measured | {"supply_v"}
    bits = (16, 16, 16)
    temperature_step_c = 0.1

    def __init__(
        self, port: CanPort, settings: RobstrideSettings, joint: JointScale, leave: Callable[[], None]
    ) -> None:
        port.state_bits |= protocol.STATE_BITS
        self._id = settings.motor_id
        super().__init__(port, settings, joint, protocol.answer_id(Kind.FEEDBACK, self._id), leave)
        self._settings = settings
        self.enable, self.disable = protocol.frame(Kind.ENABLE, self._id), protocol.frame(Kind.STOP, self._id)
        self.clear = protocol.frame(Kind.STOP, self._id, b"\x01" + bytes(7))  # and stop
        written = settings.position_range_rad, settings.speed_range_rad_s, settings.torque_range_n_m
        self.ranges = chosen_ranges(self.device, settings.model, protocol.MODELS, written)
        self._timeout = protocol.WORD.pack(round(settings.watchdog_s / protocol.TIMEOUT_STEP_S))
        self.switch_off()
        # first of all: with two of one id the answer to one question may be taken for that to the next
        self.check_alone()
        self.identity = self._identify()
        self._check_ranges()
        self._set(Parameter.RUN_MODE, protocol.WORD.pack(protocol.OPERATION_MODE), DriveConfigurationError)
        self._set(Parameter.TIMEOUT, self._timeout, WatchdogError)
        self._supply_v, self._slow_s = self._value(Parameter.SUPPLY), perf_counter()
        self._slow_asked_s = self._slow_s

    def torque_frame(self, torque_n_m: float, damping: float) -> Frame:
        """The frame of a torque."""
        return protocol.command(self._id, self.ranges, torque_n_m, damping)

    def question(self) -> Frame:
        """Its time-out, written as it is already: answered with feedback, and nothing changes."""
        return protocol.parameter_frame(Kind.WRITE, self._id, Parameter.TIMEOUT, self._timeout)

    def addresses(self) -> str:
        """Its id."""
        return f"motor_id ({self._id})"

    def tell(self, mode: Mode, value: float) -> None:
        """Send a demand, or ask; now and then ask for the supply voltage, too, whose answer nobody waits for."""
        super().tell(mode, value)
        now_s = perf_counter()
        if now_s - self._slow_asked_s > _SLOW_S:
            self._slow_asked_s = now_s
            self.bus.send(*protocol.parameter_frame(Kind.READ, self._id, Parameter.SUPPLY))

    def taken(self, heard: Heard, asked_s: float) -> Reading:
        """Feedback in SI."""
        if len(heard.data) != 8:
            raise DriveConnectionError(
                self.device, f"an answer with {len(heard.data)} bytes: {heard.data.hex(' ')}; 8 are wanted"
            )
        found = protocol.feedback(heard.can_id, heard.data, self.ranges)
        self._keep_supply()
        reading = self.in_si(
            asked_s, found.motion, found.temperature_c, found.mode == protocol.RUNS and not found.fault, found.fault
        )
        return reading._replace(supply_v=self._supply_v, slow_s=self._slow_s)

    def _keep_supply(self) -> None:
        heard = self.bus.last(protocol.answer_id(Kind.READ, self._id))
        if heard is not None and heard.at_s > self._slow_s and _is_of(heard, Parameter.SUPPLY):
            (self._supply_v,), self._slow_s = protocol.FLOAT.unpack(heard.data[4:8]), heard.at_s

    def _identify(self) -> Identity:
        """Its serial number, and its version where its firmware tells it."""
        answer = protocol.identity_id(self._id)
        heard = self._heard(protocol.frame(Kind.IDENTIFY, self._id), answer, lambda _: True, "IDENTIFY")
        serial = heard.data.hex(" ", 2)
        asked = protocol.frame(Kind.STOP, self._id, protocol.VERSION + bytes(6))
        told = self._heard(asked, self.answer_id, lambda _: True, "version")
        version = ".".join(str(part) for part in told.data[3:7]) if told.data.startswith(protocol.VERSION) else ""
        name = self._settings.model or "RS series actuator"
        return Identity("RobStride", name, version, serial, serial == SIMULATED_SERIAL)

    def _check_ranges(self) -> None:
        """Compare the ranges with what it says in plain numbers, before anything moves."""
        limit_n_m, angle_rad = self._value(Parameter.TORQUE_LIMIT), self._value(Parameter.POSITION)
        self.told(self.question())
        heard = self.bus.last(self.answer_id)
        told_rad = nan
        if heard is not None and len(heard.data) == 8:
            told_rad = protocol.feedback(heard.can_id, heard.data, self.ranges)[0].position_rad
        full = self.ranges
        if limit_n_m > (1.0 + _NEAR) * full.torque_n_m:
            raise DriveConfigurationError(
                self.device,
                f"its torque limit is {limit_n_m:g} N m, and its frames would end at {full.torque_n_m:g} N m: it is "
                "another model. Set drive.model to what is on its plate",
            )
        if not abs(told_rad - angle_rad) <= _SAME_RAD and abs(angle_rad) < full.position_rad:
            raise DriveConfigurationError(
                self.device,
                f"its position is {angle_rad:g} rad, and its frame says {told_rad:g} rad with a range of "
                f"{full.position_rad:g} rad: its firmware has another range, or it is moving. Set the ranges by hand",
            )

    def _set(self, parameter: Parameter, data: bytes, error: type[DriveError]) -> None:
        """Write a parameter, and see that it is set."""
        try:
            self.told(protocol.parameter_frame(Kind.WRITE, self._id, parameter, data))
            found = self._parameter(parameter)
        except DriveConnectionError as failed:
            raise error(self.device, f"{parameter.name} cannot be set: {failed}") from failed
        size = 1 if parameter is Parameter.RUN_MODE else 4
        if found[:size] != data[:size]:
            wanted, is_now = (int.from_bytes(one[:size], "little") for one in (data, found))
            raise error(self.device, f"its {parameter.name} reads back as {is_now}, set was {wanted}: update it")

    def _value(self, parameter: Parameter, layout: Struct = protocol.FLOAT) -> float:
        value: float = layout.unpack(self._parameter(parameter))[0]
        return value

    def _parameter(self, parameter: Parameter) -> bytes:
        answer = protocol.answer_id(Kind.READ, self._id)
        asked = protocol.parameter_frame(Kind.READ, self._id, parameter)
        return self._heard(asked, answer, lambda heard: _is_of(heard, parameter), parameter.name).data[4:8]

    def _heard(self, asked: Frame, answer: int, is_it: Callable[[Heard], bool], what: str) -> Heard:
        """Ask, twice where it is not answered.

        Raises:
            DriveConnectionError: it is not answered, or refused.
        """
        began_s = perf_counter()
        for _ in range(ATTEMPTS):
            before = {answer: self.bus.number(answer)}
            self.bus.send(*asked)
            missing = self.bus.wait_beyond(before, self.answer_timeout_s)
            heard = self.bus.last(answer)
            if not missing and heard is not None and len(heard.data) == 8 and is_it(heard):
                return heard
            self.missed()
        raise self.no_answer(what, began_s)


def _is_of(heard: Heard, parameter: Parameter) -> bool:
    """Whether an answer has the value of a parameter: with a state of 0, it was read."""
    is_read = not heard.can_id & protocol.STATE_BITS
    return is_read and len(heard.data) == 8 and int.from_bytes(heard.data[:2], "little") == parameter


class RobstrideDrive(ActuatorDrive[RobstrideActuator]):
    """One actuator with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it."""

    def __init__(self, settings: RobstrideSettings, joint: JointScale) -> None:
        answer_s = 3 * settings.answer_timeout_s + 0.1
        family = Family(
            settings.device, "RobStride", RobstrideActuator.modes, "CAN time-out", settings.watchdog_s, 2 * answer_s,
            _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(
            family,
            joint,
            lambda: on_bus(settings.bus, lambda port, leave: RobstrideActuator(port, settings, joint, leave)),
        )


def follow(settings: RobstrideSettings, joint: JointScale) -> BusFollower:
    """Listen to it.

    Raises:
        DriveError: its ranges are not known, or the bus does not open.
    """
    written = settings.position_range_rad, settings.speed_range_rad_s, settings.torque_range_n_m
    ranges = chosen_ranges(settings.device, settings.model, protocol.MODELS, written)
    counts_rad = joint.counts_per_turn / (2.0 * pi)

    def taken(_port: CanPort, heard: Heard) -> Reading | None:
        if len(heard.data) != 8:
            return None
        found = protocol.feedback(heard.can_id, heard.data, ranges)
        is_on = found.mode == protocol.RUNS and not found.fault
        return reading_of(heard.at_s, found.motion, counts_rad, found.temperature_c, is_on, found.fault)

    return BusFollower(
        settings.bus,
        protocol.answer_id(Kind.FEEDBACK, settings.motor_id),
        (f"RobStride {settings.model or 'RS series actuator'}", settings.device),
        taken,
        joint,
        protocol.STATE_BITS | _HOST_BITS,
    )
