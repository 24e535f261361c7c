"""`python -m tests.commission.over_rest [KIND]`: commission a simulated device over REST, in real time.

Two parties besides the service: a program that knows the interface alone, and the hands of the person at the bench,
which turn the arm and hang the loads at the device. Printed are the answers, the motions, what was found, and the load.
"""

import sys
import tempfile
import time
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import pi
from pathlib import Path
from typing import Any

from bench.commission.drive_section import bench_of
from tests.devices.device_process import DeviceProcess, device_process
from tests.service.running_service import RunningService, running_service

KNOWN = {"arm_length_m": 0.5, "gear_ratio": 50.0, "counts_per_turn": None, "motor_current_a": 2.0, "load_kg": 0.1}
FIRST_KG, FIRST_ALLOWED_KG = 0.05, 2e-3
WATCHDOG_S, ANSWER_S = 1.0, 0.3  # of a machine that is busy with other work
PATIENCE_S = 300.0  # of one step: a busy machine makes a motion three times
WIRING = "[wiring]\nmotor_reversed = true\nencoder_reversed = false\n"


class Hands:
    """The person at the bench, as far as hands go.

    Args:
        device: the simulated device.
    """

    def __init__(self, device: DeviceProcess) -> None:
        self._side = device.side

    def do(self, key: str, sentence: str) -> float | None:
        """Do what is asked; the value to be answered where one is wanted."""
        if key == "down":
            self._side.hang_load(0.0, balanced=False)
            self._side.ask("hold", angle_rad=0.0)
        elif key == "hand_angle_deg":
            self._side.ask("hold", angle_rad=pi / 2.0)
            return 90.0
        elif key == "clear":
            self._side.ask("hold", angle_rad=0.0)
            self._side.ask("release")
        elif key == "first_load_kg":
            self._side.hang_load(FIRST_KG, balanced=False)
            return FIRST_KG
        elif key == "hang":
            words = sentence.split()
            self._side.hang_load(float(words[1]) / 1000.0 if words[0] == "Hang" else 0.0, balanced=False)
        else:
            return KNOWN[key]
        return None


@contextmanager
def bench(folder: Path, kind: str = "roboclaw", *options: str) -> Iterator[tuple[RunningService, DeviceProcess]]:
    """A service with its bench process, on a simulated device whose motor leads are swapped; loads are hung by hand."""
    (folder / "plant.toml").write_text(WIRING if kind == "roboclaw" else "")
    with device_process(kind, "--plant", str(folder / "plant.toml"), "--patience", "0.02", *options) as device:
        answer = "answer_s" if kind == "canopen" else "answer_timeout_s"
        patient = {"watchdog_s": WATCHDOG_S, answer: ANSWER_S}
        drive = {name: value for name, value in device.drive.items() if name != "side_channel"} | patient
        with running_service(folder, configuration=bench_of(drive), in_process_of_its_own=True) as service:
            yield service, device


def follow(service: RunningService, hands: Hands, until: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    """Answer what is asked, until something holds of the state; that state."""
    deadline_s = time.monotonic() + PATIENCE_S
    while True:
        found: dict[str, Any] = service.client.get("/commission").json()
        if until(found):
            return found
        question, prompt = found["question"], found["prompt"]
        if question is not None:
            value = hands.do(question["key"], question["sentence"])
            body = {"question": question["number"], "value": value}
            service.client.post("/commission/answer", json=body).raise_for_status()
        elif prompt is not None:
            hands.do("hang", prompt["sentence"])
            service.client.post("/continue", json={"prompt": prompt["number"]}).raise_for_status()
        else:
            assert time.monotonic() < deadline_s, found
            time.sleep(0.05)
            continue
        deadline_s = time.monotonic() + PATIENCE_S
        print(f"{found['step']:12} {(question or prompt)['sentence']}", flush=True)


def is_over(found: dict[str, Any]) -> bool:
    """Whether nothing more comes."""
    return found["state"] in ("commissioned", "refused")


def main(kind: str = "roboclaw", *options: str) -> int:
    """Commission one; 0 where the first load was found."""
    with tempfile.TemporaryDirectory() as folder, bench(Path(folder), kind, *options) as (service, device):
        begin_s = time.monotonic()
        service.client.post("/commission", json={}).raise_for_status()
        ended = follow(service, Hands(device), is_over)
        took_s = time.monotonic() - begin_s
        print(f"{ended['state']} at {ended['step']} after {took_s:.0f} s: {ended['refusal'] or ended['first_load']}")
        if ended["refusal"]:
            return 1
        tomllib.loads(service.client.get("/commission/bench.toml").text)
        for one in ended["evidence"]:
            print(f"{one['name']:32} {one['value']} {one['unit']} ({one['low']} .. {one['high']}): {one['how']}")
        load = ended["first_load"]
        return int(abs(load["found_kg"] - load["hung_kg"]) > FIRST_ALLOWED_KG)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
