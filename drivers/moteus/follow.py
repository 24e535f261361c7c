"""A moteus controller that another host drives on a CAN-FD bus: its answers to that host are heard."""

from drivers.actuator.reading import Reading
from drivers.can_bus.follower import BusFollower
from drivers.can_bus.port import EXTENDED, CanPort, Heard
from drivers.can_bus.settings import BusSettings
from drivers.joint import JointScale
from drivers.moteus.can_line import answer_id
from drivers.moteus.frames import part_of_state, reading_of


def follow(bus: BusSettings, servo_id: int, joint: JointScale) -> BusFollower:
    """Listen to it. What the other host does not ask for is not told.

    Args:
        bus: how it is reached.
        servo_id: of the controller.
        joint: scales and signs.

    Raises:
        DriveConnectionError: the bus does not open.
    """

    def taken(_port: CanPort, heard: Heard) -> Reading | None:
        found = part_of_state(heard.data)
        return None if found is None else reading_of(found, joint.counts_per_turn, heard.at_s)

    names = "moteus controller", f"{bus} servo {servo_id}"
    return BusFollower(bus, answer_id(servo_id), names, taken, joint, state_bits=EXTENDED)
