"""The rig: motor, gear, arm, sensor and supply as their owner knows them (`rig.toml`).

Every value is optional: what is unknown is left out, and whoever needs it says so.
"""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]


class Section(BaseModel):
    """A table of a TOML file: unknown keys are refused, values are finite."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class Motor(Section):
    """PM DC motor, values at the motor shaft."""

    name: str | None = None
    resistance_ohm: Positive | None = None
    inductance_h: Positive | None = None
    torque_constant_n_m_a: Positive | None = None
    back_emf_v_s_rad: Positive | None = None
    rotor_inertia_kg_m2: Positive | None = None
    constants_at_c: float | None = None  # temperature at which resistance and back-EMF constant hold
    copper_per_k: NotNegative | None = None  # growth of the resistance with the temperature that the drive measures
    magnet_per_k: NotNegative | None = None  # fall of the back-EMF constant with it


class Gear(Section):
    """Gear between motor and joint."""

    ratio: Positive | None = None  # motor turns per joint turn
    backlash_rad: NotNegative | None = None  # total free play at the joint
    stiffness_n_m_rad: Positive | None = None  # torsional, of gear and shaft at the joint, the motor held


class Arm(Section):
    """Arm in a vertical plane; angle 0 is vertically down."""

    length_m: Positive | None = None  # axis to the load at the tip
    mass_kg: NotNegative | None = None
    centre_of_mass_m: float | None = None  # axis to the arm's own centre of mass; 0 is balanced
    inertia_kg_m2: Positive | None = None  # about the axis, without load


class Sensor(Section):
    """Position sensor on the motor side."""

    counts_per_turn: Positive | None = None  # per motor turn


class Supply(Section):
    """Supply of the PWM stage."""

    voltage_v: Positive | None = None
    is_nominal: bool | None = None  # true: nobody measures it, and recordings hold this number whatever the load does


class Effort(Section):
    """Which channel stands for the effort in a study, where the default is not wanted."""

    quantity: Literal["torque", "force", "current", "current_estimate", "terminal_voltage"]


class Rig(Section):
    """One joint as its owner knows it."""

    name: str
    joint: Literal["rotary", "linear"] = "rotary"
    horizontal: bool = False  # True: gravity does no work on the joint
    motor: Motor = Motor()
    gear: Gear = Gear()
    arm: Arm = Arm()
    sensor: Sensor = Sensor()
    supply: Supply = Supply()
    effort: Effort | None = None
