"""The CiA 402 drive under somebody else's master: canopen's network and BaseNode402, over three transports."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import canopen
import pytest
from canopen.profiles.p402 import BaseNode402

from sim_backend.devices.canopen.serve import CanOpenSettings, data_sheet, serve_canopen
from sim_backend.devices.side_channel_client import SideChannelClient
from tests.devices.device_process import device_process

NODE = 5
MASTER = 0x7F
LONGEST_S = 5.0


@contextmanager
def _virtual() -> Iterator[tuple[dict[str, object], SideChannelClient]]:
    with serve_canopen(CanOpenSettings(interface="virtual", channel="masters")) as device:
        side = SideChannelClient(device.side_channel)
        yield {"interface": "virtual", "channel": "masters"}, side
        side.close()


@contextmanager
def _slcan() -> Iterator[tuple[dict[str, object], SideChannelClient]]:
    with device_process("canopen") as device:
        yield {
            "interface": "slcan", "channel": device.port, "bitrate": 1_000_000, "sleep_after_open": 0.0,
        }, device.side  # fmt: skip


@contextmanager
def _socketcand() -> Iterator[tuple[dict[str, object], SideChannelClient]]:
    with device_process("canopen", "--interface", "socketcand") as device:
        host, port = device.port.split(":")
        yield {"interface": "socketcand", "host": host, "port": int(port), "channel": "can0"}, device.side


class Bench:
    """A network with the drive on it."""

    def __init__(self, network: canopen.Network, node: BaseNode402, side: SideChannelClient) -> None:
        self.network, self.node, self.side = network, node, side

    def wait(self, true: Callable[[], bool], what: str) -> None:
        """Wait for something to come true."""
        end_s = time.monotonic() + LONGEST_S
        while not true():
            assert time.monotonic() < end_s, f"{what}: not within {LONGEST_S:g} s"
            time.sleep(0.005)


@pytest.fixture(scope="module", params=[_virtual, _slcan, _socketcand], ids=["virtual", "slcan", "socketcand"])
def bench(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    eds = tmp_path_factory.mktemp("eds") / "drive.eds"
    Path(eds).write_text(data_sheet("generic"))
    with request.param() as (bus, side):
        network = canopen.Network()
        network.NOTIFIER_CYCLE = 0.1
        network.connect(**bus)
        node = BaseNode402(NODE, str(eds))
        network.add_node(node)
        node.sdo.RESPONSE_TIMEOUT = LONGEST_S
        for limit in ("CHECK_TPDO", "RESET_FAULT", "SWITCH_OP_MODE", "SWITCH_STATE_SINGLE", "SWITCH_STATE_FINAL"):
            setattr(node, f"TIMEOUT_{limit}", LONGEST_S)  # the library's own are of a host that is never busy
        yield Bench(network, node, side)
        network.disconnect()


@pytest.fixture(autouse=True)
def fresh(bench: Bench) -> Iterator[None]:
    """A drive after a reset, mapped and operational."""
    node = bench.node
    bench.side.ask("repair")
    _reset(bench)
    tpdo = node.tpdo[1]
    tpdo.clear()
    tpdo.add_variable(0x6041)
    tpdo.add_variable(0x6061)
    tpdo.add_variable(0x6064)
    tpdo.cob_id, tpdo.trans_type, tpdo.event_timer, tpdo.enabled = 0x180 + NODE, 255, 50, True
    tpdo.inhibit_time = 200  # 20 ms: python-can reads slcan byte by byte, a busy machine is slower than the motor
    tpdo.save()
    rpdo = node.rpdo[1]
    rpdo.clear()
    rpdo.add_variable(0x6040)
    rpdo.add_variable(0x6060)
    rpdo.cob_id, rpdo.trans_type, rpdo.enabled = 0x200 + NODE, 255, True
    rpdo.save()
    node.setup_402_state_machine()
    node.nmt.state = "OPERATIONAL"
    yield
    _reset(bench)


def _reset(bench: Bench) -> None:
    """Not canopen's wait_for_bootup: it misses a boot-up that comes before it looks."""
    booted = _arrivals(bench, 0x700 + NODE)
    bench.node.nmt.send_command(0x81)
    bench.wait(lambda: bool(booted), "boot-up")


def _arrivals(bench: Bench, can_id: int) -> list[float]:
    """A list that grows with the frames of an identifier."""
    arrived: list[float] = []
    bench.network.subscribe(can_id, lambda _can_id, _data, time_s: arrived.append(time_s))
    return arrived


def test_texts_and_identity_come_whole(bench: Bench) -> None:
    assert bench.node.sdo[0x1008].raw == "friction-bench CiA 402 drive, simulated"
    assert bench.node.sdo[0x1000].raw == 0x00020192


def test_refusal_has_its_abort_code(bench: Bench) -> None:
    with pytest.raises(canopen.SdoAbortedError) as aborted:
        bench.node.sdo[0x6502].raw = 1
    assert aborted.value.code == 0x06010002


def test_master_enables_moves_and_disables(bench: Bench) -> None:
    node = bench.node
    node.op_mode = "PROFILED POSITION"
    node.state = "OPERATION ENABLED"
    assert bench.side.ask("truth")["powered"]
    node.sdo[0x607A].raw = 10_000
    node.controlword = 0x1F
    bench.wait(lambda: node.statusword & 0x1000 != 0, "set point acknowledged")
    bench.wait(lambda: node.statusword & 0x0400 != 0, "target reached")
    bench.wait(lambda: abs(node.sdo[0x6064].raw - 10_000) < 200, "motor at the target")
    node.state = "SWITCH ON DISABLED"
    assert not bench.side.ask("truth")["powered"]


def test_modes_that_the_drive_has_not_are_refused(bench: Bench) -> None:
    assert not bench.node.is_op_mode_supported("HOMING")
    assert bench.node.is_op_mode_supported("CYCLIC SYNCHRONOUS TORQUE")


def test_torque_comes_with_each_sync(bench: Bench) -> None:
    node = bench.node
    node.nmt.state = "PRE-OPERATIONAL"
    rpdo = node.rpdo[2]
    rpdo.clear()
    rpdo.add_variable(0x6071)
    rpdo.cob_id, rpdo.trans_type, rpdo.enabled = 0x300 + NODE, 1, True
    rpdo.save()
    tpdo = node.tpdo[2]
    tpdo.clear()
    tpdo.add_variable(0x606C)
    tpdo.cob_id, tpdo.trans_type, tpdo.enabled = 0x280 + NODE, 1, True
    tpdo.save()
    arrived = _arrivals(bench, 0x280 + NODE)
    node.nmt.state = "OPERATIONAL"
    node.op_mode = "CYCLIC SYNCHRONOUS TORQUE"
    node.state = "OPERATION ENABLED"
    rpdo[0x6071].raw = 500
    rpdo.transmit()
    for number in range(1, 51):
        bench.network.sync.transmit()
        bench.wait(lambda wanted=number: len(arrived) == wanted, "a TPDO for the SYNC")  # type: ignore[misc]
    bench.wait(lambda: node.sdo[0x606C].raw > 10_000, "motor turning")
    node.state = "QUICK STOP ACTIVE"
    bench.wait(lambda: not bench.side.ask("truth")["powered"], "power off after the quick stop")


def test_fault_comes_as_an_emergency_and_is_reset(bench: Bench) -> None:
    node = bench.node
    before = len(node.emcy.log)
    node.op_mode = "CYCLIC SYNCHRONOUS TORQUE"
    node.state = "OPERATION ENABLED"
    bench.side.ask("fault", name="over-current", duration_s=0.2)
    bench.wait(lambda: len(node.emcy.log) > before, "an emergency")
    assert node.emcy.log[-1].code == 0x2310
    bench.wait(lambda: node.state == "FAULT", "state FAULT")
    time.sleep(0.3)
    node.controlword = 0x00
    node.controlword = 0x80
    bench.wait(lambda: node.state == "SWITCH ON DISABLED", "fault reset")
    bench.wait(lambda: node.emcy.log[-1].code == 0, "the emergency taken back")


@pytest.mark.parametrize("beats", [1, 5])
def test_heartbeat_of_the_master_that_ends_stops_the_motor(bench: Bench, beats: int) -> None:
    node = bench.node
    node.sdo[0x6007].raw = 2
    node.sdo[0x1016][1].raw = MASTER << 16 | 200
    node.op_mode = "CYCLIC SYNCHRONOUS TORQUE"
    node.state = "OPERATION ENABLED"
    beaten_s = []
    for _ in range(beats):
        beaten_s.append(time.monotonic())
        bench.network.send_message(0x700 + MASTER, b"\x05")
        time.sleep(0.05)
    bench.wait(lambda: not bench.side.ask("truth")["powered"], "power off")
    off_s = bench.side.ask("truth")["powered_since_monotonic_s"]
    # a machine with other work lets the master pause, and the drive hear late: not sooner than after the first
    assert off_s - beaten_s[0] > 0.15
    assert off_s - max(at_s for at_s in beaten_s if at_s < off_s) < 0.6


def test_a_thousand_syncs_bring_a_thousand_samples(bench: Bench) -> None:
    node = bench.node
    node.nmt.state = "PRE-OPERATIONAL"
    tpdo = node.tpdo[2]
    tpdo.clear()
    tpdo.add_variable(0x6064)
    tpdo.cob_id, tpdo.trans_type, tpdo.enabled = 0x280 + NODE, 1, True
    tpdo.save()
    arrived = _arrivals(bench, 0x280 + NODE)
    node.nmt.state = "OPERATIONAL"
    for _ in range(1000):
        bench.network.sync.transmit()
        time.sleep(0.001)
    bench.wait(lambda: len(arrived) >= 1000, "all samples")
    assert len(arrived) == 1000


def test_absent_node_is_silence(bench: Bench) -> None:
    stranger = canopen.RemoteNode(NODE + 1, canopen.ObjectDictionary())
    bench.network.add_node(stranger)
    with pytest.raises(canopen.SdoCommunicationError):
        stranger.sdo.upload(0x1000, 0)
    del bench.network[NODE + 1]
