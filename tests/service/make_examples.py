"""The examples in the interface's description: `python -m tests.service.make_examples` asks every route, and keeps
what was answered in bench/service/http/examples.json. To be run again where an answer has changed; a test says where.
"""

import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from bench.evaluation.challenge import difficulty
from bench.evaluation.challenge.difficulty import Difficulty
from bench.service.http.openapi import FILE, key
from tests.queue.waiting import wait_for
from tests.service.recorded_joint import recording_set_zip
from tests.service.running_service import RunningService, running_service

LISTED = 2  # entries of a list that are kept: an example shows a form, not a measurement
FREE = ("configuration", "libraries", "properties")  # of which two entries show enough
STEPS = {"kind": "steps", "parameters": {"repeats": 1}, "pace": "fast", "operator": "Ada", "tags": ["winter"]}
CAMPAIGN = {"name": "loads", "kind": "reversals", "grid": {"load_kg": [0.0, 0.1]}}
EXCITATION = {"loads_kg": [0.0, 0.05, 0.1], "waveforms": ["slow-sine", "multisine"], "duration_s": 6.0, "repeats": 2}
QUICK_CHALLENGE = Difficulty((0.0, 1.0, 0.0), (0.8, 1.0), 0.001, (1.0,), 2.0, 1, 1)


def short(value: Any) -> Any:
    """With the first entries of each list and of what is free in form, and numbers as one reads them."""
    if isinstance(value, dict):
        cut = {name: dict(list(one.items())[:LISTED]) if name in FREE else one for name, one in value.items()}
        return {name: short(one) for name, one in cut.items()}
    if isinstance(value, list):
        return [short(one) for one in value[:LISTED]]
    return float(f"{value:.6g}") if isinstance(value, float) and np.isfinite(value) else value


class Asking:
    """Asks, and keeps the answers.

    Attributes:
        kept: by method and path of the route.
    """

    def __init__(self, service: RunningService) -> None:
        self.kept: dict[str, Any] = {}
        self._client = service.client

    def ask(self, route: str, json: Any = None, query: Any = None, **numbers: Any) -> Any:
        """One route, as `GET /trials/{trial_id}`."""
        method, path = route.split()
        answer = self._client.request(method, path.format(**numbers), json=json, params=query, timeout=300)
        if answer.is_error:
            raise RuntimeError(f"{route}: {answer.text}")
        self.kept[key(method, f"/api/v1{path}")] = short(answer.json())
        return answer.json()


def bench(asking: Asking, service: RunningService) -> None:
    ask = asking.ask
    ask("GET /token")
    ask("POST /lease", {"duration_s": 60, "holder": "Ada, room 12"})
    ask("PUT /lease", {"duration_s": 60})
    ask("GET /lease")
    service.client.delete("/lease")
    ask("POST /drive/state")
    ask("POST /drive/clear-fault", {"fault": ""})
    ask("GET /experiment-kinds")
    ask("GET /channels")
    ask("POST /experiments/plan", STEPS)
    ask("POST /experiments", STEPS | {"pace": "real-time"})
    wait_for(lambda: len(service.runner.live().rows) > 20)
    ask("GET /live/now")
    ask("GET /bench")
    ask("POST /stop", {"reason": "cable is caught"})
    service.runner.wait()
    asking.kept["POST /api/v1/continue"] = {"accepted": True}  # the simulated bench asks nobody
    finished = service.run("steps", repeats=2)["experiment_id"]
    ask("PATCH /experiments/{number}", {"tags": ["winter"], "note": "new grease"}, number=finished)
    ask("GET /experiments/{number}", number=finished)
    ask("GET /experiments", query={"limit": LISTED})
    ask("GET /trials", query={"limit": 1, "experiment_id": finished})
    ask("GET /trials/days", query={"limit": 1})
    ask("GET /trials/search", query={"limit": 1, "words": "step-001"})
    trial_id = service.store.trials(finished)[0].id
    ask("GET /trials/{number}", number=trial_id)
    ask("GET /trials/{number}/samples", query={"points": 10, "channels": "time_s,current_a"}, number=trial_id)


def queue(asking: Asking, service: RunningService) -> None:
    ask = asking.ask
    ask("POST /queue/pause")
    first, second = ask("POST /queue", {"items": [STEPS, {"kind": "coast-down"}]})["item_ids"]
    ask("GET /queue")
    ask("PATCH /queue/{number}", {"position": 0, "note": "first of all"}, number=second)
    ask("GET /queue/{number}", number=first)
    ask("POST /campaigns/plan", CAMPAIGN)
    ask("POST /campaigns", CAMPAIGN)
    ask("DELETE /queue")
    ask("POST /queue/resume")
    asking.kept["POST /api/v1/benches/queue"] = {"item_ids": [7]}  # this bench is by itself


def calibrations(asking: Asking, service: RunningService) -> None:
    from tests.calibration.conftest import SEARCH, SWEEP

    ask = asking.ask
    sweeps = ("speed-sweep", SWEEP), ("load-sweep", SEARCH)
    made = [service.run(kind, **values)["experiment_id"] for kind, values in sweeps]
    number = ask("POST /calibrations", {"experiment_ids": made, "note": "after new grease"})["calibration_id"]
    ask("POST /calibrations/{number}/use", number=number)
    for route in ("GET /calibrations", "GET /calibrations/in-use", "DELETE /calibrations/in-use"):
        ask(route)
    for route in ("GET /calibrations/{number}", "GET /calibrations/{number}/picture"):
        ask(route, number=number)


def studies(asking: Asking, service: RunningService) -> None:
    ask = asking.ask
    body = {"content": recording_set_zip(), "headers": {"Content-Type": "application/zip"}}
    imported = service.client.post("/recording-sets?name=bench+3", **body).json()
    asking.kept["POST /api/v1/recording-sets"] = imported
    new = {"name": "arm, winter", "experiment_ids": [imported["experiment_id"]], "hold_out": ["amplitude_rad=0.9"]}
    ask("POST /studies/check", {"experiment_ids": new["experiment_ids"]})
    made = ask("POST /studies", new)
    number, trial_id = made["study_id"], made["trials"][0]["trial_id"]
    ask("GET /studies")
    service.client.get(f"/studies/{number}/diagnose", headers={"X-Job": "b7"})
    ask("GET /live/jobs/{job}", job="b7")
    for route in ("", "/compare", "/closed-loop", "/diagnose", "/error-map"):
        ask(f"GET /studies/{{number}}{route}", number=number)
    ask("GET /studies/{number}/moments", query={"where": "velocity=0.5..1"}, number=number)
    ask("GET /studies/{number}/action", query={"effect": "viscous_asymmetry"}, number=number)
    ask("GET /studies/{number}/drivers", query={"trial_id": trial_id}, number=number)
    ask("POST /studies/{number}/models", {"effect": "viscous_asymmetry"}, number=number)
    ask("GET /studies/{number}/ladder", number=number)
    ask("POST /studies/{number}/search", {"most": 1}, number=number)
    again = service.client.post("/recording-sets?name=again", **body).json()["experiment_id"]
    ask("POST /studies/{number}/trials", {"experiment_ids": [again]}, number=number)
    beside = [service.client.post("/studies", json=new).json()["study_id"] for _ in range(2)]
    ask("GET /studies/{number}/units", query={"beside": beside}, number=number)
    excited = service.start("excitation", **EXCITATION)
    service.runner.wait()
    own = service.client.post("/studies", json={"name": "own", "experiment_ids": [excited]}).json()["study_id"]
    ask("POST /studies/{number}/use", {}, number=own)
    ask("POST /studies/{number}/suggest", {"trials": 1}, number=own)
    service.client.post("/queue/pause")
    ask("POST /studies/{number}/rounds", {"trials": 1}, number=own)
    service.client.delete("/queue")
    service.client.post("/queue/resume")


def learning(asking: Asking, service: RunningService) -> None:
    ask = asking.ask
    ask("GET /effects", query={"limit": LISTED})
    ask("GET /effects/{name}/example", name="backlash")
    difficulty.DIFFICULTIES["easy"] = QUICK_CHALLENGE  # an hour's worth of recordings shows no more of an answer
    number = ask("POST /challenges", {"difficulty": "easy", "seed": 3})["challenge_id"]
    ask("GET /challenges")
    ask("POST /challenges/{number}/reveal", {"guess": "viscous_asymmetry"}, number=number)
    service.access.look_again()
    wait_for(lambda: service.client.get("/audit").json()["items"])
    ask("GET /audit", query={"limit": LISTED})


def main() -> None:
    """Ask, and write."""
    with tempfile.TemporaryDirectory(prefix="friction-bench-") as folder, running_service(Path(folder)) as service:
        asking = Asking(service)
        for room in (bench, queue, calibrations, studies, learning):
            room(asking, service)
    FILE.write_text(json.dumps(asking.kept, indent=1, sort_keys=True, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
