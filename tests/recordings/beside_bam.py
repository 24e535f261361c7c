"""Time to a given held-out error on the XL330, beside the fitter of Rhoban/bam (CMA-ES on simulated position).

`python -m tests.recordings.beside_bam CHECKOUT RECORDINGS`: a checkout of https://github.com/Rhoban/bam (read at
1b5a1ce; needs the extra `bench`), and the folder of the xl330 set. Both sides get the same trials, the same control
law, supply and step, and are judged by bam's own measure: the mean absolute error of the simulated position, on the
trials of a position gain that neither was fitted to. Trials in which the torque is switched off are left out: there a
voltage says nothing. Both times are of one core, from the start of a process to a model, imports and reading included.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tests.lab.line import Line, print_table
from tests.paths import EXAMPLES
from tests.recordings.closed_loop import Logs, simulated

STEP_S = 0.005  # bam's own
SUPPLY_V = 7.5  # bam's own for this servo
LEFT_OUT = "lift_and_drop"
POLL_S = 0.5


class Found(NamedTuple):
    """A model: seconds of one core since its process began, and its error on the trials held out."""

    cpu_s: float
    error_rad: float


def main() -> None:
    """Fit both, and print the ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("checkout", type=Path)
    parser.add_argument("recordings", type=Path)
    parser.add_argument("--model", default="m6", help="bam's; m6 is its fullest")
    parser.add_argument("--hold-out-kp", type=int, default=400)
    parser.add_argument("--most-s", type=float, default=600.0, help="of one core, that bam gets")
    parser.add_argument("--ours", action="store_true", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if not (asked.checkout / "bam" / "model.py").is_file():
        parser.error(f"{asked.checkout} holds no bam/model.py: clone https://github.com/Rhoban/bam and name its folder")
    if asked.ours:
        print(json.dumps(_ours(asked.recordings, asked.hold_out_kp)))
        return
    told = json.loads(_run("-m", __spec__.name, str(asked.checkout), str(asked.recordings), "--ours", *_kp(asked)))
    ours = [Found(*one) for one in told["models"]]
    best = min(ours, key=lambda one: one.error_rad)
    theirs = _theirs(asked, best.error_rad)
    print_table(_lines(ours, theirs, asked.model, best))


def _lines(ours: list[Found], theirs: list[Found], model: str, best: Found) -> list[Line]:
    reached = next((one for one in theirs if one.error_rad <= best.error_rad), None)
    spent = theirs[-1].cpu_s if theirs else 0.0
    lowest = min(theirs, key=lambda one: one.error_rad, default=Found(0.0, float("nan")))
    ratio = f"{reached.cpu_s / best.cpu_s:.1f}" if reached else f"more than {spent / best.cpu_s:.1f}: not reached"
    return [
        Line("base model, error of the position held out", "", _text(ours[0]), True),
        Line("with the effect that is named first", "", _text(ours[-1]), True),
        Line(f"bam {model}, first model that it writes", "", _text(theirs[0]) if theirs else "none", True),
        Line(f"bam {model}, its best within {spent:.0f} s", "", _text(lowest), True),
        Line(f"time of bam to our error of {1e3 * best.error_rad:.1f} mrad, over ours", "", ratio, True),
    ]


def _text(found: Found) -> str:
    return f"{1e3 * found.error_rad:.1f} mrad after {found.cpu_s:.1f} s of one core"


def _kp(asked: argparse.Namespace) -> tuple[str, str]:
    return "--hold-out-kp", str(asked.hold_out_kp)


def _recordings(folder: Path) -> list[Any]:
    from bench.recording_set import read_mapping, read_recording_set, read_rig

    example = EXAMPLES / "xl330"
    read = read_recording_set(folder, read_mapping(example / "mapping.toml"), read_rig(example / "rig.toml"))
    return [one for one in read.recordings if one.kind != LEFT_OUT]


def _ours(folder: Path, hold_out_kp: int) -> dict[str, Any]:
    """The base model, and that with the first effect that is named; each with the time it took up to then."""
    from bench.recording_set import read_rig
    from bench.study.material import facts_of
    from compensator.lab.diagnosis.diagnose import diagnose
    from compensator.lab.effects.catalogue import default_effects
    from compensator.lab.model.fit import fit_effects, fit_model, seeing_all
    from compensator.lab.rows.assembly import make_dataset
    from compensator.lab.rows.dataset import Processing

    everything = _recordings(folder)
    facts = facts_of(read_rig(EXAMPLES / "xl330" / "rig.toml"))
    training = [one for one in everything if one.conditions["kp"] != hold_out_kp]
    dataset = make_dataset(training, facts, Processing())
    base = fit_model(dataset, default_effects(facts))
    times = [time.process_time()]
    named = diagnose(base).classes
    fits = [base]
    if named:
        fits.append(fit_effects(base, [*base.names, named[0][0]]))
        times.append(time.process_time())
    logs = _logs([one for one in everything if one.conditions["kp"] == hold_out_kp])
    errors = [logs.mean_absolute_error_rad(simulated(seeing_all(fit), logs)) for fit in fits]
    return {"models": list(zip(times, errors, strict=True)), "added": list(fits[-1].names[len(base.names) :])}


def _logs(held: list[Any]) -> Logs:
    """The trials held out on bam's grid, under its control law: counts of error, times the gain, over two divisors."""
    last_s = min(float(one.channels["time_s"][-1]) for one in held)
    grid = np.arange(0.0, last_s, STEP_S)

    def on_grid(name: str) -> np.ndarray:
        return np.array([np.interp(grid, one.channels["time_s"], one.channels[name]) for one in held]).T

    gain = np.array([_volts_per_rad(float(one.conditions["kp"])) for one in held])
    return Logs(on_grid("target_rad"), on_grid("position_rad"), gain, SUPPLY_V, STEP_S)


def _volts_per_rad(kp: float) -> float:
    """As the servo's manual has it, and bam: 4096 counts a turn, gain over 256, duty over 885."""
    return SUPPLY_V * kp * 4096 / (2.0 * np.pi) / (256 * 885)


def _theirs(asked: argparse.Namespace, wanted_rad: float) -> list[Found]:
    """The models that bam's fitter writes while it runs, each with its error, until one is as good or time is up."""
    with tempfile.TemporaryDirectory(prefix="friction-bench-bam-") as temporary:
        training, held = Path(temporary) / "training", Path(temporary) / "held"
        for one in _recordings(asked.recordings):
            folder = held if one.conditions["kp"] == asked.hold_out_kp else training
            folder.mkdir(exist_ok=True)
            (folder / f"{one.name}.json").write_text(json.dumps(_log(one)))
        score = _scorer(asked.checkout, held)
        output = Path(temporary) / "params.json"
        words = ["--logdir", training, "--output", output, "--actuator", "xl330", "--model", asked.model]
        command = [sys.executable, "-m", "tests.recordings.bam_fitter", asked.checkout, *words]
        with subprocess.Popen([*map(str, command)], stdout=subprocess.DEVNULL) as fitter:
            try:
                return _watched(fitter, output, score, wanted_rad, asked.most_s)
            finally:
                fitter.terminate()


def _watched(fitter: Any, output: Path, score: Any, wanted_rad: float, most_s: float) -> list[Found]:
    found: list[Found] = []
    before = ""
    while fitter.poll() is None:
        time.sleep(POLL_S)
        text, cpu_s = output.read_text() if output.exists() else "", _cpu_s(fitter.pid)
        if text != before and text.endswith("}") and len(text) > 2:
            before = text
            found.append(Found(cpu_s, score(json.loads(text))))
            if found[-1].error_rad <= wanted_rad:
                return found
        if cpu_s > most_s:
            return [*found, Found(cpu_s, found[-1].error_rad)] if found else found
    raise SystemExit(f"bam's fitter ended with exit code {fitter.returncode}; its own message is above")


def _cpu_s(pid: int) -> float:
    """Seconds of one core that a process has had."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / 100.0


def _log(recording: Any) -> dict[str, Any]:
    """A recording as bam keeps one after its own processing: the same grid, interpolated linearly."""
    channels = recording.channels
    grid = np.arange(0.0, float(channels["time_s"][-1]), STEP_S)
    names = {"position": "position_rad", "speed": "velocity_rad_s", "goal_position": "target_rad"}
    made = {key: np.interp(grid, channels["time_s"], channels[name]) for key, name in names.items()}
    entries = [{**{key: float(v[i]) for key, v in made.items()}, "torque_enable": True} for i in range(len(grid))]
    known = recording.conditions
    facts = {"mass": known["load_kg"], "arm_mass": 0.0, "length": known["arm_m"], "kp": known["kp"], "vin": SUPPLY_V}
    return {**facts, "dt": STEP_S, "motor": "xl330", "trajectory": recording.kind, "entries": entries}


def _scorer(checkout: Path, held: Path) -> Any:
    """The error of a model of bam's in bam's own simulator."""
    sys.path.insert(0, str(checkout))
    from bam.logs import Logs as BamLogs
    from bam.model import load_model_from_dict
    from bam.simulate import Simulator

    batch = BamLogs(str(held)).make_batch()
    measured = np.array([entry["position"] for entry in batch["entries"]])

    def score(parameters: dict[str, Any]) -> float:
        positions = Simulator(load_model_from_dict(parameters)).rollout_log(batch, simulate_control=True)[0]
        return float(np.mean(np.abs(np.array(positions) - measured)))

    return score


def _run(*words: str) -> str:
    return subprocess.run([sys.executable, *words], check=True, capture_output=True, text=True).stdout


if __name__ == "__main__":
    main()
