"""The drive contract on one Dynamixel, and on one that another program moves."""

from collections.abc import Callable
from math import nan
from pathlib import Path
from struct import Struct
from time import sleep

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.reading import Reading
from drivers.contract import Mode
from drivers.dynamixel import control_table as table
from drivers.dynamixel import opening
from drivers.dynamixel.frames import PROTOCOL_2, REBOOT, packet
from drivers.dynamixel.opening import MODELS, Model
from drivers.dynamixel.settings import DynamixelSettings
from drivers.errors import DriveConnectionError
from drivers.joint import JointScale
from drivers.serial_latency import latency_note
from drivers.servos.actuator import ServoActuator
from drivers.servos.bus import ServoBus
from drivers.servos.frames import Item, error_names
from drivers.servos.opening import check_counts, on_line
from drivers.servos.relay import ServoFollower, asked_model
from drivers.wraps import DriveClock

_MODES = {
    Mode.DUTY: (table.PWM_MODE, table.GOAL_PWM),
    Mode.CURRENT: (table.CURRENT_MODE, table.GOAL_CURRENT),
    Mode.POSITION: (table.POSITION_MODE, table.GOAL_POSITION),
}
_REBOOT_S, _REBOOT_TRIES = 0.1, 20
_WATCHDOG_FAULT = "its bus watchdog has stopped it: nothing was heard for too long"
_OPENING_QUESTIONS = 2 * len(table.GATHERED) + 12
_CLEARING_S = 4.0  # of `clear_fault`

# read where the maker has put it, as nothing is written to a servo that another program moves: Present PWM, Current,
# Velocity, Position; two trajectories; Input Voltage, Temperature
_PIECE = Item(124, 23, "what it measures")
_LAYOUT = Struct("<hhii8xHB")


class DynamixelActuator(ServoActuator):
    """A servo, opened: off, its watchdog set.

    Raises:
        DriveError: at the first step that fails.
    """

    torque_enable = table.TORQUE_ENABLE

    def __init__(
        self, bus: ServoBus, settings: DynamixelSettings, joint: JointScale, leave: Callable[[], None]
    ) -> None:
        super().__init__(bus, settings.servo_id, leave)
        self._settings = settings
        self._clock = DriveClock(table.TICK_S, table.TICK_BITS)
        self.model, firmware, self.identity = opening.identify(bus, settings, joint)
        self.piece = Item(self.model.indirect_data(firmware), table.LAYOUT.size, "what it measures")
        self._settle()
        self.notes = latency_note(settings.port, lambda: self._word(table.TORQUE_ENABLE)) + self._current_note()

    @property
    def modes(self) -> frozenset[Mode]:
        """That the model has."""
        return frozenset(_MODES) - (frozenset({Mode.CURRENT}) if self.model.current_a is None else frozenset())

    @property
    def measured(self) -> frozenset[str]:
        """Names of the `Sample` fields that are measured."""
        always = {"time_s", "position_rad", "velocity_rad_s", "duty", "supply_v", "temperature_c"}
        return frozenset(always | ({"current_a"} if self.model.current_a is not None else set()))

    @property
    def steps(self) -> dict[str, float]:
        """Smallest step of each quantity."""
        found = {
            "position_rad": 1.0,
            "velocity_rad_s": table.COUNTS_S,
            "duty": 1.0 / table.DUTY_FULL,
            "supply_v": table.SUPPLY_V,
            "temperature_c": 1.0,
        }
        return found if self.model.current_a is None else found | {"current_a": self.model.current_a}

    def switch_on(self, mode: Mode, here: Reading) -> None:
        """Choose the mode, which can be done with the power off alone, and power the stage at a goal of rest."""
        number, _ = _MODES[mode]
        self._write(table.TORQUE_ENABLE, 0)
        if self._word(table.OPERATING_MODE) != number:
            self._write(table.OPERATING_MODE, number)
        self._write(table.BUS_WATCHDOG, 0)
        self._write(table.BUS_WATCHDOG, self._settings.watchdog_steps)
        self._mode = mode
        rest = here.counts if mode is Mode.POSITION else 0.0
        self._write_goal(mode, rest)
        self._write(table.TORQUE_ENABLE, 1)
        self._write_goal(mode, rest)  # of firmware that forgets it with the change of mode

    def goal(self, mode: Mode, value: float) -> tuple[int, bytes]:
        """Where a demand goes, and its bytes."""
        item = _MODES[mode][1]
        return item.address, self._raw(mode, value).to_bytes(item.size, "little", signed=True)

    def reading(self, data: bytes, asked_s: float) -> Reading:
        """The piece in SI."""
        pwm, current, velocity, position, is_on, error, watchdog, tick, supply, temperature = table.LAYOUT.unpack(data)
        fault = error_names(error, table.ERRORS)
        if watchdog == table.WATCHDOG_TRIPPED:
            fault = fault or _WATCHDOG_FAULT
        return Reading(
            asked_s, position, velocity * table.COUNTS_S, pwm / table.DUTY_FULL,
            nan if self.model.current_a is None else current * self.model.current_a, nan,
            supply * table.SUPPLY_V, temperature, bool(is_on), fault, self._clock.follow(tick * table.TICK_S),
        )  # fmt: skip

    def clear_fault(self) -> None:
        """Clear the bus watchdog; a hardware error is cleared by a reboot alone, after which all is settled anew."""
        self._write(table.BUS_WATCHDOG, 0)
        if self._word(table.HARDWARE_ERROR):
            self.bus.instruct(self.servo_id, packet(self.servo_id, REBOOT), "reboot")
            self._wait_for_reboot()
        self._settle()

    def _settle(self) -> None:
        """Everything that a reboot forgets."""
        opening.switch_off(self.bus, self._settings)
        opening.set_current_limit(self.bus, self._settings, self.model)
        opening.set_watchdog(self.bus, self._settings)
        opening.gather(self.bus, self._settings)
        self.bus.begin()

    def _wait_for_reboot(self) -> None:
        for attempt in range(_REBOOT_TRIES):
            sleep(_REBOOT_S)
            self.bus.begin()
            try:
                self._word(table.TORQUE_ENABLE)
            except DriveConnectionError:
                if attempt + 1 == _REBOOT_TRIES:
                    raise
            else:
                return

    def _raw(self, mode: Mode, value: float) -> int:
        """A demand in steps of its item."""
        if mode is Mode.DUTY:
            return round(value * table.DUTY_FULL)
        if mode is Mode.CURRENT and self.model.current_a is not None:
            return round(value / self.model.current_a)
        return round(value)

    def _current_note(self) -> tuple[str, ...]:
        if self.model.current_a is not None:
            return ()
        return (f"a {self.model.name} measures no current: the bench takes it from duty and speed, eq. (3)",)


class DynamixelDrive(ActuatorDrive[DynamixelActuator]):
    """One servo with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it."""

    def __init__(self, settings: DynamixelSettings, joint: JointScale) -> None:
        answer_s = ServoBus.longest_call_s(settings.answer_timeout_s)
        family = Family(
            settings.device, "ROBOTIS", frozenset(_MODES), "bus watchdog", settings.set_watchdog_s,
            answer_s + _CLEARING_S, _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(
            family,
            joint,
            lambda: on_line(settings, PROTOCOL_2, lambda bus, leave: DynamixelActuator(bus, settings, joint, leave)),
        )


def follow(settings: DynamixelSettings, joint: JointScale, link: Path, period_s: float) -> ServoFollower:
    """Stand between another program, which opens the port `link`, and the servo: a look each `period_s`, at least.

    Raises:
        DriveError: the port is not there or in use, nobody answers, or it is another servo than the rig's.
    """
    model = asked_model(settings, PROTOCOL_2, table.MODEL_NUMBER, MODELS)
    check_counts(settings.device, model.name, table.COUNTS_PER_TURN, joint)
    return ServoFollower(
        settings, PROTOCOL_2, _PIECE, link, period_s, f"ROBOTIS {model.name}",
        lambda data, asked_s: _reading(data, asked_s, model), joint,
    )  # fmt: skip


def _reading(data: bytes, asked_s: float, model: Model) -> Reading:
    """The piece in SI. Whether it is powered is not in it: who moves is."""
    pwm, current, velocity, position, supply, temperature = _LAYOUT.unpack(data)
    return Reading(
        asked_s, position, velocity * table.COUNTS_S, pwm / table.DUTY_FULL,
        nan if model.current_a is None else current * model.current_a, nan,
        supply * table.SUPPLY_V, temperature, True,
    )  # fmt: skip
