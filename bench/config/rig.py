"""The rig: motor, gear, arm, sensor and supply as their owner knows them (`rig.toml`).

Every value is optional: what is unknown is left out, and whoever needs it says so.
"""

from math import pi
from typing import Literal

from pydantic import Field

from bench.config.quantities import quantity
from bench.errors import ConfigurationError
from drivers.settings import Settings

LONGEST_NAME = 200  # characters
CHALLENGE = "unknown joint"  # name of the rig of a joint that was drawn for a challenge


class Section(Settings):
    """A table of a TOML file: unknown keys are refused, values are finite."""


class Motor(Section):
    """PM DC motor, values at the motor shaft."""

    name: str | None = Field(None, max_length=LONGEST_NAME, description="Make and type", examples=["make and type"])
    resistance_ohm: float | None = quantity(None, "ohm", "Resistance of the winding", gt=0, examples=[0.7])
    inductance_h: float | None = quantity(None, "H", "Inductance of the winding", gt=0, examples=[0.0005])
    torque_constant_n_m_a: float | None = quantity(None, "N m/A", "Torque constant", gt=0, examples=[0.05])
    back_emf_v_s_rad: float | None = quantity(None, "V s/rad", "Back-EMF constant", gt=0, examples=[0.05])
    rotor_inertia_kg_m2: float | None = quantity(None, "kg m2", "Inertia of the rotor", gt=0, examples=[2e-05])
    constants_at_c: float | None = quantity(
        None,
        "degC",
        "Temperature at which resistance and back-EMF constant hold, as the drive measures it",
        examples=[25.0],
    )
    copper_per_k: float | None = quantity(
        None, "1/K", "Growth of the resistance with that temperature", ge=0, examples=[0.0039]
    )
    magnet_per_k: float | None = quantity(
        None, "1/K", "Fall of the back-EMF constant with that temperature", ge=0, examples=[0.001]
    )


class Gear(Section):
    """Gear between motor and joint."""

    ratio: float | None = quantity(None, "", "Motor turns per joint turn", gt=0, examples=[20.0])
    backlash_rad: float | None = quantity(None, "rad", "Total free play at the joint", ge=0, examples=[0.002])
    stiffness_n_m_rad: float | None = quantity(
        None, "N m/rad", "Torsional stiffness of gear and shaft at the joint, the motor held", gt=0, examples=[2000.0]
    )


class Arm(Section):
    """Arm in a vertical plane; angle 0 is vertically down."""

    length_m: float | None = quantity(None, "m", "Axis to the load at the tip", gt=0, examples=[0.5])
    mass_kg: float | None = quantity(None, "kg", "Mass of the arm without load", ge=0, examples=[0.4])
    centre_of_mass_m: float | None = quantity(
        None, "m", "Axis to the arm's own centre of mass; 0 is balanced", examples=[0.2]
    )
    inertia_kg_m2: float | None = quantity(None, "kg m2", "Inertia about the axis, without load", gt=0, examples=[0.03])


class Sensor(Section):
    """Position sensor."""

    counts_per_turn: float | None = quantity(
        None, "1/turn", "Counts per turn of what it turns with", gt=0, examples=[4096.0]
    )
    at: Literal["motor", "joint"] | None = Field(
        None, description="What it turns with; left out: the motor. That of a real drive does", examples=["motor"]
    )


class Supply(Section):
    """Supply of the PWM stage."""

    voltage_v: float | None = quantity(None, "V", "Supply voltage", gt=0, examples=[24.0])
    is_nominal: bool | None = Field(
        None,
        description="True: nobody measures the supply, and recordings hold this number whatever the load does. "
        "Left out: so it is where the supply of every trial keeps to the last digit what it was",
        examples=[True],
    )


class Effort(Section):
    """Which channel stands for the effort in a study, where the default is not wanted."""

    quantity: Literal["torque", "force", "current", "current_estimate", "terminal_voltage"] = Field(
        description="Quantity that the model predicts", examples=["current"]
    )


class Rig(Section):
    """One joint as its owner knows it."""

    name: str = Field(max_length=LONGEST_NAME, description="Name of the joint")
    joint: Literal["rotary", "linear"] = Field("rotary", description="A linear joint has positions in m")
    horizontal: bool = Field(False, description="True: gravity does no work on the joint")
    motor: Motor = Motor()
    gear: Gear = Gear()
    arm: Arm = Arm()
    sensor: Sensor = Sensor()
    supply: Supply = Supply()
    effort: Effort | None = None


def sensor_turns(rig: Rig) -> float | None:
    """Turns of the position sensor for each of the joint; None where the rig leaves out the gear ratio."""
    return 1.0 if rig.sensor.at == "joint" else rig.gear.ratio


def resolution_rad(rig: Rig) -> float:
    """The joint angle of one encoder count [rad].

    Raises:
        ConfigurationError: the rig leaves out counts or gear ratio.
    """
    counts, turns = rig.sensor.counts_per_turn, sensor_turns(rig)
    if counts is None or turns is None:
        raise ConfigurationError(
            f"rig '{rig.name}': sensor.counts_per_turn and gear.ratio are needed to tell motion from rest; add them to "
            "the rig"
        )
    return 2.0 * pi / (counts * turns)
