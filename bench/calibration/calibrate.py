"""A calibration out of experiments in the store: fitted, and kept with all that it was made from.

Trials of this bench keep what each stroke measured. A recording set has samples alone: it is cut into short windows,
and a parabola through the positions of each gives its speed and acceleration.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from itertools import pairwise
from math import sin

import numpy as np

from bench.calibration.curves import friction_fits, inertia_of, rise_offset_of
from bench.calibration.points import FrictionPoint, Row, friction_points, identify_motor
from bench.calibration.rest import rest_of
from bench.calibration.selection import drive_of_experiment
from bench.calibration.sides import one_sided
from bench.config.rig import Rig
from bench.json_types import Value
from bench.provenance import software
from bench.store import Experiment, Store, Trial
from bench.store.tables.json_text import plain
from compensator.errors import CalibrationError
from compensator.lab.recordings.recording import Recording
from compensator.motion.friction_calibration import FrictionFit
from compensator.motion.kinetic_friction import FloatArray
from compensator.motor import dc_motor as motor
from compensator.motor.dc_motor import MotorConstants

WINDOW_S = 0.2
LEAST_ROWS = 8  # of a window
LEAST_COUNTS = 20.0  # that the sensor moves within a window
LOSES, GAINS = 0.005, 0.05  # of its speed, that a window may lose or gain: slower, and the teeth may have parted
UPRIGHT = 0.1  # |sin| of an angle below which gravity has no moment worth the name
FROM_SEARCH = "zero-speed search at angle 0"
FROM_CURVE = "static friction of the curve"


def points_of_recording(recording: Recording, rig: Rig, trial_id: int | None = None) -> list[FrictionPoint]:
    """The points that a trial shows.

    Args:
        recording: with time_s, position_rad, a current (or what eq. (3) needs) and the condition load_kg.
        rig: gear ratio and encoder counts; resistance and back-EMF constant where no current was measured.
        trial_id: kept with every point.

    Raises:
        CalibrationError: the joint was not balanced, or a channel, a condition or a value of the rig is missing.
    """
    load_kg = recording.conditions.get("load_kg")
    if recording.conditions.get("balanced") is not True or not isinstance(load_kg, float | int):
        raise CalibrationError(
            f"trial '{recording.name}' has balanced = {recording.conditions.get('balanced')} and load_kg = {load_kg}; "
            "allowed is balanced = true and a load: gravity would be taken for friction. Add both to trials.csv"
        )
    if rig.gear.ratio is None or rig.sensor.counts_per_turn is None:
        raise CalibrationError(
            f"rig '{rig.name}': gear.ratio and sensor.counts_per_turn are needed to tell motion from rest; add them"
        )
    time_s, shaft_rad = _channel(recording, "time_s"), _channel(recording, "position_rad") * rig.gear.ratio
    current_a, duty = _current_a(recording, rig), recording.channels.get("duty", np.full_like(time_s, np.nan))
    least_rad = LEAST_COUNTS * 2.0 * np.pi / rig.sensor.counts_per_turn
    points = []
    for rows in _windows(time_s):
        mid_s = time_s[rows] - np.mean(time_s[rows])
        half_acceleration, speed, _ = np.polyfit(mid_s, shaft_rad[rows], 2)
        span_s = float(np.ptp(mid_s))
        change = 2.0 * half_acceleration * span_s * np.sign(speed)
        moves = abs(speed) * span_s >= least_rad and -LOSES * abs(speed) <= change <= GAINS * abs(speed)
        if moves and np.all(np.isfinite(current_a[rows])):
            means = float(np.mean(current_a[rows])), float(np.mean(duty[rows]))
            point = FrictionPoint(float(load_kg), float(speed), float(2.0 * half_acceleration), *means, trial_id)
            points.append(point)
    return points


def _windows(time_s: FloatArray) -> list[slice]:
    """Windows of a fifth of a second, one after the other, each with enough rows and no gap."""
    edges = np.searchsorted(time_s, np.arange(time_s[0], time_s[-1], WINDOW_S))
    period_s = float(np.median(np.diff(time_s)))
    found = []
    for first, last in pairwise(edges.tolist()):
        whole = last - first >= LEAST_ROWS and np.max(np.diff(time_s[first:last])) < 3.0 * period_s
        if whole:
            found.append(slice(first, last))
    return found


def _current_a(recording: Recording, rig: Rig) -> FloatArray:
    """Measured, estimated when it was recorded, or by eq. (3)."""
    for name in ("current_a", "current_estimate_a"):
        found = recording.channels.get(name)
        if found is not None and np.any(np.isfinite(found)):
            return found
    resistance_ohm, back_emf_v_s_rad = rig.motor.resistance_ohm, rig.motor.back_emf_v_s_rad
    if resistance_ohm is None or back_emf_v_s_rad is None or rig.gear.ratio is None:
        raise CalibrationError(
            f"trial '{recording.name}' has no current, and rig '{rig.name}' lacks the motor.resistance_ohm and "
            "motor.back_emf_v_s_rad that the paper's eq. (3) takes it from; add one or the other"
        )
    speed = np.gradient(_channel(recording, "position_rad"), _channel(recording, "time_s")) * rig.gear.ratio
    voltage_v = _channel(recording, "duty") * _channel(recording, "supply_v")
    return motor.current_a(MotorConstants(resistance_ohm, back_emf_v_s_rad), voltage_v, speed, 1.0)


def _channel(recording: Recording, name: str) -> FloatArray:
    if name not in recording.channels:
        raise CalibrationError(f"trial '{recording.name}' has no channel {name}; a friction curve needs it")
    return recording.channels[name]


def calibrate(store: Store, experiment_ids: Sequence[int], stribeck: bool = True, note: str = "") -> int:
    """Fit and keep a calibration. Returns its id.

    Args:
        store: holds the experiments, and will hold the calibration.
        experiment_ids: speed sweeps, or imported trials of the balanced joint; and load sweeps, whose zero-speed
            searches at angle 0 give the F_load of each load, and those at another angle what the gear
            loses. All of one rig and one drive.
        stribeck: False leaves out static friction: for trials without low speeds.
        note: kept with it.

    Raises:
        NotFoundError: no such experiment.
        CalibrationError: the experiments differ in rig, drive or source, or cannot carry two friction curves.
    """
    experiments = [store.experiment(one) for one in dict.fromkeys(experiment_ids)]
    if not experiments:
        raise CalibrationError("there are 0 experiments to calibrate from; name a speed sweep")
    _check_alike(experiments)
    trials = [trial for one in experiments for trial in store.trials(one.id) if trial.outcome == "completed"]
    rig, first = Rig.model_validate(experiments[0].rig), experiments[0]
    result, used = fit_trials(store, trials, rig, stribeck)
    return store.calibrations.add(
        note=note,
        source=first.source,
        rig=first.rig,
        drive=drive_of_experiment(first),
        provenance={"software": software()},
        experiment_ids=[one.id for one in experiments],
        trial_ids=used,
        result=plain(result),
    )


def fit_trials(
    store: Store, trials: Sequence[Trial], rig: Rig, stribeck: bool = True
) -> tuple[dict[str, Value], list[int]]:
    """What trials tell: curves, points, motor constants as JSON-able values; and the ids of the trials used.

    Raises:
        CalibrationError: they cannot carry two friction curves.
    """
    rows: list[Row] = [
        {**trial.conditions, **trial.results, "trial_id": trial.id}
        for trial in trials
        if "motor_speed_rad_s" in trial.results
    ]
    points = _points(store, trials, rows, rig)
    if len(points) < 2:
        raise CalibrationError(
            f"the trials show the balanced joint in motion under {len(points)} loads; allowed is two or more. Run a "
            "speed sweep over more loads"
        )
    fits = friction_fits(points, stribeck)
    rest = rest_of(trials, rig)
    searched = {
        load_kg: (rest.friction_a.get(load_kg, friction_a), ids)
        for load_kg, (friction_a, ids) in f_loads(trials).items()
    }
    used = {one.trial_id for found in points.values() for one in found if one.trial_id is not None}
    used |= set(rest.trial_ids)
    used |= {trial_id for _, ids in searched.values() for trial_id in ids}
    result: dict[str, Value] = {
        "stribeck": stribeck,
        "curves": [_curve(load_kg, fits[load_kg], searched) for load_kg in points],
        "points": [_point(one, inertia_of(fits[one.load_kg])) for found in points.values() for one in found],
        "motor": _motor(rows),
        "rest": None if rest.settings is None else rest.settings.model_dump(),
        "rest_unidentified": rest.why_not,
        "rest_one_sided": "" if rest.settings is None else one_sided(trials),
    }
    return result, sorted(used)


def _check_alike(experiments: Sequence[Experiment]) -> None:
    first = experiments[0]
    for other in experiments[1:]:
        for name, one, two in (
            ("rig", first.rig, other.rig),
            ("drive", drive_of_experiment(first), drive_of_experiment(other)),
            ("source", first.source, other.source),
        ):
            if one != two:
                raise CalibrationError(
                    f"the {name} of experiment {other.id} differs from that of experiment {first.id}; allowed is the "
                    "same: a calibration holds for one joint. Calibrate them apart"
                )


def _points(
    store: Store, trials: Sequence[Trial], rows: Sequence[Row], rig: Rig
) -> Mapping[float, Sequence[FrictionPoint]]:
    """From the results of trials where they have them, else from their samples."""
    known = {row["trial_id"] for row in rows}
    recorded = [trial for trial in trials if trial.id not in known and trial.conditions.get("balanced") is True]
    points: dict[float, list[FrictionPoint]] = defaultdict(list)
    if rows or not recorded:
        points |= friction_points(rows)
    for trial in recorded:
        for one in points_of_recording(store.recording(trial.id), rig, trial.id):
            points[one.load_kg].append(one)
    return {load_kg: points[load_kg] for load_kg in sorted(points) if points[load_kg]}


def f_loads(trials: Sequence[Trial]) -> dict[float, tuple[float, list[int]]]:
    """Mean F_load [A] of the searches at angle 0 under each load, and the trials that it is from."""
    found: dict[float, list[tuple[float, int]]] = defaultdict(list)
    for trial in trials:
        friction_a, angle_rad = trial.results.get("friction_current_a"), trial.conditions.get("angle_rad")
        if friction_a is not None and isinstance(angle_rad, float) and abs(sin(angle_rad)) < UPRIGHT:
            found[float(trial.conditions["load_kg"])].append((friction_a, trial.id))
    return {
        load_kg: (sum(friction_a for friction_a, _ in each) / len(each), [trial_id for _, trial_id in each])
        for load_kg, each in found.items()
    }


def _curve(load_kg: float, fit: FrictionFit, searched: Mapping[float, tuple[float, list[int]]]) -> dict[str, Value]:
    f_load_a = searched[load_kg][0] if load_kg in searched else fit.curve.static_a
    return {
        "load_kg": load_kg,
        "f_load_a": f_load_a,
        "f_load_from": FROM_SEARCH if load_kg in searched else FROM_CURVE,
        **asdict(fit.curve),
        "offset_a": fit.parameters["offset_a"].value,
        "rise_offset_a": rise_offset_of(fit),
        "inertia_a_s2_rad": inertia_of(fit),
        "parameters": {name: one._asdict() for name, one in fit.parameters.items()},
        "scatter_a": fit.scatter_a,
        "points": fit.points,
    }


def _point(one: FrictionPoint, inertia_a_s2_rad: float) -> dict[str, Value]:
    return asdict(one) | {"friction_a": one.current_a - inertia_a_s2_rad * one.acceleration_rad_s2}


def _motor(rows: Sequence[Row]) -> dict[str, Value]:
    """What the rows tell of R and Ke; and why, where they do not."""
    try:
        found = identify_motor(rows)
    except CalibrationError as error:
        return {"unidentified": {"resistance_ohm": str(error), "back_emf_v_s_rad": str(error)}}
    values = {name: getattr(found, name) for name in found.__dataclass_fields__ if name != "unidentified"}
    intervals = {name: one._asdict() if hasattr(one, "_asdict") else one for name, one in values.items()}
    return {**intervals, "unidentified": found.unidentified}
