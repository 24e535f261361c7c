"""Time that waits for a late host."""

import socket
import threading
from types import SimpleNamespace

import pytest

from bench.cli.operation import simulate_device
from bench.config.drives.registry import drive_kind
from bench.drives.device import PATIENT_LIMITS
from sim_backend.devices import wall_time
from sim_backend.devices.canopen.serve import CanOpenSettings, serve_canopen
from sim_backend.devices.modbus.serve import ModbusSettings, serve_modbus
from sim_backend.devices.roboclaw.serve import RoboClawSettings, serve_roboclaw
from sim_backend.devices.wall_time import HOST_IS_GONE_S, HOST_LISTENS_S, PatientTime


@pytest.fixture
def wall(monkeypatch):
    now = SimpleNamespace(s=1000.0)
    monkeypatch.setattr(wall_time.time, "monotonic", lambda: now.s)
    return now


def axis(on=True, velocity_rad_s=0.0):
    return SimpleNamespace(power=SimpleNamespace(on=on), seen=SimpleNamespace(velocity_rad_s=velocity_rad_s))


def pass_time(clock, wall, seconds, looks=50):
    """As the ticker does: look many times."""
    for _ in range(looks):
        wall.s += seconds / looks
        clock.now_s()
    return clock.now_s()


def test_time_goes_as_far_as_the_host_was_late_and_no_further_than_patience(wall):
    clock = PatientTime(axis(), 0.02)
    assert pass_time(clock, wall, 0.4) == pytest.approx(0.02)
    clock.hear()
    assert pass_time(clock, wall, 0.01) == pytest.approx(0.03)
    assert pass_time(clock, wall, 0.4) == pytest.approx(0.04)


def test_a_process_that_was_itself_late_goes_no_further_either(wall):
    clock = PatientTime(axis(), 0.02)
    wall.s += 0.4
    clock.hear()  # before anybody looked
    assert clock.now_s() == pytest.approx(0.02)


@pytest.mark.parametrize(("joint", "after_s"), [(axis(False), 0.2), (axis(False, 0.1), 0.02), (axis(), 0.02)])
def test_it_waits_while_something_is_at_work(wall, joint, after_s):
    assert pass_time(PatientTime(joint, 0.02), wall, 0.2) == pytest.approx(after_s)


@pytest.mark.parametrize(("joint", "longest_s"), [(axis(), HOST_IS_GONE_S), (axis(False, 0.1), HOST_LISTENS_S)])
def test_a_host_that_is_gone_is_not_waited_for(wall, joint, longest_s):
    clock = PatientTime(joint, 0.02)
    assert pass_time(clock, wall, longest_s + 1.0, looks=400) == pytest.approx(1.02, abs=0.02)


def test_the_moment_of_the_axis_is_told_by_the_wall(wall):
    clock = PatientTime(axis(), 0.02)
    pass_time(clock, wall, 0.5)
    assert clock.origin_s + clock.now_s() == pytest.approx(wall.s)


def serve(kind):
    match kind:
        case "roboclaw":
            return serve_roboclaw(RoboClawSettings(patience_s=0.02))
        case "canopen":
            return serve_canopen(CanOpenSettings(patience_s=0.02))
        case _:
            return serve_modbus(ModbusSettings(transport=kind, patience_s=0.02))


@pytest.mark.parametrize("kind", ["roboclaw", "canopen", "rtu", "tcp"])
def test_a_word_of_the_host_is_heard_on_every_wire(monkeypatch, kind):
    heard = threading.Event()
    monkeypatch.setattr(PatientTime, "hear", lambda _clock: heard.set())
    with serve(kind) as device:
        assert not heard.wait(0.05)
        if kind == "tcp":
            host, port = device.path.split(":")
            with socket.create_connection((host, int(port))) as wire:
                wire.sendall(b"\r")
                assert heard.wait(5.0)
        else:
            with open(device.path, "r+b", buffering=0) as wire:
                wire.write(b"\r")
                assert heard.wait(5.0)


@pytest.mark.parametrize(
    ("words", "limits"),
    [
        (("roboclaw", "--patience", "0.02"), {"watchdog_s": 1.0, "answer_timeout_s": 0.3}),
        (("modbus", "--patience", "0.02"), {"watchdog_s": 1.0, "answer_timeout_s": 0.3}),
        (("canopen", "--patience", "0.02"), {"watchdog_s": 1.0, "answer_s": 0.3}),
        (("feetech", "--patience", "0.02"), {"answer_timeout_s": 0.3}),  # it has no watchdog
        (("odrive", "--watchdog", "0.5", "--patience", "0.02"), {"watchdog_s": 0.5, "answer_timeout_s": 0.3}),
        (("roboclaw",), {}),
    ],
)
def test_the_section_has_the_time_limits_for_its_patience(monkeypatch, words, limits):
    started = []
    monkeypatch.setattr(simulate_device, "_serve", lambda simulated, _json: started.append(simulated))
    simulate_device._command(simulate_device._kinds()[words[0]]).main(list(words[1:]), standalone_mode=False)
    with started[0].device:
        drive = started[0].drive
    assert {name: drive[name] for name in PATIENT_LIMITS if name in drive} == limits
    drive_kind(words[0]).settings.model_validate(drive)
