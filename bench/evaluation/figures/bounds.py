"""Lower bounds of the figures' errors for any estimator: scatter of friction at rest, free play in motion."""

from collections.abc import Mapping, Sequence
from math import pi, sqrt
from typing import Any

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.config.reflected_load import per_kg_a, torque_n_m_a
from bench.config.rig import resolution_rad
from bench.experiments.kinds.steady_speeds import STEADY_SHARE, SteadySpeedsParameters
from bench.experiments.parts.load_follower import WINDOW_S

MEAN_ABSOLUTE = sqrt(2.0 / pi)  # of a normal error, over its standard deviation
SLACK = sqrt(8.0)  # see `stroke_bound_g`


def rest_bound_g(rows: Sequence[Mapping[str, Any]], configuration: BenchConfiguration) -> float | None:
    """Mean absolute error [g] of the mean of so many breakaways, by how friction scatters from stop to stop.

    Args:
        rows: of a load sweep.
        configuration: calibrated; its `rest` knows the scatter of one breakaway.

    Returns:
        None where there is no search, or no scatter is known.
    """
    if configuration.rest is None:
        return None
    calibration = configuration.rest.calibration()
    found = [
        calibration.scatter_a(row["friction_current_a"], (row["max_current_a"] - row["min_current_a"]) / 2.0)
        / sqrt(len(row["breakaways"]))
        for row in rows
        if row.get("breakaways") and row.get("friction_current_a") is not None
    ]
    return MEAN_ABSOLUTE * float(np.mean(found)) / _per_g_a(configuration) if found else None


def stroke_bound_g(configuration: BenchConfiguration) -> float | None:
    """Mean absolute error [g] of a stroke of the steady speeds, by what the motor's encoder alone knows of the arm.

    The arm lies anywhere within free play and encoder count, d wide: variance d^2 / 12. Its mean acceleration over a
    time T is at best a second difference of where it is at the ends and in the middle, 4 (x1 - 2 x2 + x3) / T^2, of
    variance 16 (1 + 4 + 1) / T^4 d^2 / 12 = (8 / T^4) d^2; and what accelerates it is taken for load. Whoever knows
    the weight knows the flank that the arm lies on (`free_play`), and does better.

    Returns:
        The mean over the speeds of `steady-speeds`; None where the rig leaves out inertia, length or free play.
    """
    rig, parameters = configuration.rig, SteadySpeedsParameters()
    inertia, length_m, play_rad = rig.arm.inertia_kg_m2, rig.arm.length_m, rig.gear.backlash_rad
    if inertia is None or length_m is None or play_rad is None:
        return None
    moved = inertia + parameters.load_kg * length_m**2
    way_rad = STEADY_SHARE * (2.0 * parameters.reach_rad - parameters.run_up_rad - parameters.brake_rad)
    slack_rad = play_rad + resolution_rad(configuration.rig)
    # the first estimate of the stretch rests on a window before it
    seen_s = [way_rad / speed + WINDOW_S for speed in parameters.speeds_rad_s]
    errors_n_m = [moved * SLACK * slack_rad / time_s**2 for time_s in seen_s]
    return MEAN_ABSOLUTE * float(np.mean(errors_n_m)) / torque_n_m_a(rig) / _per_g_a(configuration)


def _per_g_a(configuration: BenchConfiguration) -> float:
    """Current of a gram more at 90 degrees [A]."""
    return 1e-3 * per_kg_a(configuration.rig)
