"""`pytest -p tests.virtual.plugin`: drivers and simulated devices in one process, in virtual time.

It is `make test-virtual`. The tests are the same as in real time. There each device is a process of its own, behind a
port of the operating system, with threads; here it is brought to the present whenever its driver or a test looks.
"""

from tests.commission.virtual_time import TIME, VirtualThread  # first: the drivers read its clock

# isort: split
from importlib import import_module
from typing import Any

from sim_backend.devices import side_channel_client
from tests.devices import device_process
from tests.virtual import buses, ports, side

side_channel_client.SideChannelClient = side.SideClient  # type: ignore[assignment, misc]  # before others import it
device_process.IS_VIRTUAL = True
device_process.Thread = VirtualThread

_REPLACED: dict[str, Any] = {
    "sim_backend.devices.process.Ticker": side.NoThread,
    "sim_backend.devices.process.SideChannel": side.Side,
    "sim_backend.devices.link.serial_port.SerialPort": ports.VirtualPort,
    "sim_backend.devices.can.ports.SlcanPort": ports.VirtualSlcanPort,
    "sim_backend.devices.can.ports.BusPort": buses.bus_port,
    "sim_backend.devices.modbus.serve._ServedPort": ports.rtu_port,
    "serial.Serial": ports.VirtualSerial,
    "serial.serial_for_url": ports.VirtualSerial,
    "can.bus.time": TIME.now,  # with which python-can waits for a frame
    "drivers.can_bus.bus.os": ports.OS,
    "drivers.can_bus.bus.select": ports.SELECT,
    "drivers.host_time.processor_wait_s": lambda: 0.0,  # of real time
}
for _name, _value in _REPLACED.items():
    _module, _, _attribute = _name.rpartition(".")
    setattr(import_module(_module), _attribute, _value)
buses.install()

from bench.control.clock import WallClock  # noqa: E402
from tests.virtual.device import virtual_device  # noqa: E402

WallClock.patience_s = 30.0  # virtual time waits for the store, as that of a drive in process does
device_process.device_process = virtual_device
