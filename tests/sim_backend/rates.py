"""The speeds that are asked for, each beside the one measured: `make benchmark`. Not a test.

Other work on the machine makes every figure worse; rates are those of the best of many short rounds. What is compared
with another library takes turns with it and is timed by the CPU: the median of the rounds, and their spread.
"""

import subprocess
import sys
import tempfile
from collections.abc import Callable, Generator, Iterator
from os import environ
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage
from statistics import median
from time import perf_counter, process_time
from typing import Any

import numpy as np

from bench.evaluation.paper.measurements import Measurement, measure, quietly
from bench.store import Store
from drivers.contract import Command, Mode
from sim_backend.drive.simulated_drive import SimulatedDrive
from sim_backend.mechanisms.joint.gravity import Load
from sim_backend.mechanisms.motor.motor import VOLTAGE
from sim_backend.plant import presets
from sim_backend.plant.parameters import PlantParameters
from sim_backend.plant.plant import Plant
from tests.sim_backend.cycle_cost import at_1_khz
from tests.sim_backend.mujoco_hinge import hinge, swing

STEPS, ROUNDS, STEP_S = 5_000, 400, 1e-4
BENCH_ROUNDS = 8  # of a second or less
PAIRED_ROUNDS, PAIRED_STRETCHES = 15, 40  # beside MuJoCo: about as long each
CYCLES = 50  # in a round: few, so that some rounds meet no other work
# one joint with backlash, bristles on both sides of it, and heat
BRISTLED: dict[str, dict[str, Any]] = {
    "bristle": {"stiffness_n_m_rad": 2.0, "damping_n_m_s_rad": 4e-3},
    "arm_bristle": {"stiffness_n_m_rad": 5.0, "damping_n_m_s_rad": 0.02},
    "heat": {"present": True},
}
FIRST_CALL = """
from time import perf_counter
began = perf_counter()
from drivers.contract import Command, Mode
from sim_backend.plant import presets
from sim_backend.drive.simulated_drive import SimulatedDrive
drive = SimulatedDrive(presets.paper())
drive.open(0.005)
drive.enable(Mode.DUTY)
drive.exchange(Command(Mode.DUTY, 0.1))
"""


def best_s(work: Callable[[], object], rounds: int) -> float:
    """Shortest time of some rounds."""
    times = []
    for _ in range(rounds):
        began = perf_counter()
        work()
        times.append(perf_counter() - began)
    return min(times)


def stretch_of(parameters: PlantParameters) -> Callable[[], object]:
    """`STEPS` of a plant on one core, in motion that reverses each time, with 100 g hung on; compiled."""
    plant = Plant(parameters, step_s=STEP_S)
    plant.hang(Load(mass_kg=0.1))
    turn = [0.3]

    def stretch() -> None:
        turn[0] = -turn[0]
        plant.advance(VOLTAGE, turn[0], STEPS)

    stretch()
    return stretch


def plant_rate(parameters: PlantParameters) -> float:
    """Steps a second of a plant on one core."""
    return STEPS / best_s(stretch_of(parameters), ROUNDS)


def beside_mujoco(parameters: PlantParameters) -> tuple[list[float], float]:
    """How many times as fast as MuJoCo's C rollout of a single hinge, by CPU time, round for round; and its rate.

    Both work in turn, for about as long: what else the machine does meets both.
    """
    import mujoco

    model = hinge(mujoco, STEP_S, inertia=0.022, mass=0.1, length=0.5, damping=1e-3, dry=5e-3)
    peer_steps = 4 * STEPS  # enough that starting the rollout does not count
    ours, times = stretch_of(parameters), PAIRED_STRETCHES
    ratios, peers = [], []
    for _ in range(PAIRED_ROUNDS):
        peer_s = cpu_s(lambda: swing(mujoco, model, 1.0, peer_steps), 1) / peer_steps
        ratios.append(peer_s / (cpu_s(ours, times) / (times * STEPS)))
        peers.append(1.0 / peer_s)
    return ratios, median(peers)


def cpu_s(work: Callable[[], object], times: int) -> float:
    """CPU time of so many calls."""
    began_s = process_time()
    for _ in range(times):
        work()
    return process_time() - began_s


def exchange_s(period_s: float) -> float:
    """Seconds that a control cycle of the drive takes."""
    drive = SimulatedDrive(presets.paper())
    drive.open(period_s)
    drive.enable(Mode.DUTY)
    command = Command(Mode.DUTY, 0.3)

    def cycles() -> None:
        for _ in range(CYCLES):
            drive.exchange(command)

    cycles()
    return best_s(cycles, ROUNDS) / CYCLES


def floor_s(period_s: float) -> float:
    """Seconds that a control cycle takes at least: a procedure that does nothing, and one call of the kernel."""
    plant, steps = Plant(presets.paper()), round(period_s / STEP_S)

    def nothing() -> Generator[None, None, None]:
        while True:
            yield

    send = nothing().send

    def cycles() -> None:
        for _ in range(CYCLES):
            plant.advance(VOLTAGE, 0.3, steps)
            send(None)

    cycles()
    return best_s(cycles, ROUNDS) / CYCLES


def bench_ratio() -> tuple[float, float]:
    """Simulated seconds of steps through loop, servo, search and store at 1 kHz, over seconds of (wall, CPU)."""
    configuration = at_1_khz()
    with tempfile.TemporaryDirectory() as folder, Store.open(f"sqlite:///{folder}/bench.sqlite") as store:

        def once() -> tuple[float, float]:
            began, used = perf_counter(), process_time()
            identity = measure(configuration, store, Measurement("steps", {"repeats": 4}), quietly).id
            wall_s, cpu_s = perf_counter() - began, process_time() - used
            simulated_s = sum(float(store.samples(trial.id)["time_s"][-1]) for trial in store.trials(identity))
            return simulated_s / wall_s, simulated_s / cpu_s

        once()  # the kernel is loaded, the store's statements are compiled
        wall, cpu = np.max([once() for _ in range(BENCH_ROUNDS)], axis=0)
    return float(wall), float(cpu)


def start_s(cache: Path) -> tuple[float, float]:
    """(wall, CPU) seconds of a process that imports the simulation and exchanges once, with a cache of its own."""
    used, began = getrusage(RUSAGE_CHILDREN).ru_utime, perf_counter()
    command = [sys.executable, "-c", FIRST_CALL]
    subprocess.run(command, check=True, env={**environ, "NUMBA_CACHE_DIR": str(cache)})
    return perf_counter() - began, getrusage(RUSAGE_CHILDREN).ru_utime - used


def report() -> Iterator[str]:
    """Yield one line per figure."""
    paper = plant_rate(presets.paper())
    bristled = plant_rate(PlantParameters.from_dict(BRISTLED, presets.paper()))
    yield f"plant, rig 'paper': {1e-6 * paper:.2f} million steps a second"
    yield f"plant, backlash, two LuGre frictions, heat: {1e-6 * bristled:.2f} million steps a second (asked for: 5)"
    try:
        ratios, peer = beside_mujoco(PlantParameters.from_dict(BRISTLED, presets.paper()))
        spread = f"{min(ratios):.1f} .. {max(ratios):.1f}"
        yield f"  {median(ratios):.1f} x MuJoCo's rollout of one hinge ({spread}), by CPU time in turn (asked for: 5 x)"
        yield f"  MuJoCo: {1e-6 * peer:.2f} million steps a second of CPU"
    except ImportError:
        yield "  MuJoCo: not installed; pip install --constraint constraints.txt '.[bench]'"
    for period_s in (1e-3, 5e-3):
        each_s = exchange_s(period_s)
        yield f"drive, {1e3 * period_s:g} ms cycle: {1e6 * each_s:.1f} us, {period_s / each_s:.0f} x real time"
    least_s = floor_s(1e-3)
    yield f"floor at 1 kHz, empty procedure + one compiled call: {1e6 * least_s:.1f} us, {1e-3 / least_s:.0f} x"
    wall, cpu = bench_ratio()
    yield f"whole bench at 1 kHz: {wall:.0f} x real time; {cpu:.0f} x by CPU time (asked for: 40 x)"
    with tempfile.TemporaryDirectory() as folder:
        first, later = start_s(Path(folder)), min(start_s(Path(folder)) for _ in range(3))
    yield f"first call after installation: {first[0]:.1f} s; {first[1]:.1f} s of CPU (asked for: 10 s)"
    yield f"later starts: {later[0]:.2f} s; {later[1]:.2f} s of CPU (asked for: 1.5 s)"


if __name__ == "__main__":
    for line in report():
        print(line, flush=True)
