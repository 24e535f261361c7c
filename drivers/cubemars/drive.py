"""The drive contract on one CubeMars actuator, and a listener to one that another host drives."""

from collections.abc import Callable
from contextlib import suppress
from math import pi
from time import perf_counter

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.reading import Reading
from drivers.can_bus.follower import BusFollower
from drivers.can_bus.port import CanPort, Heard, on_bus
from drivers.contract import Mode
from drivers.cubemars import protocol
from drivers.cubemars.settings import CubemarsSettings
from drivers.errors import DriveConnectionError, WatchdogError
from drivers.joint import JointScale
from drivers.mit.actuator import NO_CURRENT, MitActuator, chosen_ranges, reading_of
from drivers.mit.frames import DISABLE, ENABLE, Frame, command
from drivers.polled_drive import Identity

_NO_WATCHDOG = (
    "IT HAS NO WATCHDOG that its manual names: where this computer or the cable fails, the motor goes on with the last "
    "torque. Keep a hand at the switch of its supply; where no answer comes the bench repeats power-off three times"
)
_NO_STATE = "it does not say whether its power stage is on: shown is what it was told last"
_OPENING_QUESTIONS = 6


class CubemarsActuator(MitActuator):
    """An actuator, opened: out of its motor mode, which is off.

    Arguments as of `MitActuator`.

    Raises:
        DriveError: at the first step that fails.
    """

    notes: tuple[str, ...] = (_NO_WATCHDOG, _NO_STATE, NO_CURRENT)

    def __init__(self, port: CanPort, settings: CubemarsSettings, joint: JointScale, leave: Callable[[], None]) -> None:
        super().__init__(port, settings, joint, settings.answer_id, leave)
        self._settings = settings
        self.enable, self.disable = (settings.motor_id, ENABLE), (settings.motor_id, DISABLE)
        self.clear = self.disable  # an error goes with its cause
        written = settings.position_range_rad, settings.speed_range_rad_s, settings.torque_range_n_m
        self.ranges = chosen_ranges(self.device, settings.model, protocol.MODELS, written)
        if not settings.accept_no_watchdog:
            raise WatchdogError(
                self.device,
                "it has no watchdog that its manual names: where this computer or the cable fails, the motor goes on "
                "with the last torque. Where you can switch its supply off at once, set drive.accept_no_watchdog = "
                "true",
            )
        name = settings.model or "AK series actuator"
        self.identity = Identity("CubeMars", name, "", "", settings.is_simulated)
        if settings.is_simulated:
            self.notes = (
                *self.notes,
                "it is simulated by what its section says (is_simulated): its frames do not tell",
            )
        self._is_on = False
        self._last: Frame = self.disable
        self.switch_off()
        self.check_alone()
        self.reading(perf_counter())

    def torque_frame(self, torque_n_m: float, damping: float) -> Frame:
        """The frame of a torque."""
        self._last = self._settings.motor_id, command(self.ranges, torque_n_m, damping)
        return self._last

    def question(self) -> Frame:
        """What it was told last, again: the frame that powers off, or the last torque."""
        return self._last

    def switch_on(self, mode: Mode, here: Reading) -> None:
        """Enter motor mode, at a torque of 0."""
        self._is_on = True
        super().switch_on(mode, here)

    def switch_off(self) -> None:
        """Leave motor mode, with a torque of 0 before: it begins the next time with what it was told last."""
        if self._is_on:
            with suppress(DriveConnectionError):
                self.told(self.torque_frame(0.0, 0.0))
        self._last = self.disable
        super().switch_off()
        self._is_on = False

    def addresses(self) -> str:
        """The id, and the identifier of its answers."""
        return f"motor_id ({self._settings.motor_id}), feedback_id ({self.answer_id})"

    def taken(self, heard: Heard, asked_s: float) -> Reading:
        """Feedback in SI."""
        data, motor_id = heard.data, self._settings.motor_id
        if len(data) != 8 or data[0] != motor_id:
            raise DriveConnectionError(
                self.device,
                f"an answer with {len(data)} bytes: {data.hex(' ')}; 8 of motor {motor_id} are wanted. Firmware whose "
                "answers have 6 tells no errors, and is not driven: update it",
            )
        found = protocol.feedback(data, self.ranges)
        return self.in_si(asked_s, found.motion, found.temperature_c, self._is_on and not found.fault, found.fault)


class CubemarsDrive(ActuatorDrive[CubemarsActuator]):
    """One actuator with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it."""

    def __init__(self, settings: CubemarsSettings, joint: JointScale) -> None:
        answer_s = 3 * settings.answer_timeout_s + 0.1
        family = Family(
            settings.device, "CubeMars", CubemarsActuator.modes, "", None, 2 * answer_s, _OPENING_QUESTIONS * answer_s
        )
        super().__init__(
            family,
            joint,
            lambda: on_bus(settings.bus, lambda port, leave: CubemarsActuator(port, settings, joint, leave)),
        )


def follow(settings: CubemarsSettings, joint: JointScale) -> BusFollower:
    """Listen to it.

    Raises:
        DriveError: its ranges are not known, or the bus does not open.
    """
    written = settings.position_range_rad, settings.speed_range_rad_s, settings.torque_range_n_m
    ranges = chosen_ranges(settings.device, settings.model, protocol.MODELS, written)
    counts_rad = joint.counts_per_turn / (2.0 * pi)

    def taken(_port: CanPort, heard: Heard) -> Reading | None:
        # commands have the same identifier; none begins with the id unless its position is at the end of the range
        if len(heard.data) != 8 or heard.data[0] != settings.motor_id:
            return None
        found = protocol.feedback(heard.data, ranges)
        # whether it is powered is not in it: who moves is
        return reading_of(heard.at_s, found.motion, counts_rad, found.temperature_c, not found.fault, found.fault)

    names = f"CubeMars {settings.model or 'AK series actuator'}", settings.device
    return BusFollower(settings.bus, settings.answer_id, names, taken, joint)
