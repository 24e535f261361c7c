"""A small simulated example of an effect: what it adds to the effort of a joint that is swung with two loads.

The joint is drawn from no recording: its equation stands here, and the effect's columns are those that models are
fitted with. It is to be looked at; nothing is concluded from it.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from compensator.lab.effects.catalogue import default_effects, effect_named
from compensator.lab.effects.effect import Effect, Parameter
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.recordings.facts import STANDARD_GRAVITY_M_S2, EffortQuantity, Facts
from compensator.lab.recordings.recording import SESSION_START, FloatArray, Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Dataset, Processing
from compensator.lab.rows.drivers import DRIVERS

SHARE = 0.3  # of the effort, RMS, that the effect makes
RATE_HZ, DURATION_S, CUTOFF_HZ = 200.0, 10.0, 12.0
LOADS_KG = (0.05, 0.15)
SINES = ((0.9, 0.15), (0.35, 0.55))  # amplitude [rad], frequency [Hz]
ARM_M, INERTIA_KG_M2, ARM_MOMENT_N_M, COULOMB_N_M, VISCOUS_N_M_S = 0.3, 0.02, 0.1, 0.08, 0.03
TORQUE_PER_CURRENT_N_M_A = 1.0
RESTS_S, RAMP_S = ((2.6, 3.0), (6.0, 7.2)), 0.05  # from, to; how quickly it stops
SENSED = "load_torque_n_m"
SMOOTH_RAD_S = 0.02  # of the example's sign of speed
SWUNG = "A joint swings to and fro and rests twice."


@dataclass(frozen=True)
class ExampleTrial:
    """One swing. Arrays have shape (rows,).

    Attributes:
        load_kg: at the tip.
        driver: the effect's driving variable.
        without: effort of the joint without the effect; effect: what it adds.
    """

    load_kg: float
    time_s: FloatArray
    driver: FloatArray
    without: FloatArray
    effect: FloatArray


@dataclass(frozen=True)
class Example:
    """An effect on a joint.

    Attributes:
        effect: which.
        motion: what the joint does, in a sentence.
        effort_unit, driver_title, driver_unit: of the values.
        trials: one per load.
    """

    effect: Effect
    motion: str
    effort_unit: str
    driver_title: str
    driver_unit: str
    trials: tuple[ExampleTrial, ...]


def example_of(name: str) -> Example:
    """The example of an effect.

    Raises:
        UnknownEffectError: there is no such effect.
        NotApplicableError: it does not show on a joint like this.
    """
    effect = effect_named(name)
    quantity: EffortQuantity = "torque" if not effect.efforts or "torque" in effect.efforts else "current_estimate"
    dataset = _joint(quantity, SENSED in effect.channels)
    shapes = effect.shapes(dataset.trials[0].motion)
    added = _added(dataset.columns(effect, shapes[len(shapes) // 2]), effect.parameters, dataset.effort)
    driver = DRIVERS[effect.driver]
    trials = []
    for trial, rows, load_kg in zip(dataset.trials, dataset.trial_rows, LOADS_KG, strict=True):
        values = dataset.rows_of([driver.of(one) for one in dataset.trials])[rows]
        trials.append(ExampleTrial(load_kg, dataset.time_of(trial), values, dataset.effort[rows], added[rows]))
    unit = dataset.effort_definition.unit
    return Example(effect, SWUNG, unit, driver.title, driver.unit_in(unit, dataset.facts), tuple(trials))


def _added(columns: FloatArray, parameters: tuple[Parameter, ...], effort: FloatArray) -> FloatArray:
    """What columns (n, k) add, as large as is to be seen beside the effort."""
    signs = [-1.0 if one.high <= 0.0 else 1.0 for one in parameters]
    # of a sine and its cosine, or two stiffnesses, the second is to be seen but not to hide the first
    raw: FloatArray = columns @ np.array([sign / (1.0 + index) for index, sign in enumerate(signs)])
    size = float(np.sqrt(np.mean(raw**2)))
    return raw * (SHARE * float(np.sqrt(np.mean(effort**2))) / size if size > 0.0 else 0.0)


@cache
def _joint(quantity: EffortQuantity, sensed: bool = False) -> Dataset:
    """The joint without anything special, with the effort that its model predicts: some effects build on that."""
    fit = _fitted(quantity, sensed)
    return with_own_prediction(fit.dataset, fit.terms)


@cache
def _fitted(quantity: EffortQuantity, sensed: bool = False) -> Fit:
    """The model of the joint, with a sensor of the load where one is needed."""
    facts = Facts(
        torque_per_current_n_m_a=TORQUE_PER_CURRENT_N_M_A,
        gear_ratio=20.0,
        backlash_rad=0.01,
        arm_m=ARM_M,
        supply_is_nominal=True,
        effort=quantity,
    )
    recordings = [_recording(load_kg, number, sensed) for number, load_kg in enumerate(LOADS_KG)]
    dataset = make_dataset(recordings, facts, Processing(CUTOFF_HZ, "all"))
    return fit_model(dataset, list(default_effects(facts)))


def _recording(load_kg: float, number: int, sensed: bool) -> Recording:
    time_s = np.arange(0.0, DURATION_S, 1.0 / RATE_HZ)
    v = _moving(time_s) * _swing(time_s)
    q, a = np.cumsum(v) / RATE_HZ, np.gradient(v, time_s)
    torque = (INERTIA_KG_M2 + load_kg * ARM_M**2) * a + VISCOUS_N_M_S * v + COULOMB_N_M * np.tanh(v / SMOOTH_RAD_S)
    carried = (ARM_MOMENT_N_M + load_kg * STANDARD_GRAVITY_M_S2 * ARM_M) * np.sin(q)
    torque += carried
    current = torque / TORQUE_PER_CURRENT_N_M_A
    channels = {
        "time_s": time_s,
        "position_rad": q,
        "torque_n_m": torque,
        "current_estimate_a": current,
        "temperature_c": 25.0 + 10.0 * number + 5.0 * time_s / DURATION_S,
    }
    if sensed:
        channels[SENSED] = carried
    conditions: dict[str, float | str | bool] = {
        "load_kg": load_kg,
        "arm_m": ARM_M,
        SESSION_START: number * DURATION_S,
    }
    return Recording(f"swing-{number + 1}", "sines", conditions, channels)


def _swing(time_s: FloatArray) -> FloatArray:
    """Speed without the rests [rad/s]."""
    turns = [(amplitude, 2.0 * np.pi * hz) for amplitude, hz in SINES]
    speed: FloatArray = np.sum([amplitude * w * np.cos(w * time_s) for amplitude, w in turns], axis=0)
    return speed


def _moving(time_s: FloatArray) -> FloatArray:
    """1 while the joint swings, 0 while it rests, smooth between them; shape as the time."""
    share = np.ones_like(time_s)
    for from_s, to_s in RESTS_S:
        share *= 1.0 - 0.25 * (1.0 + np.tanh((time_s - from_s) / RAMP_S)) * (1.0 + np.tanh((to_s - time_s) / RAMP_S))
    return share
