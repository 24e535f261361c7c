"""What a teleoperation told: how far the reflected load is from the true one, how late, and whether the pair swings."""

from collections.abc import Sequence

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.config.reflected_load import load_current_a, per_kg_a, torque_n_m_a
from bench.config.rig import resolution_rad
from bench.experiments.parts.pair_joints import Conveyed, reflection_of
from bench.json_types import Value
from compensator.reflection.reflection_quality import FloatArray, Swing, delay_s, drag, rise_s, swing, unexplained

LATE_S = 0.03  # of delay that is told apart from an error
LEAST_JUMP_N_M = 0.1  # within a few cycles, that counts as a hit
SWING_COUNTS = 8.0  # of the encoder; what turns back by less does not swing


def truth_n_m(
    conveyed: Sequence[Conveyed], load_kg: float, wall: bool, configuration: BenchConfiguration
) -> FloatArray:
    """The load that is to be reflected, row by row [N m]: what truly acts, or the weight that is known to hang there.

    NaN where a real arm leans on a wall.
    """
    true = np.array([one.reading.truth.interaction_n_m for one in conveyed])
    if wall or not np.all(np.isnan(true)):
        return true
    rig = configuration.rig
    angles_rad = (one.reading.slave.sample.position_rad for one in conveyed)
    return np.array([load_current_a(load_kg, angle_rad, rig) for angle_rad in angles_rad]) * torque_n_m_a(rig)


def error_results(
    conveyed: Sequence[Conveyed], truth: FloatArray, force_scale: float, configuration: BenchConfiguration
) -> dict[str, Value]:
    """How far the reflected load is from the true one.

    Returns:
        reflected_error_rms_n_m, reflected_error_max_n_m, and the same as grams at 90 degrees (`_g`): of the reflected
            torque, the force scale taken off.
        least_error_max_g: the largest error of the truth itself, a cycle late and changed no faster than allowed.
        late_error_max_g: the largest error that no delay of up to 30 ms explains.
        latency_s: by how much it comes later; None where it is no image of the truth.
        rise_s: from the greatest jump of the truth until half of it is reflected; None where there is none.
        drag_n_m: by how much it resists the hand more than the load does; below 0 it drives the hand on.
        felt_error_rms_n_m: of what the hand truly feels, the master's own friction and inertia included; None where
            nobody knows.
        Nothing where the truth is not known.
    """
    known = np.isfinite(truth)
    if not np.any(known):
        return {}
    reflected = (np.array([one.reflected_n_m for one in conveyed]) / force_scale)[known]
    felt = np.array([one.reading.truth.hand_n_m for one in conveyed]) / force_scale - truth
    master_rad = np.array([one.reading.master.sample.position_rad for one in conveyed])[known]
    true, period_s, per_g = truth[known], configuration.control.period_s, 1e-3 * _per_kg_n_m(configuration)
    error, readings = reflected - true, max(round(LATE_S / period_s), 1)
    rms, most = float(np.sqrt(np.mean(error**2))), float(np.max(np.abs(error)))
    least = np.abs(_at_best(true, force_scale, configuration) - true)
    return {
        "reflected_error_rms_n_m": rms,
        "reflected_error_max_n_m": most,
        "reflected_error_rms_g": rms / per_g,
        "reflected_error_max_g": most / per_g,
        "least_error_max_g": float(np.max(least)) / per_g,
        "late_error_max_g": float(np.max(unexplained(reflected, true, readings))) / per_g,
        "latency_s": delay_s(reflected, true, period_s),
        "rise_s": rise_s(reflected, true, period_s, LEAST_JUMP_N_M),
        "drag_n_m": drag(reflected, true, master_rad),
        "felt_error_rms_n_m": None if np.any(np.isnan(felt)) else float(np.sqrt(np.mean(felt**2))),
    }


def _at_best(truth: FloatArray, force_scale: float, configuration: BenchConfiguration) -> FloatArray:
    """What a pair would reflect that knew the truth of the cycle before."""
    law, given_n_m, given = reflection_of(configuration, force_scale), force_scale * float(truth[0]), []
    for true_n_m in [truth[0], *truth[:-1]]:
        given_n_m = law.reflected_n_m(given_n_m, float(true_n_m))
        given.append(given_n_m / force_scale)
    return np.array(given)


def rest_results(rests: Sequence[tuple[Swing, float]]) -> dict[str, Value]:
    """Of the rests of a trial.

    Args:
        rests: of each the widest swing of either joint, and the rms error while it lasted [N m].

    Returns:
        rest_error_rms_n_m; limit_cycle_amplitude_rad, the widest; limit_cycle_turns, the most; and whether there is a
        `limit_cycle`: a joint turned back at least four times by more than 8 encoder counts.
    """
    if not rests:
        return {}
    swings = [one for one, _ in rests]
    return {
        "rest_error_rms_n_m": float(np.sqrt(np.mean([error**2 for _, error in rests]))),
        "limit_cycle_amplitude_rad": max(one.amplitude_rad for one in swings),
        "limit_cycle_turns": max(one.turns for one in swings),
        "limit_cycle": any(one.is_limit_cycle for one in swings),
    }


def widest_swing(conveyed: Sequence[Conveyed], configuration: BenchConfiguration) -> Swing:
    """Of the joint that swings more: turns first, then amplitude."""
    slave = np.array([one.reading.slave.sample.position_rad for one in conveyed])
    master = np.array([one.reading.master.sample.position_rad for one in conveyed])
    found = [
        swing(position_rad, SWING_COUNTS * resolution_rad(bench.rig))
        for position_rad, bench in ((slave, configuration), (master, configuration.of_master()))
    ]
    return max(found, key=lambda one: (one.turns, one.amplitude_rad))


def _per_kg_n_m(configuration: BenchConfiguration) -> float:
    """What a kilogram more takes at 90 degrees."""
    return per_kg_a(configuration.rig) * torque_n_m_a(configuration.rig)
