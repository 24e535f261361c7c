"""The paper's bench with what a calibration of it told: made once with the simulated drive, rounded."""

from bench.config.configuration import default_configuration
from bench.config.friction_curves import FrictionCurve, FrictionSettings
from bench.config.sections import RestSettings

CURVES = tuple(
    FrictionCurve(
        load_kg=load_kg, f_load_a=f_load_a, coulomb_a=coulomb_a, static_a=static_a, stribeck_speed_rad_s=5.0,
        viscous_a_s_rad=0.00215,
    )
    for load_kg, f_load_a, coulomb_a, static_a in ((0.0, 0.101, 0.0665, 0.106), (0.1, 0.269, 0.166, 0.272))
)  # fmt: skip
REST = RestSettings(gain=1.0, step_a=0.0027, slope=0.247, scatter=0.013, floor_a=0.0021, delay=(0.02, 0.01, 0.019))


def calibrated_configuration(seed=1):
    """Of the bench of the paper, with another seed of its scatter."""
    plain = default_configuration()
    told = {"friction": FrictionSettings(curves=CURVES), "rest": REST}
    return plain.model_copy(update={"drive": plain.drive.model_copy(update={"seed": seed}), **told})
