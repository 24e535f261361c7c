import itertools
from math import pi

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.canopen.drive import CanopenDrive
from drivers.canopen.settings import CanopenSettings
from drivers.joint import JointScale
from tests.drivers.canopen.node_double import NodeDouble

COUNT_RAD = 2 * pi / (4096 * 20)
JOINT = JointScale(4096, 20.0, zero_rad=1000 * COUNT_RAD)
_NUMBERS = itertools.count()


@pytest.fixture
def channel():
    return f"canopen-{next(_NUMBERS)}"


@pytest.fixture
def node(channel):
    with NodeDouble(channel) as double:
        yield double


@pytest.fixture
def settings_of(channel):
    def make(**changes) -> CanopenSettings:
        told = {"node_id": 5, "host_node_id": 127, "listen_s": 0.02} | changes
        return CanopenSettings(bus=BusSettings("virtual", channel), **told)

    return make


@pytest.fixture
def drive_of(settings_of):
    drives = []

    def make(joint=JOINT, **changes) -> CanopenDrive:
        drives.append(CanopenDrive(settings_of(**changes), joint))
        return drives[-1]

    yield make
    for drive in drives:
        drive.close()
