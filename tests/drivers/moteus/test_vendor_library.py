"""mjbots' library `moteus`: the lines as it makes and reads them, and it turns the simulated controllers."""

import asyncio
import math

import moteus
import pytest
from hypothesis import given
from hypothesis import strategies as st
from moteus import fdcanusb_device as foreign
from moteus.fdcanusb_device import FdcanusbDevice

from drivers.moteus import text
from sim_backend.devices.moteus.serve import MoteusBusSettings, serve_moteus


@given(st.binary(max_size=64))
def test_checksums_are_the_same(data):
    assert text.crc8(data) == foreign._compute_crc8(data)


@given(st.binary(min_size=1, max_size=64), st.integers(0, 0xFFFF))
def test_lines_are_the_same_but_for_the_case_of_digits(data, can_id):
    class Kept:
        def write(self, line):
            self.line = line

    device = object.__new__(FdcanusbDevice)
    device._serial, device._disable_brs, device._debug_log = Kept(), False, None
    device._padding_hex = "50"
    for device._checksum_active in (False, True):
        frame = foreign.Frame(arbitration_id=can_id, data=data, bitrate_switch=True, is_fd=True)
        asyncio.run(device._write_send_frame(frame))
        ours = text.send_line(can_id, data, device._checksum_active)
        assert _plain(ours) == _plain(device._serial.line)


def _plain(line):
    return line.split(b"*")[0].lower().split()


@given(st.binary(min_size=1, max_size=64))
def test_what_comes_is_read_alike(data):
    line = b"rcv 100 " + data.hex().upper().encode() + b" E B F"
    frame = object.__new__(FdcanusbDevice)._parse_frame(line)
    assert text.received(line, False) == (frame.arbitration_id, frame.data)


@pytest.mark.parametrize("is_uart", [False, True])
def test_the_library_turns_the_simulated_controller(is_uart):
    async def turn(path):
        device = FdcanusbDevice(path)
        device._checksum_active = is_uart
        controller = moteus.Controller(id=2, transport=moteus.Transport([device]))
        await controller.set_stop()
        stream = moteus.Stream(controller, use_flow_control=False)
        mode = await stream.command(b"conf get servo.timeout_mode", allow_any_response=True)
        before = (await controller.query()).values[moteus.Register.POSITION]
        for _ in range(20):
            found = await controller.set_position(
                position=math.nan, velocity=0.0, feedforward_torque=0.015, kp_scale=0.0, kd_scale=0.0,
                watchdog_timeout=0.5, query=True,
            )  # fmt: skip
            await asyncio.sleep(0.01)
        last = found.values
        await controller.set_stop()
        after = (await controller.query()).values
        device.close()
        return mode, before, last, after

    with serve_moteus(MoteusBusSettings(ids=(2,), is_uart=is_uart)) as served:
        mode, before, last, after = asyncio.run(asyncio.wait_for(turn(served.path), 20.0))
    assert mode == b"12"
    assert last[moteus.Register.MODE] == moteus.Mode.POSITION
    assert last[moteus.Register.TORQUE] == pytest.approx(0.015, abs=0.003)
    assert after[moteus.Register.POSITION] - before > 0.02
    assert after[moteus.Register.MODE] == moteus.Mode.STOPPED
    assert after[moteus.Register.VOLTAGE] == pytest.approx(24.0, abs=0.5)
