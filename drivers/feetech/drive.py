"""The drive contract on one Feetech servo, and on one that another program moves."""

from collections.abc import Callable
from pathlib import Path

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.reading import Reading
from drivers.contract import Mode
from drivers.errors import DriveConfigurationError, WatchdogError
from drivers.feetech import memory
from drivers.feetech.frames import SCS, with_sign
from drivers.feetech.memory import reading_of
from drivers.feetech.settings import FeetechSettings
from drivers.joint import JointScale
from drivers.polled_drive import Identity
from drivers.serial_latency import latency_note
from drivers.servos.actuator import ServoActuator
from drivers.servos.bus import ServoBus
from drivers.servos.opening import check_counts, on_line
from drivers.servos.relay import ServoFollower, asked_model
from drivers.wraps import Turns

_MODES = {Mode.DUTY: memory.OPEN_LOOP_MODE, Mode.POSITION: memory.POSITION_MODE}
_NO_WATCHDOG = (
    "IT HAS NO WATCHDOG: where this computer or the cable fails, the motor goes on with the last demand. Keep a hand "
    "at the switch of its supply; where no answer comes the bench repeats power-off three times, and "
    "drive.torque_limit bounds what the motor can do meanwhile"
)
SIMULATED_FIRMWARE = 0xFFFF  # of our own simulated device
_OPENING_QUESTIONS = 10


class FeetechActuator(ServoActuator):
    """A servo, opened: off, its torque limited.

    Raises:
        DriveError: at the first step that fails.
    """

    piece = memory.PIECE
    torque_enable = memory.TORQUE_ENABLE
    modes = frozenset(_MODES)
    measured = frozenset({"time_s", "position_rad", "velocity_rad_s", "duty", "current_a", "supply_v", "temperature_c"})

    def __init__(self, bus: ServoBus, settings: FeetechSettings, joint: JointScale, leave: Callable[[], None]) -> None:
        super().__init__(bus, settings.servo_id, leave)
        self._settings = settings
        self._turns = Turns(memory.COUNTS_PER_TURN)
        bus.begin()
        self.identity = self._identify(joint)
        self.clear_fault()
        self._limit_torque()
        self._ends = self._read_ends()
        self.notes = (_NO_WATCHDOG, *latency_note(settings.port, lambda: self._word(memory.TORQUE_ENABLE)))

    @property
    def steps(self) -> dict[str, float]:
        """Smallest step of each quantity."""
        return {
            "position_rad": 1.0, "velocity_rad_s": 1.0, "duty": 1.0 / memory.DUTY_FULL,
            "current_a": memory.CURRENT_A, "supply_v": memory.SUPPLY_V, "temperature_c": 1.0,
        }  # fmt: skip

    def switch_on(self, mode: Mode, here: Reading) -> None:
        """Choose the mode, and power the stage at a goal of rest."""
        self._write(memory.TORQUE_ENABLE, 0)
        if self._word(memory.OPERATING_MODE) != _MODES[mode]:
            self._choose(mode)
        self._mode = mode
        self._write_goal(mode, here.counts if mode is Mode.POSITION else 0.0)
        self._write(memory.TORQUE_ENABLE, 1)

    def goal(self, mode: Mode, value: float) -> tuple[int, bytes]:
        """Where a demand goes, and its bytes.

        Raises:
            DriveConfigurationError: a position outside the servo's one turn, or its own limits.
        """
        if mode is Mode.DUTY:
            word = with_sign(round(value * memory.DUTY_FULL), memory.DUTY_SIGN)
            return memory.GOAL_DUTY.address, word.to_bytes(2, "little")
        counts, (low, high) = round(value), self._ends
        if not low <= counts <= high:
            raise DriveConfigurationError(
                self._settings.device,
                f"a position of {counts} counts was demanded; in position mode a servo knows one turn, this one "
                f"{low} .. {high} of it. Use duty, change drive.zero_rad, or the limits in its memory (9, 11)",
            )
        return memory.GOAL_POSITION.address, counts.to_bytes(2, "little") + bytes(4)

    def reading(self, data: bytes, asked_s: float) -> Reading:
        """The piece in SI."""
        return reading_of(data, asked_s, self._turns)

    def clear_fault(self) -> None:
        """Power off: a servo forgets its errors where their cause is gone."""
        self._write(memory.TORQUE_ENABLE, 0)

    def _identify(self, joint: JointScale) -> Identity:
        device = self._settings.device
        number = self._word(memory.MODEL_NUMBER)
        name = memory.MODELS.get(number)
        if name is None:
            known = ", ".join(f"{one} ({model})" for one, model in memory.MODELS.items())
            raise DriveConfigurationError(device, f"its model number is {number}; known are {known}. Check drive.port")
        check_counts(device, name, memory.COUNTS_PER_TURN, joint)
        if not self._settings.accept_no_watchdog:
            raise WatchdogError(
                device,
                f"a {name} has no watchdog: where this computer or the cable fails, the motor goes on with the last "
                "demand. Where you can switch its supply off at once, set drive.accept_no_watchdog = true",
            )
        version = self._word(memory.FIRMWARE)
        return Identity("Feetech", name, f"{version & 0xFF}.{version >> 8}", "", version == SIMULATED_FIRMWARE)

    def _choose(self, mode: Mode) -> None:
        """Change the mode, in the part of the memory that stays beyond power-off."""
        wanted = _MODES[mode]
        self._write(memory.LOCK, 0)
        self._write(memory.OPERATING_MODE, wanted)
        self._write(memory.LOCK, 1)
        found = self._word(memory.OPERATING_MODE)
        if found != wanted:
            raise DriveConfigurationError(
                self._settings.device,
                f"its operating mode reads back as {found}, set was {wanted} ({mode.value} mode): it was refused",
            )

    def _read_ends(self) -> tuple[int, int]:
        """The positions to which the servo goes: it would stop there, and tell nobody. 0 and 0 are no limits."""
        low, high = self._word(memory.LOWEST), self._word(memory.HIGHEST)
        return (low, high) if low < high else (0, memory.COUNTS_PER_TURN - 1)

    def _limit_torque(self) -> None:
        """Raises `DriveConfigurationError` where it does not read back."""
        wanted = round(self._settings.torque_limit * memory.DUTY_FULL)
        self.bus.begin()
        self._write(memory.TORQUE_LIMIT, wanted)
        found = self._word(memory.TORQUE_LIMIT)
        if found != wanted:
            raise DriveConfigurationError(
                self._settings.device, f"its torque limit reads back as {found}, set was {wanted}; choose another"
            )


class FeetechDrive(ActuatorDrive[FeetechActuator]):
    """One servo with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it."""

    def __init__(self, settings: FeetechSettings, joint: JointScale) -> None:
        answer_s = ServoBus.longest_call_s(settings.answer_timeout_s)
        family = Family(
            settings.device, "Feetech", FeetechActuator.modes, "", None, answer_s, _OPENING_QUESTIONS * answer_s
        )
        super().__init__(
            family,
            joint,
            lambda: on_line(settings, SCS, lambda bus, leave: FeetechActuator(bus, settings, joint, leave)),
        )


def follow(settings: FeetechSettings, joint: JointScale, link: Path, period_s: float) -> ServoFollower:
    """Stand between another program, which opens the port `link`, and the servo: a look each `period_s`, at least.

    Raises:
        DriveError: the port is not there or in use, nobody answers, or it is another servo than the rig's.
    """
    name = asked_model(settings, SCS, memory.MODEL_NUMBER, memory.MODELS)
    check_counts(settings.device, name, memory.COUNTS_PER_TURN, joint)
    turns = Turns(memory.COUNTS_PER_TURN)
    return ServoFollower(
        settings, SCS, memory.PIECE, link, period_s, f"Feetech {name}",
        lambda data, asked_s: reading_of(data, asked_s, turns), joint,
    )  # fmt: skip
