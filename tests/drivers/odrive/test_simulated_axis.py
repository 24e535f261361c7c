"""The simulated axis by itself, asked for what no host asks for."""

from struct import pack, unpack

from drivers.odrive.protocol import Command, can_id
from sim_backend.devices.can.frame import Frame
from sim_backend.devices.odrive.axis import OdriveAxis
from sim_backend.plant import presets


def test_a_torque_beyond_all_measure_is_answered_by_the_current_that_is_the_most():
    axis, sent = OdriveAxis(presets.paper()), []
    axis.node.send = sent.append
    axis.receive(Frame(can_id(0, Command.SET_INPUT_TORQUE), pack("<f", 3e38)), 0.0)
    axis.receive(Frame(can_id(0, Command.GET_IQ), b"", remote=True), 0.0)
    setpoint_a, _ = unpack("<ff", sent[-1].data)
    assert setpoint_a == 20.0
