"""Figs 2 and 3: what a balanced joint needs at a steady speed, load after load, and the curves fitted to it."""

from collections.abc import Sequence
from math import pi

import numpy as np

from bench.calibration import friction_of
from bench.calibration.curve_data import Columns, CurvePicture, curve_data
from bench.calibration.curves import Curve, Estimate
from bench.config.friction_curves import FrictionCurve
from bench.config.rig import Rig
from bench.evaluation.paper.row import FIG_2, FIG_3, Row
from bench.report import Figure, Line, Points, Section, Table, shades
from bench.store import CalibrationRow
from compensator.motor import dc_motor as motor
from compensator.motor.dc_motor import MotorConstants

RPM = 60.0 / (2.0 * pi)
SHOWN_SPEED_RPM = 1200.0
SHOWN_CURRENT_A = 0.5
COUNTS = 1000.0


def friction_curves(row: CalibrationRow) -> list[Row]:
    """The rows fig-2 and fig-3, of a calibration whose rig knows R, Ke and supply."""
    pictures, curves = curve_data(row).curves, friction_of(row).curves
    duties = [_duty_at(curve, SHOWN_SPEED_RPM / RPM, Rig.model_validate(row.rig)) for curve in curves]
    fastest_rpm = max(max(one.points.motor_speed_rad_s) for one in pictures) * RPM
    speed_rpm = _speed_at(curves[0], SHOWN_CURRENT_A) * RPM
    scatter_ma = 1e3 * float(np.median([curve["scatter_a"] for curve in row.result["curves"]]))
    source = {"experiment_ids": tuple(row.experiment_ids), "trial_ids": tuple(row.trial_ids)}
    fig_2 = Section(
        title="Fig. 2: steady speed against constant current, balanced arm",
        sentences=[
            "Points are strokes at constant current, duty or speed, both directions folded into one; what an arm still "
            "gained in speed is taken off with its inertia, which is fitted along. Lines are eq. (2), fitted load by "
            f"load. Within the travel of this arm the motor reaches {fastest_rpm:.0f} rpm; beyond, the curve is "
            f"extended: {speed_rpm:.0f} rpm at {1e3 * SHOWN_CURRENT_A:.0f} mA without load (paper: about "
            f"{FIG_2['speed_at_500_ma_rpm']:.0f} rpm). Median scatter about the curves: {scatter_ma:.2f} mA.",
        ],
        tables=[_parameters(row)],
        figures=[_figure(pictures, "Friction of the balanced joint", speed_up=True)],
    )
    fig_3 = Section(
        title="Fig. 3: the friction part of the duty against speed",
        sentences=[
            f"The duty that turns the balanced joint, back-EMF included. At {SHOWN_SPEED_RPM:.0f} rpm it is "
            f"{COUNTS * duties[0]:.0f} counts of 1000 without load and {COUNTS * duties[-1]:.0f} under the heaviest "
            f"(paper: about {COUNTS * FIG_3['duty_at_1200_rpm_lightest']:.0f}).",
        ],
        figures=[_figure(pictures, "Friction part of the duty", speed_up=False)],
    )
    numbers_2 = {"speed_at_500_ma_rpm": speed_rpm, "fastest_measured_rpm": fastest_rpm, "median_scatter_ma": scatter_ma}
    numbers_3 = {"duty_at_1200_rpm_lightest": duties[0], "duty_at_1200_rpm_heaviest": duties[-1]}
    return [
        Row("fig-2", fig_2, dict(numbers_2), dict(FIG_2), **source),
        Row("fig-3", fig_3, dict(numbers_3), dict(FIG_3), **source),
    ]


def _figure(pictures: Sequence[CurvePicture], title: str, speed_up: bool) -> Figure:
    """Fig. 2 has the speed upwards over the current, Fig. 3 the duty over the speed."""
    drawn: list[Line | Points] = []
    for one, colour in zip(pictures, shades(len(pictures)), strict=True):
        x, y = (_columns(one.points, speed_up), _columns(one.curve, speed_up))
        drawn.append(Points(f"{1e3 * one.load_kg:g} g, measured", *x, colour=colour, in_legend=False))
        drawn.append(Line(f"{1e3 * one.load_kg:g} g", *y, colour=colour))
    speed, current, duty = "motor speed [rpm]", "current [mA]", "duty [1/1000]"
    return Figure(title, current, speed, drawn) if speed_up else Figure(title, speed, duty, drawn)


def _columns(columns: Columns, speed_up: bool) -> tuple[list[float], list[float]]:
    speed_rpm = [RPM * value for value in columns.motor_speed_rad_s]
    if speed_up:
        return [1e3 * value for value in columns.friction_a], speed_rpm
    return speed_rpm, [COUNTS * value for value in columns.friction_duty or []]


def _parameters(row: CalibrationRow) -> Table:
    names = ("coulomb_a", "static_a", "stribeck_speed_rad_s", "viscous_a_s_rad")
    scales = (1e3, 1e3, 1.0, 1e3)
    rows = []
    for curve in map(Curve.model_validate, row.result["curves"]):
        found = [curve.parameters[name] for name in names]
        cells = [_with_interval(one, scale) for one, scale in zip(found, scales, strict=True)]
        rows.append((1e3 * curve.load_kg, 1e3 * curve.f_load_a, *cells))
    columns = ["load [g]#", "F_load [mA]#", "Coulomb [mA]#", "static [mA]#", "Stribeck [rad/s]#", "viscous [mA s/rad]#"]
    return Table("General Kinetic Friction, eq. (2), with half of the 95 % interval", columns, rows)


def _with_interval(one: Estimate, scale: float) -> str:
    value = float("nan") if one.value is None else one.value
    if one.low is None or one.high is None:
        return f"{scale * value:.4g}"
    return f"{scale * value:.4g} ± {scale * (one.high - one.low) / 2.0:.2g}"


def _speed_at(curve: FrictionCurve, current_a: float) -> float:
    """The fastest speed [rad/s] that a current holds: beyond the Stribeck range friction is a straight line."""
    return (current_a - curve.coulomb_a) / curve.viscous_a_s_rad if curve.viscous_a_s_rad > 0.0 else float("nan")


def _duty_at(curve: FrictionCurve, speed_rad_s: float, rig: Rig) -> float:
    constants = MotorConstants(rig.motor.resistance_ohm or 0.0, rig.motor.back_emf_v_s_rad or 0.0)
    friction_a = float(curve.curve().sliding_a(speed_rad_s))
    return motor.friction_duty(constants, friction_a, speed_rad_s, rig.supply.voltage_v or float("nan"))
