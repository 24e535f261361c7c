"""A commissioning that is ended while the motor pushes: by STOP, by the end of the service, or killed with it."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest
import tomli_w

from bench.store import Store
from tests.commission.over_rest import Hands, bench, follow, is_over
from tests.devices.device_process import DeviceProcess, device_process
from tests.stopping.bench import ROOT, TOKEN, WATCHDOG_S

OFF_S = 1.0 + 2.0 * WATCHDOG_S  # of a busy machine; a drive that is left alone stops by its watchdog


def is_pushed(found: dict) -> bool:
    """Whether the person has let the motor push."""
    return found["step"] == "push" and found["state"] == "working"


def pushes(device: DeviceProcess) -> None:
    """Wait until the arm moves by the motor: the watchdog has been tried before."""
    end_s, start_rad = time.monotonic() + 60.0, device.truth()["joint"]["rotor_rad"]
    while abs(device.truth()["joint"]["rotor_rad"] - start_rad) < 0.05:
        assert time.monotonic() < end_s, device.truth()
        time.sleep(0.005)


@pytest.mark.timeout(180)
def test_stop_takes_the_power_away_and_ends_the_commissioning(tmp_path):
    with bench(tmp_path, "modbus", "--transport", "tcp") as (service, device):
        service.client.post("/commission").raise_for_status()
        follow(service, Hands(device), is_pushed)
        pushes(device)
        assert service.client.post("/stop", json={"reason": "the arm is caught"}).json()["was_running"]
        asked_s = time.monotonic()
        assert device.wait_for_power(False, OFF_S) - asked_s < OFF_S
        ended = follow(service, Hands(device), is_over)
        assert "the arm is caught" in ended["refusal"]
        [record] = service.store.experiments()
        assert (record.kind, record.outcome) == ("identification", "stopped")
        time.sleep(1.0)
        assert len(service.store.experiments()) == 1  # nothing more was begun
        assert device.truth()["powered"] is False


@contextmanager
def served(folder: Path, device: DeviceProcess) -> Iterator[tuple["subprocess.Popen[bytes]", httpx.Client]]:
    """`friction-bench serve --drive drive.toml` as a program of its own."""
    drive = {name: value for name, value in device.drive.items() if name != "side_channel"}
    (folder / "drive.toml").write_text(tomli_w.dumps({"drive": drive | {"watchdog_s": WATCHDOG_S}}))
    port = 8000 + os.getpid() % 20000
    words = ["--store", str(folder / "bench.sqlite"), "serve", "--drive", str(folder / "drive.toml"), "--port"]
    process = subprocess.Popen(
        [sys.executable, "-m", "bench.cli", *words, str(port)],
        cwd=ROOT, env=os.environ | {"FRICTION_BENCH_TOKEN": TOKEN}, stdout=subprocess.DEVNULL,
    )  # fmt: skip
    headers = {"Authorization": f"Bearer {TOKEN}"}
    try:
        with httpx.Client(base_url=f"http://127.0.0.1:{port}/api/v1", headers=headers, timeout=60.0) as client:
            _wait_until_up(process, client)
            yield process, client
    finally:
        process.kill()
        process.wait()


def _wait_until_up(process: "subprocess.Popen[bytes]", client: httpx.Client) -> None:
    end_s = time.monotonic() + 60.0
    while time.monotonic() < end_s:
        assert process.poll() is None
        try:
            client.get("/token")
            return
        except httpx.TransportError:
            time.sleep(0.05)
    raise AssertionError("the service did not start")


class Client:
    """What `follow` needs of a service."""

    def __init__(self, client: httpx.Client) -> None:
        self.client = client


@pytest.mark.timeout(180)
@pytest.mark.parametrize("by", [signal.SIGKILL, signal.SIGTERM], ids=["killed", "ended"])
def test_a_service_that_is_gone_leaves_the_joint_without_power(tmp_path, by):
    with (
        device_process("modbus", "--transport", "tcp", "--patience", "0.02") as device,
        served(tmp_path, device) as (process, client),
    ):
        client.post("/commission").raise_for_status()
        follow(Client(client), Hands(device), is_pushed)
        pushes(device)
        process.send_signal(by)
        gone_s = time.monotonic()
        assert device.wait_for_power(False, OFF_S) - gone_s < OFF_S
        process.wait(30.0)
        with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as store:
            end_s = time.monotonic() + 30.0
            while store.experiments()[0].outcome == "running" and time.monotonic() < end_s:
                time.sleep(0.05)
            [record] = store.experiments()
        assert record.outcome in ("stopped", "interrupted")
        assert device.truth()["powered"] is False


class Forgetful(Hands):
    """Let go of the arm where it was held level."""

    def do(self, key: str, sentence: str) -> float | None:
        if key != "clear":
            return super().do(key, sentence)
        self._side.ask("release")
        return None


@pytest.mark.timeout(180)
def test_an_arm_that_was_left_raised_is_not_pushed(tmp_path):
    with bench(tmp_path, "modbus", "--transport", "tcp") as (service, device):
        service.client.post("/commission").raise_for_status()
        ended = follow(service, Forgetful(device), is_over)
        assert "the arm stands at 90 degrees" in ended["refusal"]
        assert service.store.experiments() == []
