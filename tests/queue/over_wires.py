"""`python -m tests.queue.over_wires [WIRE ...]`: kinds of experiments from the queue over a wire, and a campaign after.

In virtual time: real driver, its bytes or frames, and a simulated device, in one process. A person hangs what is asked
for. Those kinds that have conformance tests of their own are left out. Printed is how each experiment ended.
"""

from tests.commission.virtual_time import TIME  # first: the drivers read its clock

# isort: split
import sys
import tempfile
from contextlib import closing
from typing import Any

from bench.runs.queue.campaign import Campaign, plan_campaign
from bench.runs.queue.conductor import Conductor
from bench.runs.queue.overview import queue_state
from bench.runs.runner import Runner
from bench.store import Store
from bench.store.tables.queue import NewItem, QueueItem
from sim_backend.devices.canopen.drive import ServoDrive
from sim_backend.devices.canopen.objects.generic import GENERIC
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.modbus.own_drive import OwnDrive
from tests.commission.wires import CanWire, SerialWire, VirtualWire, plugged_in, rtu_answer
from tests.drivers.hidden import hang, on_bench

WAVEFORM = "time_s,position_rad\n0,0\n1,0.1\n2,0\n"
SHORT: dict[str, dict[str, Any]] = {
    "commissioning": {},
    "breakaway-ramps": {"rates_a_s": [1.0], "dwells_s": [0.2]},
    "reversals": {"amplitudes_rad": [0.2], "strokes": 2},
    "chirp": {"duration_s": 2.0, "high_hz": 2.0},
    "multisine": {"tones": 3, "low_hz": 1.0, "high_hz": 3.0, "wave_s": 1.0, "waves": 1},
    "coast-down": {"speeds_rad_s": [2.0], "coast_s": 1.0},
    "hold-and-soak": {
        "load_kg": 0.0,
        "hold_rad": 0.5,
        "soak_s": 1.5,
        "probe_every_s": 1.0,
        "probe_rad": 0.2,
        "probe_rad_s": 1.0,
    },
    "waveform": {"csv": WAVEFORM},
}
CAMPAIGN = Campaign(
    name="loads over the wire",
    kind="reversals",
    parameters={"amplitudes_rad": [0.2], "strokes": 2},
    grid={"load_kg": [0.0, 0.05]},
)
KINDS = [*SHORT, "reversals", "reversals"]
WIRES = ("modbus", "canopen")


def wired(name: str) -> tuple[VirtualWire, Any, dict[str, Any]]:
    """A simulated device on its wire: the wire, its port, and the section of the drive."""
    joint = behind_a_drive("paper", None, {})
    if name == "modbus":
        wire = VirtualWire(OwnDrive(joint))
        section = {"kind": "modbus", "map": "friction-bench", "transport": "rtu", "port": "virtual"}
        return wire, SerialWire(wire, rtu_answer(wire.device)), section
    wire = VirtualWire(ServoDrive(joint, GENERIC, 5))
    return wire, CanWire(wire), {"kind": "canopen", "interface": "slcan", "channel": "virtual", "node_id": 5}


def queued(name: str, store: Store) -> list[QueueItem]:
    """Run them all over a wire; what came of each, in the order of the queue."""
    wire, port, section = wired(name)
    with plugged_in(port), closing(Runner(on_bench(section), store)) as runner:
        conductor = Conductor(runner, store)
        conductor.begin()
        conductor.add([NewItem(kind, parameters) for kind, parameters in SHORT.items()])
        conductor.add_items(list(plan_campaign(CAMPAIGN, runner.configuration).items))
        while queue_state(conductor, runner).state not in ("idle", "held"):
            runner.wait(0.02)
            prompt = runner.status().prompt
            if prompt is not None:
                hang(wire, prompt.sentence)
                runner.answer(prompt.number)
        conductor.close()
        print(f"{name}: {conductor.held or 'nothing held the queue'}")
        return conductor.table.items()


def report(name: str) -> bool:
    """Print how each ended; whether every one completed, with rows and the drive on record."""
    began_s = TIME.now()
    with tempfile.TemporaryDirectory() as folder, Store.open(f"sqlite:///{folder}/bench.sqlite") as store:
        items = queued(name, store)
        sound = [item.kind for item in items] == KINDS
        for item in items:
            trials = store.trials(item.experiment_id) if item.experiment_id else []
            kept = bool(trials) and all(trial.rows > 20 and trial.outcome == "completed" for trial in trials)
            sound = sound and item.state == "completed" and kept
            print(f"{name:<8} {item.kind:<16} {item.state:<10} {sum(trial.rows for trial in trials):6} rows")
        sound = sound and bool(store.experiment(items[-1].experiment_id).provenance["drive"]["product"])
    print(f"{name}: {'all completed' if sound else 'NOT MET'}, {TIME.now() - began_s:.0f} s of the joint's time")
    return sound


if __name__ == "__main__":
    sys.exit(0 if all(report(name) for name in sys.argv[1:] or WIRES) else 1)
