"""Figs 2 and 3 as data: the measured points of a calibration, and its curves through them."""

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, Field

from bench.calibration.selection import friction_of
from bench.config.rig import Rig
from bench.store import CalibrationRow
from compensator.motor import dc_motor as motor
from compensator.motor.dc_motor import MotorConstants

CURVE_POINTS = 80


class Columns(BaseModel):
    """Points or a curve; speeds of the motor shaft, all folded onto positive ones."""

    motor_speed_rad_s: list[float]
    friction_a: list[float] = Field(description="current against friction alone (Fig. 2)")
    friction_duty: list[float] | None = Field(description="the same as duty, back-EMF included (Fig. 3)")


class Points(Columns):
    """Measured points."""

    backward: list[bool]
    trial_id: list[int | None]


class CurvePicture(BaseModel):
    """One load."""

    load_kg: float
    points: Points
    curve: Columns


class Picture(BaseModel):
    """Figs 2 and 3 of the paper as data."""

    calibration_id: int
    curves: list[CurvePicture]


def curve_data(row: CalibrationRow) -> Picture:
    """Per load: points and curve, speeds of the motor shaft, forwards counted as positive.

    Points are folded onto positive speeds: friction is odd. What accelerated the arm is taken off their currents and
    duties. `friction_duty` (Fig. 3) holds the back-EMF share; None where the rig does not say supply, R and Ke.
    """
    rig = Rig.model_validate(row.rig)
    known = rig.motor.resistance_ohm is not None and rig.motor.back_emf_v_s_rad is not None
    constants = MotorConstants(rig.motor.resistance_ohm or 1.0, rig.motor.back_emf_v_s_rad or 0.0) if known else None
    curves = []
    for curve in friction_of(row).curves:
        points = [one for one in row.result["points"] if one["load_kg"] == curve.load_kg]
        fastest = max(abs(one["speed_rad_s"]) for one in points)
        slowest = min(abs(one["speed_rad_s"]) for one in points)
        # dense where the Stribeck curve bends
        speed = np.geomspace(slowest, fastest, CURVE_POINTS)
        signs = np.sign([one["speed_rad_s"] for one in points])
        shown = np.abs([one["speed_rad_s"] for one in points])
        friction_a = signs * np.array([one["friction_a"] for one in points])
        curves.append(
            CurvePicture(
                load_kg=curve.load_kg,
                points=Points(
                    **dict(_columns(shown, friction_a, constants, rig.supply.voltage_v)),
                    backward=(signs < 0.0).tolist(),
                    trial_id=[one["trial_id"] for one in points],
                ),
                curve=_columns(speed, curve.curve().sliding_a(speed), constants, rig.supply.voltage_v),
            )
        )
    return Picture(calibration_id=row.id, curves=curves)


def _columns(
    speed: NDArray[np.float64],
    friction_a: NDArray[np.float64],
    constants: MotorConstants | None,
    supply_v: float | None,
) -> Columns:
    duty = None
    if constants is not None and supply_v is not None:
        duty = motor.friction_duty(constants, friction_a, speed, supply_v).tolist()
    return Columns(motor_speed_rad_s=speed.tolist(), friction_a=friction_a.tolist(), friction_duty=duty)
