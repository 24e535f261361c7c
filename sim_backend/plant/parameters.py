"""The whole plant: one component each for what it is made of. Mechanisms that are off have an amplitude of 0."""

import difflib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from typing import Any

from sim_backend.drive.overload import Overload
from sim_backend.environment.end_stops import EndStops, Wall
from sim_backend.environment.operator import Operator
from sim_backend.errors import ParameterError
from sim_backend.mechanisms.friction.bristle import Bristle
from sim_backend.mechanisms.friction.coulomb_asymmetry import CoulombAsymmetry
from sim_backend.mechanisms.friction.drag import Drag
from sim_backend.mechanisms.friction.dwell import Dwell
from sim_backend.mechanisms.friction.friction import Friction
from sim_backend.mechanisms.friction.friction_jump import FrictionJump
from sim_backend.mechanisms.friction.hose import Hose
from sim_backend.mechanisms.friction.load_friction import LoadFriction
from sim_backend.mechanisms.friction.lubricant import Lubricant
from sim_backend.mechanisms.friction.periodic_friction import PeriodicFriction
from sim_backend.mechanisms.friction.run_in import RunIn
from sim_backend.mechanisms.friction.scatter import Scatter
from sim_backend.mechanisms.friction.viscous_asymmetry import ViscousAsymmetry
from sim_backend.mechanisms.joint.brake import Brake
from sim_backend.mechanisms.joint.clutch import Clutch
from sim_backend.mechanisms.joint.contact import Gear
from sim_backend.mechanisms.joint.eccentricity import Eccentricity
from sim_backend.mechanisms.joint.gravity import STANDARD_GRAVITY_M_S2, Arm, CentreOfMass, Load
from sim_backend.mechanisms.joint.sensing import Encoder, Latency
from sim_backend.mechanisms.joint.shaft import Shaft
from sim_backend.mechanisms.joint.spring import Spring
from sim_backend.mechanisms.joint.wiring import Wiring
from sim_backend.mechanisms.motor.cogging import Cogging
from sim_backend.mechanisms.motor.current_sensor import CurrentSensor
from sim_backend.mechanisms.motor.dead_time import DeadTime
from sim_backend.mechanisms.motor.heat import Heat
from sim_backend.mechanisms.motor.motor import CurrentLoop, Motor, Supply
from sim_backend.mechanisms.motor.supply_ripple import SupplyRipple
from sim_backend.mechanisms.motor.thermal_drift import ThermalDrift


@dataclass(frozen=True, kw_only=True)
class PlantParameters:
    """One geared joint.

    `friction`, `bristle` and `dwell` are the drive side's (rotor and gear train), at the motor shaft; the same with
    `arm_` are the arm side's, at the joint.
    """

    motor: Motor
    supply: Supply
    gear: Gear
    arm: Arm
    encoder: Encoder
    load: Load = field(default_factory=Load)
    friction: Friction = field(default_factory=Friction)
    arm_friction: Friction = field(default_factory=Friction)
    bristle: Bristle = field(default_factory=Bristle)
    arm_bristle: Bristle = field(default_factory=Bristle)
    dwell: Dwell = field(default_factory=Dwell)
    arm_dwell: Dwell = field(default_factory=Dwell)
    load_friction: LoadFriction = field(default_factory=LoadFriction)
    current_loop: CurrentLoop = field(default_factory=CurrentLoop)
    current_sensor: CurrentSensor = field(default_factory=CurrentSensor)
    overload: Overload = field(default_factory=Overload)
    latency: Latency = field(default_factory=Latency)
    scatter: Scatter = field(default_factory=Scatter)
    shaft: Shaft = field(default_factory=Shaft)
    clutch: Clutch = field(default_factory=Clutch)
    end_stops: EndStops = field(default_factory=EndStops)
    wall: Wall = field(default_factory=Wall)
    heat: Heat = field(default_factory=Heat)
    operator: Operator = field(default_factory=Operator)
    wiring: Wiring = field(default_factory=Wiring)
    # mechanisms to hide from whoever explains the data
    viscous_asymmetry: ViscousAsymmetry = field(default_factory=ViscousAsymmetry)
    coulomb_asymmetry: CoulombAsymmetry = field(default_factory=CoulombAsymmetry)
    drag: Drag = field(default_factory=Drag)
    periodic_friction: PeriodicFriction = field(default_factory=PeriodicFriction)
    run_in: RunIn = field(default_factory=RunIn)
    spring: Spring = field(default_factory=Spring)
    centre_of_mass: CentreOfMass = field(default_factory=CentreOfMass)
    lubricant: Lubricant = field(default_factory=Lubricant)
    cogging: Cogging = field(default_factory=Cogging)
    dead_time: DeadTime = field(default_factory=DeadTime)
    thermal_drift: ThermalDrift = field(default_factory=ThermalDrift)
    eccentricity: Eccentricity = field(default_factory=Eccentricity)
    hose: Hose = field(default_factory=Hose)
    friction_jump: FrictionJump = field(default_factory=FrictionJump)
    brake: Brake = field(default_factory=Brake)
    supply_ripple: SupplyRipple = field(default_factory=SupplyRipple)

    def __post_init__(self) -> None:
        if self.current_loop.present and not self.current_sensor.present:
            raise ParameterError("CurrentLoop.present = True: a loop needs CurrentSensor.present = True to close on")
        if self.overload.present and not self.current_sensor.present:
            raise ParameterError("Overload.present = True: I2t needs CurrentSensor.present = True to count")
        if self.wall.present and self.end_stops.present:
            self.end_stops.check_reach(self.wall.angle_rad)
        self.bristle.check(self.friction)
        self.arm_bristle.check(self.arm_friction)

    @classmethod
    def from_dict(cls, values: Mapping[str, Any], base: "PlantParameters | None" = None) -> "PlantParameters":
        """Return parameters from nested tables, as TOML gives them; what is left out comes from `base`.

        Raises:
            ParameterError: a key is unknown, a value is impossible, or, without a base, one is missing.
        """
        _know(values, [item.name for item in fields(cls)], "plant")
        made = {name: _component(cls, name, table, base) for name, table in values.items()}
        if base is not None:
            return replace(base, **made)
        missing = [name for name in ("motor", "supply", "gear", "arm", "encoder") if name not in made]
        if missing:
            raise ParameterError(
                f"plant: the tables {', '.join(missing)} are missing; give them, or start from a preset"
            )
        return cls(**made)


def _component(owner: type, name: str, table: Any, base: PlantParameters | None) -> Any:
    kind = next(item.type for item in fields(owner) if item.name == name)
    if not isinstance(table, Mapping) or not isinstance(kind, type) or not is_dataclass(kind):
        raise ParameterError(f"plant.{name}: a table of parameters is wanted, found {table!r}")
    _know(table, [item.name for item in fields(kind)], f"plant.{name}")
    flags = [item.name for item in fields(kind) if item.type is bool]
    for key in table:
        if (key in flags) != isinstance(table[key], bool):
            raise ParameterError(
                f"plant.{name}.{key} = {table[key]!r}: {'true or false' if key in flags else 'a number'} is wanted"
            )
    try:
        return kind(**table) if base is None else replace(getattr(base, name), **table)
    except ParameterError as error:
        raise ParameterError(f"plant.{name}: {error}") from error
    except TypeError as error:  # a required parameter is missing; the message names it
        raise ParameterError(f"plant.{name}: {str(error).split('() ')[-1]}") from error


def _know(values: Mapping[str, Any], known: list[str], where: str) -> None:
    for key in values:
        if key not in known:
            near = difflib.get_close_matches(key, known, 1)
            hint = f"did you mean '{near[0]}'? " if near else ""
            raise ParameterError(f"{where}: unknown key '{key}'; {hint}known are {', '.join(known)}")


@dataclass(frozen=True, kw_only=True)
class Constants:
    """Derived quantities of a plant, at the joint.

    Attributes:
        weight_n: hung on the axis.
        moment_kg_m: sum of mass times lever of arm and load.
        arm_kg_m2: inertia of arm and load.
        rotor_kg_m2: inertia of the rotor.
        teeth_n_m_rad: stiffness of teeth and shaft in series.
        teeth_n_m_s_rad: their damping.
    """

    weight_n: float
    moment_kg_m: float
    arm_kg_m2: float
    rotor_kg_m2: float
    teeth_n_m_rad: float
    teeth_n_m_s_rad: float


def constants_of(parameters: PlantParameters) -> Constants:
    """Return what follows from a plant's parameters."""
    arm, load, gear = parameters.arm, parameters.load, parameters.gear
    hung_kg_m = 0.0 if load.balanced else load.mass_kg * arm.length_m
    softening = parameters.shaft.softening(gear.stiffness_n_m_rad)
    return Constants(
        weight_n=STANDARD_GRAVITY_M_S2 * load.mass_kg,
        moment_kg_m=hung_kg_m + arm.mass_kg * arm.centre_of_mass_m,
        arm_kg_m2=arm.inertia_kg_m2 + load.mass_kg * arm.length_m**2,
        rotor_kg_m2=gear.ratio * gear.ratio * parameters.motor.rotor_inertia_kg_m2,
        teeth_n_m_rad=gear.stiffness_n_m_rad / softening,
        teeth_n_m_s_rad=gear.damping_n_m_s_rad / softening,
    )
