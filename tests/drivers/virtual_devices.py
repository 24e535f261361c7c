"""Simulated devices of every kind of servo and actuator, and their wires, in virtual time: how busy the machine is
changes nothing."""

from tests.commission.virtual_time import TIME  # first: the drivers read its clock

# isort: split
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any
from unittest import mock

from sim_backend.devices.cubemars.motor import CubemarsMotor
from sim_backend.devices.damiao.motor import DamiaoMotor
from sim_backend.devices.dynamixel.memory import KINDS as MODELS
from sim_backend.devices.dynamixel.packets import InstructionReader as DynamixelReader
from sim_backend.devices.dynamixel.serve import _MEASURED as DYNAMIXEL
from sim_backend.devices.dynamixel.servo import XServo
from sim_backend.devices.feetech.packets import InstructionReader as FeetechReader
from sim_backend.devices.feetech.serve import _MEASURED as FEETECH
from sim_backend.devices.feetech.servo import StsServo
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.moteus.controller import MoteusController
from sim_backend.devices.moteus.serve import FdcanusbAdapter
from sim_backend.devices.odrive.axis import OdriveAxis
from sim_backend.devices.robstride.motor import RobstrideMotor
from sim_backend.devices.servos.bus import ServoBus
from sim_backend.plant.parameters import PlantParameters
from tests.commission.wires import CanWire, SerialWire, VirtualWire, plugged_in

RANGES = (50.265, 200.0, 0.5)  # 16 bits of the first are steps of 1/4096 turn
WRITTEN = dict(zip(("position_range_rad", "speed_range_rad_s", "torque_range_n_m"), RANGES, strict=True))
USB_BYTE_S = 10.0 / 3e6  # of a line at the pace of an adapter on USB
ON_CAN = {"interface": "slcan", "channel": "virtual"}
Answer = Callable[[bytes, float], bytes]


class Together:
    """Devices on one CAN bus. Loads, faults and truth are the first one's."""

    def __init__(self, devices: Sequence[Any]) -> None:
        self._devices, self.axis, self.node = devices, devices[0].axis, self
        self.send: Callable[[Any], object] = lambda _frame: None

    def boot(self) -> None:
        """Each sends to the same bus."""
        for one in self._devices:
            one.node.send = self.send

    def advance_to(self, time_s: float) -> None:
        for one in self._devices:
            one.advance_to(time_s)

    def receive(self, frame: Any, time_s: float) -> None:
        for one in self._devices:
            one.receive(frame, time_s)

    def report(self) -> dict[str, object]:
        found: dict[str, object] = self._devices[0].report()
        return found


Joint = Callable[..., PlantParameters]
"""Makes a joint, of the tables of what a kind of drive measures."""


def _dynamixel(joint: Joint, count: int) -> Any:
    servos = [XServo(joint(DYNAMIXEL), MODELS["XM430-W350"], 1, seed=1 + place) for place in range(count)]
    for place, servo in enumerate(servos):
        servo.memory.put(20, "i", 1000 * place)  # Homing Offset: no two stand alike
    return ServoBus(servos, DynamixelReader())


def _feetech(joint: Joint, count: int) -> Any:
    first = 0 if count == 1 else 500  # bits to be lost where two answer at once
    servos = [StsServo(joint(FEETECH), 1, 1 + place, first + 1000 * place) for place in range(count)]
    return ServoBus(servos, FeetechReader())


def _moteus(joint: Joint, count: int) -> Any:
    return FdcanusbAdapter([MoteusController(joint(), 1, 1) for _ in range(count)])


def _on_bus(make: Callable[[PlantParameters], Any]) -> Callable[[Joint, int], Any]:
    return lambda joint, count: make(joint()) if count == 1 else Together([make(joint()) for _ in range(count)])


_KINDS: dict[str, tuple[Callable[[Joint, int], Any], dict[str, Any]]] = {
    "dynamixel": (_dynamixel, {"port": "virtual"}),
    "feetech": (_feetech, {"port": "virtual", "accept_no_watchdog": True}),
    "odrive": (
        _on_bus(lambda joint: OdriveAxis(joint, 0, 1.0, 1)),
        ON_CAN | {"watchdog_is_set_in_drive": True, "watchdog_s": 1.0},
    ),
    "damiao": (_on_bus(lambda joint: DamiaoMotor(joint, 1, RANGES, 1)), ON_CAN),
    "cubemars": (
        _on_bus(lambda joint: CubemarsMotor(joint, 1, RANGES, 1)),
        ON_CAN | WRITTEN | {"accept_no_watchdog": True},
    ),
    "robstride": (_on_bus(lambda joint: RobstrideMotor(joint, 127, RANGES, 1)), ON_CAN | WRITTEN),
    "moteus": (_moteus, {"port": "virtual"}),
}
KINDS = tuple(_KINDS)


def device_of(kind: str, plant: dict[str, Any], count: int = 1) -> tuple[Any, dict[str, Any]]:
    """So many simulated devices of a kind and of one id, and the section that reaches them.

    Raises:
        SystemExit: there is no such kind.
    """
    if kind not in _KINDS:
        raise SystemExit(f"kind '{kind}' is none of {', '.join(KINDS)}")
    make, section = _KINDS[kind]
    return make(lambda measured=None: behind_a_drive("paper", measured, plant), count), section


@contextmanager
def reached(
    wire: VirtualWire,
    section: dict[str, Any],
    can: Callable[[VirtualWire], Any] = CanWire,
    answer: Answer | None = None,
) -> Iterator[None]:
    """While entered, the driver of a section opens the wire.

    Args:
        wire: the device.
        section: that reaches it.
        can: makes the bus of it, where it is on one.
        answer: from the bytes that came to those that go back, where it is on a serial line; None: the device's.
    """
    is_on_can = "interface" in section
    port = can(wire) if is_on_can else SerialWire(wire, answer or wire.device.receive)
    with ExitStack() as stack:
        stack.enter_context(plugged_in(port))
        stack.enter_context(mock.patch("tests.commission.wires._BYTE_S", USB_BYTE_S))
        if is_on_can:
            stack.enter_context(mock.patch("drivers.can_bus.port.open_bus", return_value=port))
        yield


__all__ = ["KINDS", "RANGES", "TIME", "device_of", "reached"]
