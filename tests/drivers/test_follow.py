"""A servo that a vendor's own library moves, recorded from between: its words pass, ours go into its pauses."""

import json
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from itertools import count

import dynamixel_sdk as dynamixel
import numpy as np
import pytest
import scservo_sdk as feetech
import tomli_w

from bench.control.servo import current_servo
from bench.errors import ConfigurationError
from bench.runs.follow import follower_of, pass_on, record
from bench.store import Store
from tests.devices.device_process import device_process
from tests.devices.turns import no_turns
from tests.drivers.conformance.benches import configured

PERIOD_S = 0.02  # of the other program, as of LeRobot's teleoperation with 50 Hz
LOOK_S = 0.01


def be_patient(port):
    """Open a port of a vendor's library, which waits 16 ms for an answer, and polls: a busy machine needs longer."""
    port.openPort()
    port.ser.timeout = 0.001
    port.setPacketTimeout = lambda _bytes: port.setPacketTimeoutMillis(2000.0)


class FeetechProgram:
    """What LeRobot does: a position for each servo in one write, its position in one read."""

    def __init__(self, path):
        self.port = feetech.PortHandler(path)
        be_patient(self.port)
        self.host = feetech.sms_sts(self.port)
        self.goals = feetech.GroupSyncWrite(self.host, 44, 2)
        self.found = feetech.GroupSyncRead(self.host, 56, 2)
        self.found.addParam(1)
        for address, value in ((40, 0), (55, 0), (33, 2), (55, 1), (40, 1)):  # open loop, on
            assert self.host.write1ByteTxRx(1, address, value)[0] == 0

    def cycle(self, push):
        word = round(200 * push) if push >= 0 else round(-200 * push) | 1 << 10
        self.goals.clearParam()
        self.goals.addParam(1, [word & 0xFF, word >> 8])
        self.goals.txPacket()
        return self.found.txRxPacket() == 0

    def close(self):
        self.host.write1ByteTxRx(1, 40, 0)
        self.port.closePort()


class DynamixelProgram:
    """The same with ROBOTIS' library."""

    def __init__(self, path):
        self.port, self.host = dynamixel.PortHandler(path), dynamixel.PacketHandler(2.0)
        be_patient(self.port)
        self.goals = dynamixel.GroupSyncWrite(self.port, self.host, 100, 2)
        self.found = dynamixel.GroupSyncRead(self.port, self.host, 132, 4)
        self.found.addParam(1)
        for address, value in ((64, 0), (11, 16), (98, 25)):  # off, PWM, a bus watchdog of 0.5 s
            assert self.host.write1ByteTxRx(self.port, 1, address, value)[0] == 0
        # a change of mode sets the goal to full PWM, which would be driven until the first cycle
        assert self.host.write2ByteTxRx(self.port, 1, 100, 0)[0] == 0
        assert self.host.write1ByteTxRx(self.port, 1, 64, 1)[0] == 0

    def cycle(self, push):
        self.goals.clearParam()
        self.goals.addParam(1, list(round(177 * push).to_bytes(2, "little", signed=True)))
        self.goals.txPacket()
        return self.found.txRxPacket() == 0

    def close(self):
        self.host.write1ByteTxRx(self.port, 1, 64, 0)
        self.port.closePort()


PROGRAMS = {"feetech": FeetechProgram, "dynamixel": DynamixelProgram}


@contextmanager
def followed(kind, tmp_path):
    with device_process(kind, "--baud", "0") as device:
        configuration = configured(**device.drive | {"answer_timeout_s": 0.3})
        follower = follower_of(configuration, tmp_path / "servo.port", LOOK_S)
        try:
            yield device, configuration, follower
        finally:
            follower.close()


def swing(program, cycles, failed):
    """Push to and fro, as another program would."""
    for number in range(cycles):
        if not program.cycle(1.0 if number // 15 % 2 == 0 else -1.0):
            failed.append(number)
        time.sleep(PERIOD_S)


@pytest.mark.parametrize("kind", PROGRAMS)
def test_what_it_moves_is_recorded_and_it_notices_nothing(kind, tmp_path):
    failed = []

    def other_program():
        program = PROGRAMS[kind](str(tmp_path / "servo.port"))
        swing(program, 100, failed)
        program.close()

    with followed(kind, tmp_path) as (device, configuration, follower):
        thread = threading.Thread(target=other_program)
        thread.start()
        recording = record(follower, configuration, "swing", {"load_kg": 0.0}, 1.5, lambda: False)
        pass_on(follower, lambda: False)
        thread.join()
        assert not device.truth()["powered"]
    assert failed == []
    found = recording.channels
    assert len(recording) > 40
    assert found["time_s"][-1] == pytest.approx(1.5, abs=0.4)
    assert np.ptp(found["position_rad"]) > 0.05
    assert found["duty"].max() == pytest.approx(0.2, abs=0.01)
    assert found["duty"].min() == pytest.approx(-0.2, abs=0.01)
    # velocity added up, not position differentiated: a busy machine hears a frame some milliseconds late
    mean_rad_s = (found["velocity_rad_s"][1:] + found["velocity_rad_s"][:-1]) / 2.0
    moved = np.cumsum(mean_rad_s * np.diff(found["time_s"]))
    assert np.corrcoef(moved, found["position_rad"][1:])[0, 1] > 0.95
    assert np.polyfit(moved, found["position_rad"][1:], 1)[0] == pytest.approx(1.0, abs=0.2)
    assert np.isfinite(found["supply_v"]).all()
    assert current_servo(configuration.rig) is None or "current_estimate_a" in found


def test_the_silence_of_who_commands_is_not_filled(tmp_path):
    """A question of ours would feed the bus watchdog, and the motor go on without its program."""
    with followed("dynamixel", tmp_path) as (device, _, follower):
        stop = threading.Event()

        def look():
            while not stop.is_set():
                follower.look(0.01)

        thread = threading.Thread(target=look)
        thread.start()
        program = DynamixelProgram(str(tmp_path / "servo.port"))
        swing(program, 10, [])
        device.wait_for_power(True)
        silent_s = time.monotonic()
        assert (
            device.wait_for_power(False) - silent_s < 1.2
        )  # its 0.5 s, and the 0.2 s in which it still counts as there
        stop.set()
        thread.join()


def test_a_program_that_never_comes_is_said_so(tmp_path):
    looks = count()
    with (
        followed("feetech", tmp_path) as (_, configuration, follower),
        pytest.raises(ConfigurationError, match="Let the other program open"),
    ):
        record(follower, configuration, "nothing", {}, 1.0, lambda: next(looks) > 3)
    assert not (tmp_path / "servo.port").is_symlink()


def test_a_kind_that_cannot_be_followed_names_those_that_can(tmp_path):
    with pytest.raises(ConfigurationError, match=r"odrive, robstride can\. A ROS 2 bag"):
        follower_of(configured(kind="roboclaw", port="/dev/absent"), tmp_path / "servo.port", LOOK_S)


def test_the_command_keeps_it_in_the_store(tmp_path):
    with device_process("feetech", "--baud", "0") as device:
        configuration = configured(**device.drive | {"answer_timeout_s": 0.3})
        file, url = tmp_path / "bench.toml", f"sqlite:///{tmp_path / 'bench.sqlite'}"
        file.write_text(tomli_w.dumps(configuration.model_dump(mode="json", exclude_none=True)))
        offered = tmp_path / "servo.port"
        words = [sys.executable, "-m", "bench.cli", "--config", str(file), "--store", url, "record", "--json"]
        with no_turns():
            command = subprocess.Popen(
                [*words, "--offer", str(offered), "--seconds", "0.5", "--load-kg", "0.05"], stdout=subprocess.PIPE
            )
        end_s = time.monotonic() + 30.0
        while not offered.is_symlink():
            assert time.monotonic() < end_s
            time.sleep(0.05)
        program = FeetechProgram(str(offered))
        swing(program, 60, [])
        program.close()
        output, _ = command.communicate(timeout=30.0)
        assert command.returncode == 0
        assert not device.truth()["powered"]
    with Store.open(url) as store:
        found = store.experiment(json.loads(output)["experiment_id"])
        [trial] = store.trials(found.id)
    assert (found.source, found.parameters["moved_by"]) == ("imported", "another program")
    assert trial.conditions == {"load_kg": 0.05}
    assert trial.rows == json.loads(output)["rows"] > 5
