"""Friction curves and motor constants from a speed sweep, kept in the store, and which of them a bench uses."""

from bench.calibration.calibrate import calibrate
from bench.calibration.curve_data import curve_data
from bench.calibration.selection import friction_of, in_use, use, with_calibration, with_friction

__all__ = ["calibrate", "curve_data", "friction_of", "in_use", "use", "with_calibration", "with_friction"]
