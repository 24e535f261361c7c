"""`python -m tests.calibration.accuracy`: curves of the sequential design and of the full sweep, beside the truth.

On the paper's rig, whose friction is known: the error of the curves over speeds of 0.05 to 6 rad/s and loads of 0 to
100 g, with the time of the joint that each design takes.
"""

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from bench.calibration.curves import friction_fits
from bench.calibration.points import friction_points
from bench.calibration.sequential import SequentialDesign
from bench.config.configuration import BenchConfiguration, default_configuration
from sim_backend.plant.presets import paper
from tests.experiments.bench_run import Ran

SPEEDS_RAD_S = np.geomspace(0.05, 6.0, 40)
LOADS_KG = tuple(round(0.01 * step, 2) for step in range(11))
GRAVITY_M_S2 = 9.80665
ACCURACY_A, BUDGET_S = 5e-3, 240.0  # as `calibrate run` has them


def true_a(load_kg: float, speed_rad_s: np.ndarray) -> np.ndarray:
    """Friction of the paper's rig under a balanced load, as motor current."""
    plant = paper()
    ratio, torque_n_m_a = plant.gear.ratio, plant.gear.ratio * plant.motor.torque_constant_n_m_a
    grown = 1.0 + plant.friction.growth_per_n * load_kg * GRAVITY_M_S2

    def dry(friction: Any, speed: np.ndarray) -> np.ndarray:
        rise = friction.static_n_m - friction.coulomb_n_m
        return friction.coulomb_n_m + rise * np.exp(-((speed / friction.stribeck_rad_s) ** friction.stribeck_exponent))

    drive = grown * dry(plant.friction, ratio * speed_rad_s) + plant.friction.viscous_n_m_s_rad * ratio * speed_rad_s
    arm = dry(plant.arm_friction, speed_rad_s) + plant.arm_friction.viscous_n_m_s_rad * speed_rad_s
    return (ratio * drive + arm) / torque_n_m_a


def error_a(rows: Sequence[Any]) -> tuple[float, float]:
    """Root mean square and largest error of the curves [A], between loads as the look-up goes: straight."""
    ratio = paper().gear.ratio
    fits = friction_fits(friction_points(rows))
    known = sorted(fits)
    sliding = np.array([fits[load_kg].curve.sliding_a(SPEEDS_RAD_S * ratio) for load_kg in known])
    errors = [
        [np.interp(load_kg, known, column) for column in sliding.T] - true_a(load_kg, SPEEDS_RAD_S)
        for load_kg in LOADS_KG
    ]
    return float(np.sqrt(np.mean(np.square(errors)))), float(np.max(np.abs(errors)))


def seeded(seed: int) -> BenchConfiguration:
    """The paper's rig with another scatter."""
    found = default_configuration()
    return found.model_copy(update={"drive": found.drive.model_copy(update={"seed": seed})})


def swept(bench: BenchConfiguration, **parameters: Any) -> tuple[list[dict[str, Any]], float]:
    """Rows of a speed sweep, each with the time that it took, and the time of all [s]."""
    ran = Ran(bench, "speed-sweep", **parameters)
    period_s = bench.control.period_s
    took = [len(rows) * period_s for rows in ran.rows]
    return [dict(row) | {"took_s": one_s} for row, one_s in zip(ran.summary["rows"], took, strict=True)], sum(took)


def sequential(bench: BenchConfiguration) -> tuple[list[dict[str, Any]], float]:
    """Rows of the sequential design, and its time [s]."""
    design = SequentialDesign(bench, (0.0, bench.limits.load_kg), ACCURACY_A, BUDGET_S)
    rows: list[dict[str, Any]] = []
    while True:
        points = friction_points(rows) if rows else {}
        spent_s = {load_kg: sum(row["took_s"] for row in rows if row["load_kg"] == load_kg) for load_kg in points}
        batch = design.next(points, spent_s)
        if batch is None:
            return rows, sum(row["took_s"] for row in rows)
        rows += swept(bench, **batch.parameters)[0]


def main(seeds: int = 3) -> None:
    """Print both, for some seeds of the joint's scatter."""
    print(f"{'design':12} {'seed':>4} {'trials':>6} {'minutes':>7} {'rms':>8} {'largest':>8}")
    found: dict[str, list[float]] = {"sequential": [], "full": []}
    for seed in range(1, seeds + 1):
        bench = seeded(seed)
        full = swept(bench, loads_kg=LOADS_KG, duties=(0.1, 0.2, 0.3), strokes=4)
        for name, (rows, took_s) in (("sequential", sequential(bench)), ("full", full)):
            rms_a, largest_a = error_a(rows)
            found[name].append(rms_a)
            errors = f"{1e3 * rms_a:5.2f} mA {1e3 * largest_a:5.1f} mA"
            print(f"{name:12} {seed:4} {len(rows):6} {took_s / 60.0:7.1f} {errors}", flush=True)
    for name, errors_a in found.items():
        print(f"{name}: root mean square over the seeds {1e3 * np.sqrt(np.mean(np.square(errors_a))):.2f} mA")


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
