"""The drive contract on one axis of an ODrive, and a listener to one that another host drives."""

from collections.abc import Callable, Sequence
from math import nan
from struct import Struct
from time import perf_counter

from drivers.actuator.actuator import Actuator
from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.open_buses import check_alone
from drivers.actuator.reading import Reading
from drivers.can_bus.follower import BusFollower
from drivers.can_bus.port import CanPort, Heard, on_bus, prepare
from drivers.contract import Mode
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveStateError, WatchdogError
from drivers.host_time import ATTEMPTS, no_answer
from drivers.joint import JointScale
from drivers.odrive import protocol
from drivers.odrive.protocol import Command, can_id, error_names
from drivers.odrive.settings import OdriveSettings
from drivers.polled_drive import Identity

_QUICK = (Command.GET_ENCODER_ESTIMATES, Command.GET_IQ, Command.GET_ERROR)
_SLOW = (Command.GET_BUS, Command.GET_TEMPERATURE)
STATE_S = 1.0  # longest wait for a change of state, and for the heartbeat that shows it
SIMULATED = 255  # "unreleased" of our own simulated device
_MODES = frozenset({Mode.TORQUE})
_OPENING_QUESTIONS = 8
_NEW_S = 0.05  # a current that is older is not that of the motion
_TOLD_S = 5.0  # what changes slowly


class OdriveActuator(Actuator):
    """An axis, opened: idle, its errors seen.

    Args:
        port: open.
        settings: which axis.
        joint: scales and signs.
        leave: called when it is closed; gives the port back.

    Raises:
        DriveError: at the first step that fails.
    """

    modes = frozenset({Mode.TORQUE})
    measured = frozenset({"time_s", "position_rad", "velocity_rad_s", "current_a", "supply_v", "temperature_c"})
    notes: tuple[str, ...] = ()
    bus: CanPort

    def __init__(self, port: CanPort, settings: OdriveSettings, joint: JointScale, leave: Callable[[], None]) -> None:
        self.bus = port
        self._settings, self._leave = settings, leave
        self._counts_per_turn = joint.counts_per_turn
        self._base = can_id(settings.node_id, Command.GET_VERSION)
        self._questions = {
            command: prepare(can_id(settings.node_id, command), remote=True) for command in (*_QUICK, *_SLOW)
        }
        self._supply_v = self._temperature_c = nan
        self._slow_s = perf_counter()
        self._has_asked_slow = False
        self._cycle = 0
        if not settings.watchdog_is_set_in_drive:
            raise WatchdogError(
                settings.device,
                "CANSimple has no message for its watchdog. Set it with odrivetool (axis0.config.watchdog_timeout = "
                f"{settings.watchdog_s:g}, axis0.config.enable_watchdog = True, save_configuration()), and then set "
                "drive.watchdog_is_set_in_drive = true; `doctor --move` tries it",
            )
        # first of all: with two of one id the answer to one question may be taken for that to the next
        version = can_id(settings.node_id, Command.GET_VERSION)  # it says that only where it is asked
        check_alone(
            settings.device,
            f"node_id ({settings.node_id})",
            lambda: port.answers(lambda: port.send(version, remote=True), version, settings.answer_timeout_s),
        )
        self.identity = self._identify()
        self.switch_off()
        self._forgive_lost_host()
        for command in _SLOW:
            self._ask(command)
        self._keep_slow()

    @property
    def steps(self) -> dict[str, float]:
        """Smallest step of each quantity; of the others nothing is known."""
        return {"position_rad": 1.0}

    def begin(self) -> None:
        """A call of the contract begins."""
        self.bus.drain()

    def switch_on(self, mode: Mode, here: Reading) -> None:  # noqa: ARG002
        """Torque control with a torque of 0, closed loop, and wait for the heartbeat that says so.

        Raises:
            DriveStateError: it does not get there.
        """
        self._send(Command.SET_CONTROLLER_MODE, protocol.MODES.pack(protocol.TORQUE_CONTROL, protocol.PASSTHROUGH))
        self._send(Command.SET_INPUT_TORQUE, protocol.TORQUE.pack(0.0))
        self._send(Command.SET_AXIS_STATE, protocol.WORD.pack(protocol.CLOSED_LOOP))
        end_s = perf_counter() + STATE_S
        while self._state() != protocol.CLOSED_LOOP:
            reading = self.exchange(Mode.TORQUE, 0.0)  # keeps its watchdog fed
            if reading.fault or perf_counter() > end_s:
                why = reading.fault or f"its state stays {self._state()}, {protocol.CLOSED_LOOP} is wanted"
                raise DriveStateError(self._settings.device, f"does not switch on: {why}; calibrate it first")

    def switch_off(self) -> None:
        """Idle, and wait for the heartbeat that says so."""
        self._send(Command.SET_AXIS_STATE, protocol.WORD.pack(protocol.IDLE))
        end_s = perf_counter() + STATE_S
        heartbeat = can_id(self._settings.node_id, Command.HEARTBEAT)
        while True:
            missing = self.bus.wait_for([heartbeat], STATE_S)
            if self._state() != protocol.CLOSED_LOOP and not missing:
                return
            if missing or perf_counter() > end_s:
                raise DriveConnectionError(
                    self._settings.device, "no heartbeat that says that it is idle; check cable, power and node_id"
                )

    @staticmethod
    def exchange_all(demands: Sequence[tuple["OdriveActuator", Mode, float]]) -> list[Reading]:
        """Send every torque and every question, then wait for all answers."""
        bus, settings = demands[0][0].bus, demands[0][0]._settings
        asked_s = perf_counter()
        for _ in range(ATTEMPTS):
            before: dict[int, int] = {}
            for axis, mode, value in demands:
                before |= axis.tell(mode, value)
            missing = bus.wait_beyond(before, settings.answer_timeout_s)
            if not missing:
                return [axis.reading(asked_s) for axis, _, _ in demands]
        raise _silent(settings, missing, asked_s)

    def braking(self) -> tuple[Mode, float]:
        """A torque of 0: friction brakes."""
        return Mode.TORQUE, 0.0

    def clear_fault(self) -> None:
        """Clear its errors."""
        self._send(Command.CLEAR_ERRORS, bytes(1))
        self.bus.wait_for([can_id(self._settings.node_id, Command.HEARTBEAT)], STATE_S)

    def shout_off(self) -> None:
        """Idle, and wait for nothing."""
        try:
            self._send(Command.SET_AXIS_STATE, protocol.WORD.pack(protocol.IDLE))
        except DriveConnectionError:
            return

    def tell(self, mode: Mode, value: float) -> dict[int, int]:
        """Send a demand and the questions of a cycle. Returns how often each answer had come before."""
        self._cycle += 1
        slow = _SLOW[self._cycle // self._settings.slow_every % len(_SLOW)]
        commands = (*_QUICK, slow) if self._cycle % self._settings.slow_every == 0 else _QUICK
        before = {}
        for command in commands:
            question = self._questions[command]
            before[question.arbitration_id] = self.bus.number(question.arbitration_id)
            self.bus.send_prepared(question)
        # last: asked after it, the current would be now that of this cycle, now that of the one whose motion is told
        if mode is Mode.TORQUE:
            self._send(Command.SET_INPUT_TORQUE, protocol.TORQUE.pack(value))
        self._has_asked_slow = slow in commands
        return before

    def reading(self, asked_s: float) -> Reading:
        """What was heard last, in SI."""
        if self._has_asked_slow:
            self._keep_slow()
        turns, turns_s = self._pair(Command.GET_ENCODER_ESTIMATES)
        _, current_a = self._pair(Command.GET_IQ)
        active, disarmed_for = self._heard(Command.GET_ERROR, protocol.ERRORS, (0, 0))
        fault = error_names(int(active) | int(disarmed_for))
        return Reading(
            asked_s, turns * self._counts_per_turn, turns_s * self._counts_per_turn, nan, current_a, nan,
            self._supply_v, self._temperature_c,
            self._state() == protocol.CLOSED_LOOP and not fault, fault, slow_s=self._slow_s,
        )  # fmt: skip

    def _identify(self) -> Identity:
        version = self._ask(Command.GET_VERSION)
        _, line, number, variant, major, minor, revision, unreleased = protocol.VERSION.unpack(version)
        return Identity(
            "ODrive", f"ODrive {line}.{number}-{variant}", f"{major}.{minor}.{revision}", "", unreleased == SIMULATED
        )

    def _forgive_lost_host(self) -> None:
        """Clear the error that says only that the last host went away: this one is here, and the power is off."""
        active, disarmed_for = protocol.ERRORS.unpack(self._ask(Command.GET_ERROR))
        if active | disarmed_for == protocol.WATCHDOG_TIMER_EXPIRED:
            self.clear_fault()

    def _keep_slow(self) -> None:
        self._supply_v, _ = self._pair(Command.GET_BUS)
        self._temperature_c = max(self._pair(Command.GET_TEMPERATURE))
        self._slow_s = perf_counter()

    def _ask(self, command: Command) -> bytes:
        """One question, asked twice where it is not answered."""
        identifier, began_s = can_id(self._settings.node_id, command), perf_counter()
        for _ in range(ATTEMPTS):
            before = {identifier: self.bus.number(identifier)}
            self.bus.send(identifier, remote=True)
            if not self.bus.wait_beyond(before, self._settings.answer_timeout_s):
                break
        else:
            raise _silent(self._settings, [identifier], began_s)
        heard = self.bus.last(identifier)
        return b"" if heard is None else heard.data.ljust(8, b"\0")

    def _state(self) -> int:
        return int(self._heard(Command.HEARTBEAT, protocol.HEARTBEAT, (0, 0, 0, 0))[1])

    def _pair(self, command: Command) -> tuple[float, float]:
        first, second = self._heard(command, protocol.PAIR, (nan, nan))
        return first, second

    def _heard(self, command: Command, layout: Struct, absent: tuple[float, ...]) -> tuple[float, ...]:
        """The last of a message; what is there instead where none has come, or one that is too short."""
        heard = self.bus.last(self._base | command)
        return absent if heard is None or len(heard.data) < layout.size else layout.unpack_from(heard.data)

    def _send(self, command: Command, data: bytes) -> None:
        self.bus.send(can_id(self._settings.node_id, command), data)


def _silent(settings: OdriveSettings, missing: list[int], began_s: float) -> DriveConnectionError:
    """Some answers have not come."""
    names = ", ".join(f"{Command(one & 31).name} of node {one >> 5}" for one in missing)
    check = "node_id and the bit rate"
    return no_answer(settings.device, f"{names}: found no answer", check, settings.answer_timeout_s, began_s)


class OdriveDrive(ActuatorDrive[OdriveActuator]):
    """One axis with its joint, by torque; `rig.motor.torque_constant_n_m_a` makes one of a current."""

    def __init__(self, settings: OdriveSettings, joint: JointScale) -> None:
        answer_s = 2 * settings.answer_timeout_s + STATE_S
        family = Family(
            settings.device, "ODrive", _MODES, "watchdog", settings.watchdog_s, answer_s + STATE_S,
            _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(family, joint, lambda: _opened(settings, joint))


def _opened(settings: OdriveSettings, joint: JointScale) -> OdriveActuator:
    if not settings.bus.sends_remote_frames:
        raise DriveConfigurationError(
            settings.device,
            f"python-can sends no remote frames over {settings.bus.interface}, and CANSimple asks with them; use "
            "socketcan or slcan",
        )
    return on_bus(settings.bus, lambda port, leave: OdriveActuator(port, settings, joint, leave))


def follow(settings: OdriveSettings, joint: JointScale) -> BusFollower:
    """Listen to it.

    Raises:
        DriveConnectionError: the bus does not open.
    """

    def told(port: CanPort, command: Command, now_s: float, longest_s: float) -> tuple[float, float]:
        heard = port.last(can_id(settings.node_id, command))
        if heard is None or now_s - heard.at_s > longest_s or len(heard.data) < protocol.PAIR.size:
            return nan, nan
        first, second = protocol.PAIR.unpack_from(heard.data)
        return first, second

    def taken(port: CanPort, heard: Heard) -> Reading | None:
        if len(heard.data) < protocol.PAIR.size:
            return None
        turns, turns_s = protocol.PAIR.unpack_from(heard.data)
        beat = port.last(can_id(settings.node_id, Command.HEARTBEAT))
        errors, state = (0, 0) if beat is None else protocol.HEARTBEAT.unpack_from(beat.data)[:2]
        _, current_a = told(port, Command.GET_IQ, heard.at_s, _NEW_S)
        supply_v, _ = told(port, Command.GET_BUS, heard.at_s, _TOLD_S)
        temperature_c = max(told(port, Command.GET_TEMPERATURE, heard.at_s, _TOLD_S))
        return Reading(
            heard.at_s, turns * joint.counts_per_turn, turns_s * joint.counts_per_turn, nan, current_a, nan, supply_v,
            temperature_c, state == protocol.CLOSED_LOOP, protocol.error_names(errors),
        )  # fmt: skip

    estimates = can_id(settings.node_id, Command.GET_ENCODER_ESTIMATES)
    return BusFollower(settings.bus, estimates, ("ODrive axis", settings.device), taken, joint)
