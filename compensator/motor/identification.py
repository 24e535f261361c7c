"""Resistance and back-EMF constant from steady samples, locked and running (paper, eq. 3):  Vs d = R I + Ke w + c.

What can be told depends on what was measured. c takes up the zero error of current sensor and stage.

- Current measured, joint locked (standing under a duty below its friction, or held): R.
- Current measured, running in both directions, or at several speeds: Ke, too.
- Current never measured: neither. A balanced joint in steady motion obeys Vs d = R I_friction(w) + Ke w, and
  (R, I_friction, Ke) and (k R, I_friction / k, Ke), or any Ke with its difference put into I_friction, give the same
  duties at the same speeds: no number of samples tells them apart. Two lumps are all that shows: R Fc [V] and
  Ke + R b [V s/rad], where b is the slope of friction over speed. Where friction does not fall with speed, beyond the
  Stribeck range, b is 0 or more, and the second lump an upper bound of Ke.

The regression is of the current on voltage and speed, I = (Vs d - Ke w - c) / R, since the noise is the current's: the
other way round it would make R too small, and a Ke to match look sure. The gain of a current sensor goes into R
undetected. A voltage lost in the sense of the current (brushes, dead time of the stage) is not modelled; where currents
are measured it shows in `residual_a`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, nan
from typing import NamedTuple

import numpy as np

from compensator.errors import CalibrationError
from compensator.line_fit import Interval, fit_line
from compensator.motion.kinetic_friction import FloatArray

LEAST_SAMPLES = 5  # three parameters and some to tell how sure they are
TOLD = 0.5  # half an interval over its value: beyond, a parameter counts as not identified
FAST = 0.5  # of the highest speed: above, the Stribeck range is left behind
NO_CURRENT = (
    "the current was not measured: R and Ke cannot be told apart from friction by duty and speed alone. What settles "
    "it: an ohmmeter at the motor's leads for R, and for Ke the voltage between open leads while the shaft is turned "
    "at a known speed (or readings of the current, locked and running)"
)
NOTHING_LOCKED = (
    "no locked sample with a current. Hold duties below the friction, or hold the joint, and read the current"
)
NOTHING_RUNNING = (
    "no running sample with a current. Ke shows only in motion: run in both directions, and read the current"
)


class MotorSample(NamedTuple):
    """Means over a steady window. Signs of duty, speed and current go together.

    Attributes:
        duty: -1 .. 1.
        supply_v: [V].
        speed_rad_s: of the motor shaft; 0 where locked.
        current_a: measured; NaN where it is not. Never the one of eq. (3), which holds R and Ke already.
    """

    duty: float
    supply_v: float
    speed_rad_s: float
    current_a: float = nan

    @property
    def locked(self) -> bool:
        """True when the shaft stood."""
        return self.speed_rad_s == 0.0


@dataclass(frozen=True, slots=True)
class MotorIdentification:
    """What the samples tell, and what they do not.

    Attributes:
        resistance_ohm, back_emf_v_s_rad: with 95 % intervals; None where they cannot be told.
        back_emf_bound_v_s_rad: Ke + R b, which Ke does not exceed; None where the samples do not show it.
        friction_v: R Fc, the voltage that Coulomb friction takes [V]; None where the samples do not show it. Both
            mean something for running samples of one load only.
        offset_v: c; None without currents of both signs.
        unidentified: for each parameter that is None, why, and what would settle it.
        residual_a: standard deviation of what the fit leaves of the currents [A]; NaN where none is measured.
    """

    resistance_ohm: Interval | None
    back_emf_v_s_rad: Interval | None
    back_emf_bound_v_s_rad: Interval | None
    friction_v: Interval | None
    offset_v: Interval | None
    unidentified: dict[str, str]
    residual_a: float


def identify(samples: Sequence[MotorSample]) -> MotorIdentification:
    """Identify what the samples allow.

    Args:
        samples: steady windows; with and without measured current, locked and running, in any mixture.

    Raises:
        CalibrationError: no samples, one that is not finite (NaN currents aside), or too few to tell how sure one is.
    """
    _check(samples)
    known = [one for one in samples if np.isfinite(one.current_a)]
    running = [one for one in samples if not one.locked]
    bound, friction_v = _lumps(running)
    if not known:
        unknown = dict.fromkeys(("resistance_ohm", "back_emf_v_s_rad"), NO_CURRENT)
        return MotorIdentification(None, None, bound, friction_v, None, unknown, nan)
    if len(known) < LEAST_SAMPLES:
        raise CalibrationError(
            f"there are {len(known)} samples with a measured current; allowed is at least {LEAST_SAMPLES}. Take more"
        )
    return _with_currents(known, bound, friction_v)


def _check(samples: Sequence[MotorSample]) -> None:
    if not samples:
        raise CalibrationError(f"there are 0 samples; allowed is at least {LEAST_SAMPLES}")
    units = {"duty": "", "supply_v": " V", "speed_rad_s": " rad/s"}
    for number, sample in enumerate(samples):
        for name, unit in units.items():
            if not np.isfinite(getattr(sample, name)):
                raise CalibrationError(f"{name} of sample {number} is {getattr(sample, name)}{unit}; allowed is finite")
        if not abs(sample.duty) <= 1.0:
            raise CalibrationError(f"duty of sample {number} is {sample.duty:.4g}; allowed is -1 .. 1")
        if sample.supply_v <= 0.0:
            raise CalibrationError(f"supply_v of sample {number} is {sample.supply_v:.4g} V; allowed is above 0 V")
        if np.isinf(sample.current_a):
            raise CalibrationError(f"current_a of sample {number} is {sample.current_a} A; allowed is finite, or NaN")


def _with_currents(
    known: list[MotorSample], bound: Interval | None, friction_v: Interval | None
) -> MotorIdentification:
    any_running = any(not one.locked for one in known)
    both_signs = min(one.current_a for one in known) < 0.0 < max(one.current_a for one in known)
    columns = [_voltages(known)]
    if any_running:
        columns.append(np.array([one.speed_rad_s for one in known]))
    if both_signs:
        columns.append(np.ones(len(known)))
    line = fit_line(np.column_stack(columns), np.array([one.current_a for one in known]))
    resistance, back_emf = line.inverse(), line.ratio(1) if any_running else None
    unidentified = {}
    if not _is_told(resistance):
        locked = any(one.locked for one in known)
        unidentified["resistance_ohm"] = _too_alike("R") if locked else f"{_too_alike('R')}; there is {NOTHING_LOCKED}"
    if back_emf is None:
        unidentified["back_emf_v_s_rad"] = f"there is {NOTHING_RUNNING}"
    elif not _is_told(back_emf):
        unidentified["back_emf_v_s_rad"] = _too_alike("Ke")
    return MotorIdentification(
        resistance_ohm=None if "resistance_ohm" in unidentified else resistance,
        back_emf_v_s_rad=None if "back_emf_v_s_rad" in unidentified else back_emf,
        back_emf_bound_v_s_rad=bound,
        friction_v=friction_v,
        offset_v=line.ratio(-1) if both_signs and line.told else None,
        unidentified=unidentified,
        residual_a=line.residual,
    )


def _is_told(parameter: Interval) -> bool:
    return 0.0 < parameter.value < inf and parameter.high - parameter.low <= 2.0 * TOLD * parameter.value


def _too_alike(name: str) -> str:
    return (
        f"the samples do not determine {name} within {TOLD:.0%}: currents and speeds rise and fall together, or hardly "
        "vary. Add locked samples at several duties, and running ones in both directions at several speeds and loads"
    )


def _lumps(running: list[MotorSample]) -> tuple[Interval | None, Interval | None]:
    """(Ke + R b, R Fc), from the voltage over the faster speeds: a line with a step at 0."""
    fastest = max((abs(one.speed_rad_s) for one in running), default=0.0)
    fast = [one for one in running if abs(one.speed_rad_s) >= FAST * fastest]
    speeds = np.array([one.speed_rad_s for one in fast])
    if len(fast) < LEAST_SAMPLES or not (np.any(speeds > 0.0) and np.any(speeds < 0.0)):
        return None, None
    if np.ptp(np.abs(speeds)) < 0.2 * fastest:
        return None, None  # one speed shows no slope
    line = fit_line(np.column_stack([speeds, np.sign(speeds)]), _voltages(fast))
    return line.coefficient(0), line.coefficient(1)


def _voltages(samples: list[MotorSample]) -> FloatArray:
    return np.array([one.supply_v * one.duty for one in samples])
