"""Buses that several actuators of this process share."""

from collections.abc import Callable
from typing import TypeVar

from drivers.actuator.open_buses import OpenBuses
from drivers.can_bus.port import CanPort
from drivers.can_bus.settings import BusSettings

MadeT = TypeVar("MadeT")
_PORTS: OpenBuses[CanPort] = OpenBuses()


def on_bus(settings: BusSettings, make: Callable[[CanPort, Callable[[], None]], MadeT]) -> MadeT:
    """An actuator on a bus, which is opened where no other actuator has it open.

    Args:
        settings: how the bus is reached.
        make: makes the actuator of the port and of what gives the port back.

    Raises:
        DriveError: the bus does not open, or the actuator cannot be opened; the port is given back then.
    """
    key = settings.interface, str(settings)
    port = _PORTS.enter(key, lambda: CanPort(settings))
    try:
        return make(port, lambda: _PORTS.leave(key))
    except BaseException:
        _PORTS.leave(key)
        raise
