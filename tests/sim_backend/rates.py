"""How fast the plant and the drive are, printed: `python -m tests.sim_backend.rates`. Not a test."""

from collections.abc import Callable
from time import perf_counter

from drivers.contract import Command, Mode
from sim_backend import presets
from sim_backend.drive import SimulatedDrive
from sim_backend.motor import VOLTAGE
from sim_backend.plant import Plant

STEPS, CYCLES, ROUNDS = 200_000, 2_000, 10


def steps_per_second() -> float:
    """Integration steps of the rig `paper` on one core, best of some rounds."""
    plant = Plant(presets.paper())
    plant.advance(VOLTAGE, 0.3, 1)
    return STEPS / min(_timed(lambda: plant.advance(VOLTAGE, 0.3, STEPS)) for _ in range(ROUNDS))


def seconds_per_exchange(period_s: float) -> float:
    """A whole control cycle of the drive, best of some rounds."""
    drive = SimulatedDrive(presets.paper())
    drive.open(period_s)
    drive.enable(Mode.DUTY)
    command = Command(Mode.DUTY, 0.3)

    def cycles() -> None:
        for _ in range(CYCLES):
            drive.exchange(command)

    cycles()
    return min(_timed(cycles) for _ in range(ROUNDS)) / CYCLES


def _timed(work: Callable[[], object]) -> float:
    began = perf_counter()
    work()
    return perf_counter() - began


if __name__ == "__main__":
    print(f"plant: {steps_per_second() / 1e6:.1f} million steps a second")  # noqa: T201
    for period_s in (1e-3, 5e-3):
        each_s = seconds_per_exchange(period_s)
        print(f"drive, {1e3 * period_s:g} ms cycle: {1e6 * each_s:.1f} us, {period_s / each_s:.0f} x real time")  # noqa: T201
