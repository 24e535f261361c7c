"""DFKI's `mini-cheetah-motor-driver-socketcan` beside the driver's frames: T-Motor, whose AK series is CubeMars' now.

It knows SocketCAN alone, which is not there; its frames are taken without their socket.
"""

from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st
from motor_driver import canmotorlib as foreign

from drivers.cubemars import protocol
from drivers.mit import frames
from sim_backend.devices.can.frame import Frame
from sim_backend.devices.cubemars.motor import CubemarsMotor
from sim_backend.devices.joint_tables import behind_a_drive

AK10_9 = protocol.MODELS["AK10-9"]
SAME = {"AK10-9": foreign.AK10_9_V1p1_PARAMS, "AK80-6": foreign.AK80_6_V2_PARAMS}


class Caught(foreign.CanMotorController):
    """Its controller, with a line that keeps what is sent, and answers with what a simulated actuator says."""

    def __init__(self, motor=None):
        self.sent, self._motor, self._answers = [], motor, []
        if motor is not None:
            motor.node.send = self._answers.append
        super().__init__("vcan-that-is-not-there", 1, "AK10_9_V1p1")
        self.motorParams = foreign.AK10_9_V1p1_PARAMS | {"AXIS_DIRECTION": 1}

    def _send_can_frame(self, data):
        self.sent.append(data)
        if self._motor is not None:
            self._motor.receive(Frame(1, data), 0.0)

    def _recv_can_frame(self):
        return 1, 8, self._answers[-1].data if self._answers else bytes(8)


@pytest.mark.parametrize("model", SAME)
def test_ranges_are_the_same_data(model):
    theirs = SAME[model]
    assert protocol.MODELS[model] == (theirs["P_MAX"], theirs["V_MAX"], theirs["T_MAX"], theirs["KD_MAX"])


@given(st.floats(-65.0, 65.0), st.floats(0.0, 5.0))
def test_commands_are_the_same_within_a_step(torque_n_m, damping):
    """They cut a number where it is rounded here: the last bit of each may differ."""
    peer = Caught()
    with suppress(Exception):
        peer.send_rad_command(0.0, 0.0, 0.0, damping, torque_n_m)
    ours = int.from_bytes(frames.command(AK10_9, torque_n_m, damping), "big")
    theirs = int.from_bytes(peer.sent[-1], "big")
    for shift, bits in ((48, 16), (36, 12), (24, 12), (12, 12), (0, 12)):
        mask = (1 << bits) - 1
        assert abs((ours >> shift & mask) - (theirs >> shift & mask)) <= 1


def test_it_turns_the_simulated_actuator():
    motor = CubemarsMotor(behind_a_drive("paper", None, {}), 1, AK10_9[:3])
    peer = Caught(motor)
    motor.receive(Frame(1, frames.ENABLE), 0.0)
    before, _, _ = peer.send_rad_command(0.0, 0.0, 0.0, 0.0, 0.0)
    for step in range(1, 31):
        motor.advance_to(0.01 * step)
        after, speed, torque = peer.send_rad_command(0.0, 0.0, 0.0, 0.0, 0.05)
    assert after - before > 0.1
    assert speed > 0.5
    assert torque == pytest.approx(0.05, abs=0.04)  # a step of its frame is 32 mN m
    motor.receive(Frame(1, frames.DISABLE), 0.0)
    assert motor.report()["is_on"] is False
