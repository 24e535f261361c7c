"""Plants with a name."""

from sim_backend.errors import ParameterError
from sim_backend.mechanisms.friction.friction import Friction
from sim_backend.mechanisms.friction.load_friction import LoadFriction
from sim_backend.mechanisms.friction.scatter import Scatter
from sim_backend.mechanisms.joint.contact import Gear
from sim_backend.mechanisms.joint.gravity import Arm
from sim_backend.mechanisms.joint.sensing import Encoder
from sim_backend.mechanisms.motor.motor import Motor, Supply
from sim_backend.plant.parameters import PlantParameters


def paper() -> PlantParameters:
    """Return the rig of the paper (Saini, Sarkar, Datta Ray, AIR '13), as far as it can be known.

    The paper gives: PM DC motor on PWM, gear with backlash, resolver on the motor side only, no current sensor, an
    arm that balances without load, 0 to 100 g at its tip. Its figures give ranges: to 2000 rpm at 500 mA, balanced
    (Fig. 2); 400 duty counts at 1200 rpm (Fig. 3); 100 to 850 mA after steps to 90 degrees with 100 g (Fig. 4);
    breakaway within +-300 mA at angle 0 (Fig. 7) and within -100 to 900 mA at 90 degrees (Fig. 9).

    It does not name motor, ratio, arm length or supply. Chosen here, so that those ranges come out:
    - 24 V, 1000 duty counts, 8 ohm, 0.05 N m/A, ratio 20, arm 0.5 m: 100 g at 90 degrees take 490 mA; 1200 rpm take
      6.3 V of back-EMF and 330 to 430 mA of friction, 370 to 410 counts;
    - without load static friction worth 100 mA, Coulomb friction 60 mA, viscous friction 2.1 mA s/rad;
    - dry friction 2.7 times as much with 100 g hung on, as the curves of Figs 2 and 7 ask for. A plain bearing would
      not do that; the paper does not say what does;
    - mesh loss of 25 % of the transmitted torque: the envelope is wider at 90 degrees (Fig. 9) than at 0 (Fig. 7);
    - nearly all friction on the motor's side of the free play. Much friction behind it would, with the mesh loss,
      make breakaway unequal in the two directions, which the paper did not find;
    - free play 0.01 rad at the joint (11 degrees of the motor), resolver of 4096 counts;
    - static friction scatters by 1.5 % from stop to stop, Coulomb friction by 2 % along the path.
    """
    return PlantParameters(
        motor=Motor(resistance_ohm=8.0, torque_constant_n_m_a=0.05, rotor_inertia_kg_m2=3e-5),
        supply=Supply(voltage_v=24.0, duty_counts=1000),
        gear=Gear(ratio=20.0, backlash_rad=0.01, stiffness_n_m_rad=2000.0, damping_n_m_s_rad=2.0),
        arm=Arm(length_m=0.5, inertia_kg_m2=0.01, mass_kg=0.3, centre_of_mass_m=0.0),
        encoder=Encoder(counts_per_turn=4096, speed_window_s=5e-3),
        friction=Friction(
            coulomb_n_m=3.0e-3,
            static_n_m=5.0e-3,
            stribeck_rad_s=5.0,
            stribeck_exponent=2.0,
            viscous_n_m_s_rad=1.05e-4,
            growth_per_n=1.7,
        ),
        arm_friction=Friction(coulomb_n_m=5e-3, static_n_m=6e-3, stribeck_rad_s=0.25, viscous_n_m_s_rad=1e-3),
        load_friction=LoadFriction(driving=0.25, back_driving=0.25),
        scatter=Scatter(static_fraction=0.015, coulomb_fraction=0.02, coulomb_length_rad=0.05),
    )


PRESETS = {"paper": paper}


def by_name(name: str) -> PlantParameters:
    """Return the preset of a name.

    Raises:
        ParameterError: there is none; the message lists those there are.
    """
    if name not in PRESETS:
        raise ParameterError(f"preset '{name}' is unknown; known are {', '.join(PRESETS)}")
    return PRESETS[name]()
