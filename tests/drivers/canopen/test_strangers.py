"""Other hosts on the bus, by what they send."""

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.canopen.cia301.link import BusPort, CanLink
from drivers.canopen.cia301.strangers import Strangers
from drivers.errors import DriveConnectionError

NODE = 5


@pytest.fixture
def link():
    return CanLink(BusPort(BusSettings("virtual", "x")), "x node 5")


@pytest.fixture
def strangers(link):
    return Strangers(link, "x node 5", NODE)


def hear(link, cob_id, data=b""):
    for handler in link.subscribers.get(cob_id, ()):
        handler(cob_id, bytearray(data), 0.0)


@pytest.mark.parametrize(
    ("cob_id", "data", "named"),
    [
        (0x080, b"", "SYNC"),
        (0x000, b"\x01\x05", "NMT commands to this drive"),
        (0x000, b"\x80\x00", "NMT commands to this drive"),
        (0x205, bytes(4), "demands to this drive"),
        (0x605, bytes(8), "SDO requests to this drive"),
    ],
)
def test_what_only_a_host_sends_is_named(link, strangers, cob_id, data, named):
    hear(link, cob_id, data)
    with pytest.raises(DriveConnectionError, match=f"another host.* sends {named}.*End it, then open"):
        strangers.check()
    strangers.forget()
    strangers.check()


def test_what_concerns_other_nodes_is_let_go(link, strangers):
    for cob_id, data in ((0x000, b"\x01\x06"), (0x206, bytes(4)), (0x606, bytes(8)), (0x186, bytes(2))):
        hear(link, cob_id, data)
    hear(link, 0x706, b"\x05")
    strangers.check()


def test_this_host_takes_an_id_that_nobody_uses(link, strangers):
    for number in range(64, 127):
        hear(link, 0x700 + number, b"\x05")
    assert strangers.choose_host_id(None) == 127
    strangers.check()
    hear(link, 0x77F, b"\x05")
    with pytest.raises(DriveConnectionError, match="heartbeats as node 127, the ID of this host"):
        strangers.check()


def test_an_id_that_is_configured_and_used_by_another_is_refused(link, strangers):
    hear(link, 0x77F, b"\x05")
    with pytest.raises(DriveConnectionError, match="another node sends heartbeats as node 127"):
        strangers.choose_host_id(127)


def test_two_drives_of_one_process_have_hosts_of_their_own(link):
    ids = [Strangers(link, "x", NODE).choose_host_id(None) for _ in range(8)]
    assert len(set(ids)) == len(ids)
    assert NODE not in ids
