"""RobStride's own package `robstride-dynamics`: its parameters, its frames, and it turns the simulated actuator."""

import time
from contextlib import contextmanager

import can
import pytest
from hypothesis import given
from hypothesis import strategies as st
from robstride_dynamics import Motor, ParameterType, RobstrideBus, table
from robstride_dynamics import protocol as foreign

from drivers.can_bus.port import EXTENDED
from drivers.robstride import protocol
from drivers.robstride.protocol import Kind, Parameter
from sim_backend.devices.mit.serve import MitSimulation, serve_mit
from sim_backend.devices.robstride.motor import RobstrideMotor

RS02 = protocol.MODELS["RS02"]
# their table has other ranges than the manuals of RS00, RS03, RS05 and RS06
AS_THE_MANUALS = ("RS01", "RS02", "RS04")


class Kept:
    """A bus that keeps what was sent."""

    def __init__(self):
        self.frames = []

    def send(self, message):
        self.frames.append((message.arbitration_id, bytes(message.data)))


@contextmanager
def peer(bus, model="rs-02", motor_id=127):
    made = RobstrideBus("a bus of ours", {"joint": Motor(motor_id, model)})
    made.channel_handler = bus
    made.host_id = protocol.HOST
    yield made
    made.channel_handler = None  # else it says good-bye where it is forgotten


@pytest.mark.parametrize("model", AS_THE_MANUALS)
def test_ranges_are_the_same_data(model):
    name, ours = f"rs-{model[2:]}", protocol.MODELS[model]
    assert ours.position_rad == pytest.approx(table.MODEL_MIT_POSITION_TABLE[name], abs=0.01)
    assert ours[1:] == (
        table.MODEL_MIT_VELOCITY_TABLE[name], table.MODEL_MIT_TORQUE_TABLE[name], table.MODEL_MIT_KD_TABLE[name],
    )  # fmt: skip


def test_kinds_and_parameters():
    names = {"IDENTIFY": "GET_DEVICE_ID", "COMMAND": "OPERATION_CONTROL", "FEEDBACK": "OPERATION_STATUS",
             "ENABLE": "ENABLE", "STOP": "DISABLE", "READ": "READ_PARAMETER", "WRITE": "WRITE_PARAMETER"}  # fmt: skip
    for kind in Kind:
        assert getattr(foreign.CommunicationType, names[kind.name]) == kind
    parameters = {"RUN_MODE": "MODE", "TORQUE_LIMIT": "TORQUE_LIMIT", "POSITION": "MECHANICAL_POSITION",
                  "SUPPLY": "VBUS", "TIMEOUT": "CAN_TIMEOUT"}  # fmt: skip
    for parameter in Parameter:
        assert getattr(ParameterType, parameters[parameter.name])[0] == parameter


@given(st.floats(-17.0, 17.0), st.floats(0.0, 5.0))
def test_commands_are_the_same_within_a_step(torque_n_m, damping):
    """They cut a number where it is rounded here, and count one step less from the middle."""
    bus = Kept()
    with peer(bus) as made:
        made.write_operation_frame("joint", 0.0, 0.0, damping, 0.0, torque_n_m)
    theirs_id, theirs = bus.frames[-1]
    ours_id, ours = protocol.command(127, RS02, torque_n_m, damping)
    assert ours_id & ~EXTENDED & 0xFF0000FF == theirs_id & 0xFF0000FF
    assert abs((ours_id >> 8 & 0xFFFF) - (theirs_id >> 8 & 0xFFFF)) <= 2
    for start in range(0, 8, 2):
        one, other = (int.from_bytes(data[start : start + 2], "big") for data in (ours, theirs))
        assert abs(one - other) <= 2


def test_enable_and_stop_are_the_same():
    bus = Kept()
    with peer(bus) as made:
        for call, kind in (("ENABLE", Kind.ENABLE), ("DISABLE", Kind.STOP)):
            made.transmit(getattr(foreign.CommunicationType, call), made.host_id, 127)
            identifier, data = protocol.frame(kind, 127)
            assert bus.frames[-1] == (identifier & ~EXTENDED, data)


def test_the_package_turns_the_simulated_actuator():
    settings = MitSimulation(interface="virtual", channel="robstride-peer", motor_id=127, ranges=RS02[:3])
    bus = can.Bus(interface="virtual", channel="robstride-peer")
    with serve_mit(RobstrideMotor, settings), peer(bus) as made:
        assert made.ping_by_id(127, 1.0) is not None
        assert made.read("joint", ParameterType.VBUS) == pytest.approx(24.0, abs=0.2)
        made.write("joint", ParameterType.CAN_TIMEOUT, 20_000)
        assert made.read("joint", ParameterType.CAN_TIMEOUT) == 20_000
        made.enable("joint")
        made.write_operation_frame("joint", 0.0, 0.0, 0.0)
        before, _, _, _ = made.read_operation_frame("joint")
        for _ in range(20):
            made.write_operation_frame("joint", 0.0, 0.0, 0.0, 0.0, 0.015)
            position, speed, torque, temperature = made.read_operation_frame("joint")
            time.sleep(0.01)
        made.disable("joint")
    bus.shutdown()
    assert position - before > 0.2
    assert speed > 1.0
    assert torque == pytest.approx(0.015, abs=0.003)
    assert 15.0 < temperature < 45.0
