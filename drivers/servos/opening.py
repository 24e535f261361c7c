"""What is settled with a servo of any protocol when it is opened: its place on a shared line, and its counts."""

from collections.abc import Callable

from drivers.actuator.open_buses import OpenBuses
from drivers.errors import DriveConfigurationError
from drivers.joint import JointScale
from drivers.servos.actuator import ServoSettings, ServoT
from drivers.servos.bus import ServoBus
from drivers.servos.frames import Frames

_BUSES: OpenBuses[ServoBus] = OpenBuses()  # servos of one line share its port


def on_line(settings: ServoSettings, frames: Frames, make: Callable[[ServoBus, Callable[[], None]], ServoT]) -> ServoT:
    """A servo on a line, which is opened where no other servo has it open.

    Args:
        settings: which servo.
        frames: of the protocol.
        make: makes the servo of its bus and of what gives the bus back.

    Raises:
        DriveError: the port is not there, or the servo cannot be opened; the bus is given back then.
    """
    port, baud_rate, timeout_s = settings.port, settings.baud_rate, settings.answer_timeout_s
    return _BUSES.lend((port, baud_rate), lambda: ServoBus(port, baud_rate, timeout_s, frames), make)


def check_counts(device: str, name: str, counts_per_turn: int, joint: JointScale) -> None:
    """Compare the rig with what a servo counts at its output.

    Raises:
        DriveConfigurationError: the rig says otherwise.
    """
    if joint.counts_per_turn != counts_per_turn:
        raise DriveConfigurationError(
            device,
            f"counts per turn of a {name} are {counts_per_turn} at its output; the rig says "
            f"{joint.counts_per_turn:g}. Set sensor.counts_per_turn to {counts_per_turn}, and gear.ratio to what is "
            "behind the servo (1 where the arm is on its horn)",
        )
