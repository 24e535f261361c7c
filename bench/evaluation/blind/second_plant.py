"""Joints of the second plant, as the benchmark takes them: recordings and rig for the lab, and the oracle's word.

The only file that knows both the second plant and the lab's names. Names count for scoring alone.
"""

from dataclasses import dataclass, replace
from math import log

import numpy as np

from bench.config.rig import Arm, Gear, Motor, Rig, Sensor, Supply
from compensator.lab.recordings.recording import SESSION_START, Condition, Recording
from sim_backend.second_plant.draw import draw_joint
from sim_backend.second_plant.foreign_mechanisms import FOREIGN
from sim_backend.second_plant.joint import MECHANISMS, DrawnJoint, Level
from sim_backend.second_plant.oracle import Evidence, evidence, floor_of, laws_ratio
from sim_backend.second_plant.recording import SecondRecording, record

NAMES: dict[str, str] = {
    "asymmetric_coulomb": "coulomb_asymmetry",
    "asymmetric_viscous": "viscous_asymmetry",
    "square_drag": "viscous_quadratic",
    "tooth_loss": "load_friction",
    "tooth_loss_square": "load_friction_quadratic",
    "bearing_loss": "weight_friction",
    "back_driving_loss": "back_driving_friction",
    "quadrant_coulomb": "coulomb_quadrant",
    "cold_coulomb": "coulomb_temperature",
    "lubricant": "viscous_temperature",
    "running_in": "warm_up",
    "eccentric_gear": "position_periodic_friction",
    "cogging": "cogging",
    "spring": "spring",
    "turned_centre": "centre_of_mass_angle",
    "saturation": "torque_constant_saturation",
    "hot_winding": "winding_temperature",
    "long_bristles": "pre_sliding",
    "backlash": "backlash",
    "twist": "elasticity",
    "lag": "frictional_lag",
    "ageing_contact": "dwell_strengthening",
    "quick_breakaway": "rate_dependent_breakaway",
    "eccentric_encoder": "encoder_eccentricity",
    "sensor_gain": "current_gain_asymmetry",
    "blanking": "dead_time",
    "sag": "supply_sag",
    "emf_sheet": "back_emf_error",
}
"""Mechanism -> effect of the catalogue; the others are outside it."""

ABSORBED = {"asymmetric_coulomb": "offset", "emf_sheet": "viscous"}
"""Mechanism -> effect of every model that does the same: no recording of the joint can tell."""

LAWS: dict[str, str] = {
    "bristle_rad": "pre_sliding",
    "viscous_power": "viscous_power",
    "film_rad_s": "viscous_power",
    "path_scatter": "position_periodic_friction",
}
"""Quantity of a joint's own friction that is not as in textbooks -> effect of the catalogue that it is."""

ABOVE_1: dict[str, str] = {"viscous_power": "viscous_quadratic"}
"""The same for an exponent above 1, which the catalogue's power law has not."""

KNOWN = tuple(name for name in NAMES if name not in ABSORBED)
OUTSIDE = tuple(FOREIGN)
FIRST_SIZE, LEAST_RATIO = 0.1, 0.003
SCALINGS = 6  # sizes that are tried for an r
NEAR = 1.25  # factor: an r so near to the wanted one will do
LARGEST_STEP = 2.5  # of the logarithm of a size at once


@dataclass(frozen=True)
class SecondJoint:
    """A joint, and what the oracle says of it.

    Attributes:
        drawn: the joint.
        evidences: how far each of its mechanisms stands out alone, in their order.
        laws: r of its friction laws, as far as the base model does not have them.
    """

    drawn: DrawnJoint
    evidences: tuple[Evidence, ...]
    laws: float

    @property
    def truths(self) -> tuple[str, ...]:
        """Names of the mechanisms that it hides."""
        return tuple(hidden.name for hidden in self.drawn.hidden)

    @property
    def own(self) -> tuple[str, ...]:
        """Effects of the catalogue that its friction has by laws of its own, whatever it hides."""
        book, own = self.drawn.by_the_book().physics, self.drawn.physics
        differs = [quantity for quantity in LAWS if getattr(own, quantity) != getattr(book, quantity)]
        quick = {quantity for quantity in ABOVE_1 if getattr(own, quantity) > 1.0}
        return tuple(ABOVE_1[one] if one in quick else LAWS[one] for one in differs)

    @property
    def sizes(self) -> tuple[float, ...]:
        """Their sizes."""
        return tuple(hidden.size for hidden in self.drawn.hidden)


def second_joint(seed: int, names: tuple[str, ...], ratios: tuple[float, ...], level: Level) -> SecondJoint:
    """A joint that hides mechanisms of such sizes that each stands out by an r.

    Args:
        seed: of all that is drawn.
        names: of mechanisms.
        ratios: the r that each should have alone, as the joint is recorded for all of them.
        level: of the friction laws.
    """
    alone = [_of_ratio(seed, names, name, ratio, level) for name, ratio in zip(names, ratios, strict=True)]
    drawn = draw_joint(seed, names, [size for size, _ in alone], level)
    plain = replace(drawn, hidden=())
    laws = laws_ratio(plain, floor_of(plain, "")) if level == "foreign" else 0.0
    return SecondJoint(drawn, tuple(found for _, found in alone), laws)


def _of_ratio(seed: int, names: tuple[str, ...], name: str, wanted: float, level: Level) -> tuple[float, Evidence]:
    """The size by which one of the mechanisms stands out alone by an r, or the nearest that it can have; its evidence.

    What another one needs to be there at all may keep this one out of the recordings, as a voltage does a fault of the
    current's sensor.
    """
    most, size, floor = MECHANISMS[name].most, FIRST_SIZE, None
    tried: list[tuple[float, float]] = []
    found: list[tuple[float, Evidence]] = []
    for _ in range(SCALINGS):
        whole = draw_joint(seed, names, [size] * len(names), level)
        drawn = replace(whole, hidden=tuple(one for one in whole.hidden if one.name == name))
        floor = floor or floor_of(drawn, name)
        found.append((size, evidence(drawn, name, floor)))
        off = log(max(found[-1][1].ratio, LEAST_RATIO) / wanted)
        tried.append((log(size), off))
        if abs(off) < log(NEAR) or (size == most and off < 0.0):
            break
        size = min(float(np.exp(_next(tried))), most)
    return found[min(range(len(tried)), key=lambda at: abs(tried[at][1]))]


def _next(tried: list[tuple[float, float]]) -> float:
    """Where to look for a rising function's zero: between the nearest points of either sign, or beyond the last."""
    below = max((one for one in tried if one[1] < 0.0), default=None)
    above = min((one for one in tried if one[1] >= 0.0), default=None)
    if below is None or above is None or below[0] >= above[0]:
        place, off = tried[-1]
        return place - float(np.clip(off, -LARGEST_STEP, LARGEST_STEP))
    share = float(np.clip(-below[1] / (above[1] - below[1]), 0.2, 0.8))
    return below[0] + share * (above[0] - below[0])


def true_parameters(joint: SecondJoint) -> dict[tuple[str, str], float]:
    """Parameters of the base model of a joint that hides nothing, in the unit in which the lab has the effort.

    A torque constant, a gear ratio and an arm that are told count as they are told. None where the effort is estimated
    by a data sheet: what is off in that is in all of them.
    """
    drawn, rig, p = joint.drawn, rig_of(joint), joint.drawn.physics
    constant, ratio = rig.motor.torque_constant_n_m_a, rig.gear.ratio
    if drawn.sensors.effort == "estimate" or joint.own or joint.truths:
        return {}
    per_n_m, emf = 1.0 / p.torque_per_a, 0.0
    if drawn.sensors.effort == "torque":
        per_n_m = drawn.told.tolerance
    elif drawn.sensors.effort == "duty":
        per_n_m, emf = p.resistance_ohm / p.torque_per_a, p.emf_per_rad_s
    elif constant is not None and ratio is not None:
        per_n_m *= constant * ratio
    longer = drawn.arm.length_m / float(f"{drawn.arm.length_m:.3g}")
    return {
        ("inertia", "inertia"): per_n_m * (p.rotor_kg_m2 + p.arm_kg_m2),
        ("inertia", "load inertia scale"): per_n_m * longer**2,
        ("gravity", "arm moment"): per_n_m * p.moment_n_m,
        ("gravity", "load moment scale"): per_n_m * longer,
        ("coulomb", "Coulomb friction"): per_n_m * p.coulomb_n_m,
        ("viscous", "viscous friction"): per_n_m * p.viscous_n_m + emf,
        ("offset", "offset"): 0.0,
    }


def recordings_of(joint: SecondJoint) -> list[Recording]:
    """Every trial of a joint, for the lab."""
    return [_recording(joint.drawn, one) for one in record(joint.drawn)]


def _recording(drawn: DrawnJoint, one: SecondRecording) -> Recording:
    conditions: dict[str, Condition] = {"load_kg": one.load_kg}
    if not drawn.told.length_in_rig:
        conditions["arm_m"] = float(f"{drawn.arm.length_m:.3g}")
    if drawn.sensors.session_told:
        conditions[SESSION_START] = round(one.session_s, 1)
    return Recording(one.name, one.kind, conditions, one.channels)


def rig_of(joint: SecondJoint) -> Rig:
    """What the owner knows of a joint: as much as was drawn, rounded as data sheets are."""
    drawn, told, arm = joint.drawn, joint.drawn.told, joint.drawn.arm
    turns, constant = drawn.physics.turns, drawn.physics.torque_per_a / drawn.physics.turns

    def when(known: bool, value: float) -> float | None:
        return float(f"{value:.3g}") if known else None

    return Rig(
        name="second plant",
        motor=Motor(
            torque_constant_n_m_a=when(told.torque_constant, constant * told.tolerance),
            resistance_ohm=when(told.torque_constant, drawn.physics.resistance_ohm),
        ),
        gear=Gear(ratio=when(told.ratio, turns)),
        arm=Arm(
            length_m=when(told.length_in_rig, arm.length_m),
            inertia_kg_m2=when(told.inertia, arm.inertia_kg_m2),
            mass_kg=when(told.mass, arm.mass_kg),
            centre_of_mass_m=when(told.mass, arm.centre_m),
        ),
        sensor=Sensor(counts_per_turn=drawn.sensors.counts_per_turn if told.counts else None),
        supply=Supply(voltage_v=drawn.physics.supply_v, is_nominal=True if told.nominal else None),
    )
