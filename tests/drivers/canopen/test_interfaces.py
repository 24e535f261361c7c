"""Any interface of python-can, by its name."""

import time

import can
import pytest

from drivers.can_bus.settings import BusSettings
from drivers.canopen.cia301.link import BusPort, CanLink
from drivers.canopen.drive import CanopenDrive
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConfigurationError, DriveConnectionError
from sim_backend.devices.canopen.serve import CanOpenSettings, serve_canopen
from tests.drivers.canopen.conftest import JOINT

GROUP = "239.74.163.41"


@pytest.mark.parametrize(
    ("bus", "arguments"),
    [
        (BusSettings("pcan", "PCAN_USBBUS1", 500_000), {"channel": "PCAN_USBBUS1", "bitrate": 500_000}),
        (BusSettings("kvaser", "0"), {"channel": 0, "bitrate": 1_000_000}),
        (BusSettings("gs_usb", "0", options={"index": 0}), {"channel": 0, "bitrate": 1_000_000, "index": 0}),
        (BusSettings("socketcan", "can0"), {"channel": "can0"}),
        (BusSettings("udp_multicast", GROUP), {"channel": GROUP}),
        (BusSettings("virtual", "7"), {"channel": "7"}),
    ],
)
def test_an_interface_gets_what_it_takes(bus, arguments):
    CanopenSettings(bus=bus, node_id=5)
    assert bus.arguments() == {"interface": bus.interface, "ignore_config": True} | arguments


def test_an_interface_that_python_can_does_not_know_is_refused_with_those_that_it_knows():
    with pytest.raises(
        DriveConfigurationError, match=r"interface = 'pcann': one of .*kvaser.*pcan.*vector.* is wanted"
    ):
        CanopenSettings(bus=BusSettings("pcann", "PCAN_USBBUS1"), node_id=5)


def test_an_adapter_whose_driver_is_missing_is_said_so():
    drive = CanopenDrive(CanopenSettings(bus=BusSettings("kvaser", "0"), node_id=5), JOINT)
    with pytest.raises(DriveConnectionError, match=r"the bus kvaser 0 does not open.*its driver installed"):
        drive.open(0.005)


def _multicast_works() -> bool:
    try:
        bus = can.Bus(interface="udp_multicast", channel=GROUP, hop_limit=0, ignore_config=True)
    except (OSError, can.CanError):
        return False
    bus.shutdown()
    return True


@pytest.mark.skipif(not _multicast_works(), reason="no IP multicast on this machine")
def test_a_bus_that_hands_back_its_own_frames_has_no_stranger_on_it():
    with serve_canopen(CanOpenSettings(interface="udp_multicast", channel=GROUP)):
        bus = BusSettings("udp_multicast", GROUP, options={"hop_limit": 0})
        drive = CanopenDrive(CanopenSettings(bus=bus, node_id=5, watchdog_s=0.6, answer_s=0.4), JOINT)
        try:
            drive.open(0.005)
            drive.enable(Mode.CURRENT)
            start_rad = drive.exchange(Command(Mode.CURRENT, 0.3)).position_rad
            for _ in range(40):
                sample = drive.exchange(Command(Mode.CURRENT, 0.3))
                time.sleep(0.005)
            assert sample.status is Status.ENABLED
            assert sample.position_rad - start_rad > 0.01
        finally:
            drive.close()


def test_of_two_equal_frames_one_is_the_echo_and_the_other_a_strangers():
    port = BusPort(BusSettings("udp_multicast", GROUP))
    link = CanLink(port, "x node 5")
    heard = []
    link.subscribe(0x80, lambda *_frame: heard.append(1))

    class Bus:
        """Hands back what is sent, once more than it was sent."""

        def __init__(self):
            self.waiting = []

        def send(self, message, _timeout):
            self.waiting += [message, message]

        def recv(self, _timeout):
            return self.waiting.pop(0) if self.waiting else None

    port._bus = Bus()
    link.open()
    link.send_message(0x80, b"")
    link.drain()
    assert len(heard) == 1
