"""The drive contract on one moteus controller, and what listens to one that another host drives."""

from typing import Any

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.reading import Reading
from drivers.can_bus.follower import BusFollower
from drivers.can_bus.port import EXTENDED, CanPort, Heard
from drivers.can_bus.settings import BusSettings
from drivers.contract import Mode
from drivers.errors import DriveConfigurationError
from drivers.joint import JointScale
from drivers.moteus.can_line import answer_id
from drivers.moteus.opening import on_line
from drivers.moteus.settings import MoteusSettings

_MODES = frozenset({Mode.TORQUE})
_OPENING_QUESTIONS = 40  # of its console, mostly
_BEGIN_S = 1.0


class MoteusDrive(ActuatorDrive[Any]):  # of MoteusActuator, which is imported with the library
    """One controller with its joint, by torque. It counts turns of its output; `rig.gear` is what is behind that.

    Raises:
        DriveConfigurationError: the library `moteus` is not installed.
    """

    def __init__(self, settings: MoteusSettings, joint: JointScale) -> None:
        try:
            from drivers.moteus.actuator import MoteusActuator
        except ImportError as error:
            raise DriveConfigurationError(
                settings.device, f"mjbots' library is wanted ({error}): pip install 'friction-bench[moteus]'"
            ) from error
        answer_s = 2 * settings.answer_timeout_s + 0.1
        family = Family(
            settings.device, "mjbots", _MODES, "watchdog", settings.watchdog_s, 2 * answer_s + _BEGIN_S,
            _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(
            family, joint, lambda: on_line(settings, lambda line, leave: MoteusActuator(line, settings, joint, leave))
        )


def follow(bus: BusSettings, servo_id: int, joint: JointScale) -> BusFollower:
    """Listen to its answers to another host, on a CAN-FD bus. What that host does not ask for is not told.

    Raises:
        DriveConnectionError: the bus does not open.
    """
    from drivers.moteus.frames import part_of_state, reading_of

    def taken(_port: CanPort, heard: Heard) -> Reading | None:
        found = part_of_state(heard.data)
        return None if found is None else reading_of(found, joint.counts_per_turn, heard.at_s)

    names = "moteus controller", f"{bus} servo {servo_id}"
    return BusFollower(bus, answer_id(servo_id), names, taken, joint, state_bits=EXTENDED)
