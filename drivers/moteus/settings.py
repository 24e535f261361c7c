"""What has to be known of a moteus controller before it is opened."""

from typing import Self

from pydantic import model_validator

from drivers.can_bus.settings import BusSettings, Options
from drivers.settings import Settings, quantity


class MoteusSettings(Settings):
    """How to reach one controller."""

    port: str = quantity("", "", "Serial port of the fdcanusb, or of its UART; left out with a CAN-FD bus")
    interface: str = quantity("", "", "Interface of python-can for a CAN-FD bus, in the place of a port")
    channel: str = quantity("", "", "Of the interface: can0, PCAN_USBBUS1")
    options: Options = quantity(
        {}, "", "What else the interface takes, as python-can's documentation of it says: bit rates of CAN-FD"
    )
    servo_id: int = quantity(1, "", "Id of the controller", ge=1, le=126)
    over_uart: bool = quantity(False, "", "true: the port is the controller's own UART, whose lines have checksums")
    watchdog_s: float = quantity(0.2, "s", "Silence after which it stops; goes out with every torque", ge=0.01, le=2)
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for the answers of a cycle", ge=0.002, le=1.0)

    @model_validator(mode="after")
    def _check_place(self) -> Self:
        if bool(self.port) == bool(self.interface and self.channel):
            raise ValueError("either port, or interface and channel are wanted")
        return self

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.place} servo {self.servo_id}"

    @property
    def bus(self) -> BusSettings | None:
        """The CAN-FD bus of python-can that it is on; None with a port."""
        return fd_bus(self.interface, self.channel, self.options) if self.interface else None

    @property
    def place(self) -> str:
        """What it is on."""
        return self.port if self.bus is None else str(self.bus)


def fd_bus(interface: str, channel: str, options: Options) -> BusSettings:
    """A bus whose frames are those of CAN-FD."""
    fd: Options = {"fd": True} if interface == "socketcan" else {}  # others have more to say, or nothing
    return BusSettings(interface, channel, options=fd | options)
