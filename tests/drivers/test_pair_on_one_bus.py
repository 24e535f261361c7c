"""A bench of two joints whose drives are on one CAN bus: read, run in one loop, cleared of their faults."""

from contextlib import ExitStack

import numpy as np
import pytest

from bench.config.channels import PAIR_RECORDED
from bench.config.configuration import default_configuration, parse_configuration
from bench.control.clock import WallClock
from bench.control.cycle import OFF, Action, PairAction
from bench.control.drive_faults import read_drives
from bench.control.ending import StopRequest
from bench.control.station import make_station
from bench.errors import ConfigurationError
from drivers.contract import Command, Mode
from sim_backend.devices.canopen.serve import CanOpenSettings, serve_canopen
from tests.control.fake_drive import ListSink
from tests.devices.device_process import device_process

VIRTUAL = pytest.mark.virtual_time
PERIOD_S = 0.02
NODES = (5, 6)
REST = Action(Command(Mode.CURRENT, 0.0))
PUSH = Action(Command(Mode.CURRENT, 0.3))


def bench_on(channel: str, master_node: int = NODES[1], **bus):
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    values["control"]["period_s"] = PERIOD_S
    values["limits"]["sample_age_s"] = 1.0
    usual = {"kind": "canopen", "interface": "virtual", "channel": channel, "watchdog_s": 0.4, "answer_s": 0.3} | bus
    values["drive"] = usual | {"node_id": NODES[0]}
    values["master"] = {"drive": usual | {"node_id": master_node}, "limits": {"sample_age_s": 1.0}}
    return parse_configuration(values, "bench.toml")


@pytest.fixture(params=[pytest.param("virtual", marks=VIRTUAL)])
def bench(request):
    channel = request.node.name
    with ExitStack() as stack:
        for node in NODES:
            stack.enter_context(serve_canopen(CanOpenSettings(interface="virtual", channel=channel, node_id=node)))
        yield bench_on(channel)


def test_both_drives_are_read_over_one_bus(bench) -> None:
    assert [(one.joint, one.state) for one in read_drives(bench)] == [("slave", "disabled"), ("master", "disabled")]


def test_two_devices_in_processes_of_their_own_are_on_one_bus() -> None:
    with ExitStack() as stack:
        first = stack.enter_context(device_process("canopen", "--interface", "socketcand"))
        second = ("--interface", "join", "--channel", first.port, "--node", str(NODES[1]))
        stack.enter_context(device_process("canopen", *second))
        host, port = first.port.split(":")
        bench = bench_on("can0", interface="socketcand", host=host, port=int(port))
        assert [one.state for one in read_drives(bench)] == ["disabled", "disabled"]


def push_the_slave(cycles: int):
    yield PairAction(Action(OFF), Action(OFF))
    for _ in range(cycles):
        yield PairAction(PUSH, REST)


def test_a_pair_runs_in_one_loop_over_one_bus(bench) -> None:
    station = make_station(bench, True, WallClock(), lambda _sentence: True)
    sink = ListSink()
    try:
        loop = station.open()
        outcome = loop.run(push_the_slave(25), sink, StopRequest())
    finally:
        station.close()
    assert (outcome.outcome, outcome.cycles) == ("completed", 26), outcome.reason
    rows = dict(zip(PAIR_RECORDED, np.vstack(sink.blocks).T, strict=True))
    assert np.ptp(rows["position_rad"]) > 0.05
    assert np.ptp(rows["master_position_rad"]) < 0.01


def test_two_joints_of_one_drive_are_refused() -> None:
    with pytest.raises(ConfigurationError, match="is the drive of two joints of this bench"):
        make_station(bench_on("nowhere", master_node=NODES[0]), True, WallClock(), lambda _sentence: True)
