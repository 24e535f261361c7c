"""The package `damiao-motor` beside the driver's and the simulated actuator's frames, and driving the latter."""

import time

import can
import pytest
from damiao_motor.core import motor as foreign
from hypothesis import given
from hypothesis import strategies as st

from drivers.damiao import protocol
from drivers.damiao.protocol import MODELS, Register
from drivers.mit import frames
from drivers.mit.frames import Ranges
from sim_backend.devices.damiao.motor import DamiaoMotor
from sim_backend.devices.mit.serve import MitSimulation, serve_mit

DM4310 = MODELS["DM4310"]


class Sent:
    """A bus that keeps what was sent."""

    def __init__(self):
        self.frames = []

    def send(self, message):
        self.frames.append((message.arbitration_id, bytes(message.data)))


def other(bus=None, kind="4310"):
    return foreign.DaMiaoMotor(1, 0x11, bus, motor_type=kind)


def test_ranges_of_the_models_are_the_same_data():
    theirs = {f"DM{name}": limits for name, limits in foreign.MOTOR_TYPE_PRESETS.items()}
    shared = MODELS.keys() & theirs.keys()
    assert len(shared) >= 10
    for name in shared:
        found = theirs[name]
        assert MODELS[name][:3] == pytest.approx((found["p_max"], found["v_max"], found["t_max"]))


@given(st.floats(-10.0, 10.0), st.floats(0.0, 5.0))
def test_commands_are_the_same_within_a_step(torque_n_m, damping):
    """They cut a number where it is rounded here: the last bit of each may differ."""
    bus = Sent()
    other(bus).send_cmd_mit(0.0, 0.0, 0.0, damping, torque_n_m)
    ours = int.from_bytes(frames.command(DM4310, torque_n_m, damping), "big")
    theirs = int.from_bytes(bus.frames[-1][1], "big")
    for shift, bits in ((48, 16), (36, 12), (24, 12), (12, 12), (0, 12)):
        mask = (1 << bits) - 1
        assert abs((ours >> shift & mask) - (theirs >> shift & mask)) <= 1


def test_the_special_frames_and_the_registers():
    motor = other()
    assert motor.encode_enable_msg() == frames.ENABLE
    assert motor.encode_disable_msg() == frames.DISABLE
    assert motor.encode_clear_error_msg() == frames.CLEAR_ERRORS
    names = {"TIMEOUT": "TIMEOUT", "CONTROL_MODE": "CTRL_MODE", "SOFTWARE": "sw_ver", "POSITION_RANGE": "PMAX",
             "SPEED_RANGE": "VMAX", "TORQUE_RANGE": "TMAX"}  # fmt: skip
    for register in Register:
        assert foreign.REGISTER_TABLE[register].variable == names[register.name]


@given(st.integers(0, 0xFFFF), st.integers(0, 0xFFF), st.integers(0, 0xFFF), st.sampled_from([0, 1, 9, 13]))
def test_answers_are_read_alike(position, speed, torque, state):
    word = (state << 4 | 1) << 56 | position << 40 | speed << 28 | torque << 16 | 30 << 8 | 40
    data = word.to_bytes(8, "big")
    theirs, ours = other().decode_sensor_feedback(data), protocol.feedback(data, DM4310)
    assert ours.motion.position_rad == pytest.approx(theirs["pos"], abs=1e-9)
    assert ours.motion.speed_rad_s == pytest.approx(theirs["vel"], abs=1e-9)
    assert ours.motion.torque_n_m == pytest.approx(theirs["torq"], abs=1e-9)
    assert ours.state == theirs["status_code"]
    assert ours.temperature_c == 40


def test_the_package_turns_the_simulated_actuator():
    ranges = (100.0, 200.0, 0.5)
    with serve_mit(DamiaoMotor, MitSimulation(interface="virtual", channel="damiao-peer", ranges=ranges)):
        bus = can.Bus(interface="virtual", channel="damiao-peer")
        motor = foreign.DaMiaoMotor(
            1, 0x11, bus, motor_type="4310", p_min=-ranges[0], p_max=ranges[0], v_min=-ranges[1], v_max=ranges[1],
            t_min=-ranges[2], t_max=ranges[2],
        )  # fmt: skip

        def heard():
            message = bus.recv(1.0)
            assert message is not None
            assert message.arbitration_id == 0x11
            return bytes(message.data)

        motor.request_register_reading(23)
        assert protocol.FLOAT.unpack(heard()[4:])[0] == pytest.approx(0.5)
        motor.enable()
        before = motor.decode_sensor_feedback(heard())
        for _ in range(20):
            motor.send_cmd_mit(0.0, 0.0, 0.0, 0.0, 0.015)
            last = motor.decode_sensor_feedback(heard())
            time.sleep(0.01)
        motor.disable()
        assert motor.decode_sensor_feedback(heard())["status"] == "DISABLED"
        bus.shutdown()
    assert last["status"] == "ENABLED"
    assert last["pos"] - before["pos"] > 0.2
    assert last["torq"] == pytest.approx(0.015, abs=0.003)


def test_the_largest_numbers_are_the_range():
    ranges = Ranges(12.5, 30.0, 10.0)
    assert frames.command(ranges, 10.0)[-2:] == b"\x0f\xff"
    assert frames.command(ranges, -10.0)[-2:] == b"\x00\x00"
