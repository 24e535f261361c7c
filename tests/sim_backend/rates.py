"""How fast plant and drive are, and how fast MuJoCo is beside them: `make benchmark`. Not a test."""

from collections.abc import Callable
from time import perf_counter
from typing import Any

from drivers.contract import Command, Mode
from sim_backend import presets
from sim_backend.drive import SimulatedDrive
from sim_backend.motor import VOLTAGE
from sim_backend.parameters import PlantParameters
from sim_backend.plant import Plant
from tests.sim_backend.mujoco_hinge import hinge, swing

STEPS, CYCLES, ROUNDS = 200_000, 2_000, 10
STEP_S = 1e-4
# one joint with backlash, bristles on both sides of it, and heat
BRISTLED: dict[str, dict[str, Any]] = {
    "bristle": {"stiffness_n_m_rad": 2.0, "damping_n_m_s_rad": 4e-3},
    "arm_bristle": {"stiffness_n_m_rad": 5.0, "damping_n_m_s_rad": 0.02},
    "heat": {"present": True},
}


def steps_per_second(parameters: PlantParameters) -> float:
    """Integration steps of a plant on one core, best of some rounds."""
    plant = Plant(parameters, step_s=STEP_S)
    plant.advance(VOLTAGE, 0.3, 1)
    return STEPS / min(_timed(lambda: plant.advance(VOLTAGE, 0.3, STEPS)) for _ in range(ROUNDS))


def mujoco_steps_per_second() -> float | None:
    """Steps of MuJoCo's C rollout of a single hinge on one core, best of some rounds; None where not installed."""
    try:
        import mujoco
    except ImportError:
        return None
    model = hinge(mujoco, STEP_S, inertia=0.022, mass=0.1, length=0.5, damping=1e-3, dry=5e-3)
    steps = STEPS // 10
    return steps / min(_timed(lambda: swing(mujoco, model, 1.0, steps)) for _ in range(ROUNDS))


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


def report() -> list[str]:
    """One line per figure."""
    rates = {
        "rig 'paper'": steps_per_second(presets.paper()),
        "backlash, two LuGre frictions, heat": steps_per_second(PlantParameters.from_dict(BRISTLED, presets.paper())),
    }
    lines = [f"plant, {name}: {1e-6 * rate:.2f} million steps a second" for name, rate in rates.items()]
    peer = mujoco_steps_per_second()
    if peer is None:
        lines.append("MuJoCo: not installed; pip install --constraint constraints.txt '.[bench]'")
    else:
        lines.append(f"MuJoCo, C rollout of one hinge, same step: {1e-6 * peer:.3f} million steps a second")
        lines += [f"plant, {name}: {rate / peer:.1f} x MuJoCo" for name, rate in rates.items()]
    for period_s in (1e-3, 5e-3):
        each_s = seconds_per_exchange(period_s)
        lines.append(f"drive, {1e3 * period_s:g} ms cycle: {1e6 * each_s:.1f} us, {period_s / each_s:.0f} x real time")
    return lines


if __name__ == "__main__":
    print("\n".join(report()))  # noqa: T201
