"""Settings of a CiA 402 drive on a CAN bus."""

from typing import Literal

from bench.config.drives.real import RealDriveSettings
from bench.config.quantities import quantity
from bench.config.rig import Section
from drivers.can_bus.settings import Bitrate, Options
from drivers.canopen.parameters import CanopenParameters


class CanopenBus(Section):
    """How the bus is reached."""

    interface: str = quantity(
        ...,
        "",
        "How the bus is reached, by python-can's name: socketcan (Linux network interface), slcan (serial adapter), "
        "socketcand (TCP server), pcan, kvaser, gs_usb, udp_multicast ..., virtual (inside one process)",
        min_length=1,
    )
    channel: str = quantity(..., "", "can0, /dev/ttyACM0, PCAN_USBBUS1, or the bus's name at the server", min_length=1)
    bitrate: Bitrate = quantity(1_000_000, "bit/s", "Bit rate of the bus")
    host: str = quantity("localhost", "", "Host of the socketcand server")
    port: int = quantity(29536, "", "Port of the socketcand server", ge=1, le=65535)
    tty_baudrate: int = quantity(
        115200, "bit/s", "Baud rate of the serial line of an slcan adapter; ignored on USB", ge=9600
    )
    adapter_start_s: float = quantity(0.0, "s", "What an slcan adapter needs after its port is opened", ge=0, le=10)
    options: Options = quantity({}, "", "What else the interface takes, as python-can's documentation of it says")


class CanopenDriveSettings(CanopenParameters, CanopenBus, RealDriveSettings):
    """One drive on a CAN bus, over CANopen with the CiA 402 profile."""

    kind: Literal["canopen"]
    tpdo_mapping: dict[str, list[int]] = quantity(
        {},
        "",
        "For `record`: entries of the TPDOs that another master has set up (0x60640020), by COB-ID ('0x185')",
    )
