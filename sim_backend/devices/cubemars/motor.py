"""One actuator: takes commands of the MIT protocol, and answers each. Silence does not stop it."""

from sim_backend.devices.can.frame import Frame
from sim_backend.devices.mit.motor import MitMotor
from sim_backend.devices.mit.short_frames import Top, command_of, motion_of
from sim_backend.faults.script import Trip, tripped
from sim_backend.plant.parameters import PlantParameters

HOT, OVER_CURRENT, UNDER_VOLTAGE, ENCODER = 1, 2, 4, 5
_ZERO_C = 40  # of the byte of its temperature


class CubemarsMotor(MitMotor):
    """An actuator that does not say whether its stage is powered.

    Args:
        parameters: the joint.
        motor_id: to which it listens, and with which it answers.
        ranges: of position [rad], speed [rad/s] and torque [N m] in its frames.
        seed: of the plant.
    """

    timeout_s = 0.0

    def __init__(self, parameters: PlantParameters, motor_id: int, ranges: Top, seed: int = 0) -> None:
        super().__init__(parameters, ranges[2], seed)
        self._motor_id, self._top = motor_id, ranges
        self._error = 0

    def take(self, frame: Frame) -> bool:
        """Obey a command."""
        if frame.extended or frame.can_id != self._motor_id:
            return False
        data = frame.data
        if data[:7] == b"\xff" * 7:  # it keeps what it was told last, and begins with that
            match data[7]:
                case 0xFC if not self._error and not self.axis.mode_is_refused():
                    self.is_on = True
                case 0xFD:
                    self.is_on, self._error = False, 0
        elif self.is_on:
            self.command = command_of(data, self._top)
        told = bytes((self._motor_id,)) + motion_of(self, self._top)
        self.node.send(Frame(self._motor_id, told + bytes((round(self.axis.temperature_c) + _ZERO_C, self._error))))
        return True

    def trip(self, cause: Trip | None) -> None:
        """Keep its error."""
        self._error = tripped(cause, HOT, OVER_CURRENT, UNDER_VOLTAGE, ENCODER)

    def lost(self) -> None:
        """Silence does not stop it."""

    def report(self) -> dict[str, object]:
        """Say what the actuator is about."""
        return {"kind": "cubemars", "is_on": self.is_on, "error": self._error, "watchdog_trips": self.watchdog_trips}
