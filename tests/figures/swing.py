"""`python -m tests.figures.swing [SEEDS]`: what error of the reflected load a swing leaves to a model that is right.

A sinusoid on the simulated bench, as `friction-bench study ladder --bench` runs it, under three loads; half as fast,
too. By the friction curves, and by a study's model whose constants are those that the joint is simulated with: static
friction at that load, and what the teeth lose. What is left to it is what motor and encoder do not tell, above all how
the arm rattles in the free play.
"""

import sys
from statistics import fmean

from bench.config.configuration import BenchConfiguration
from bench.config.friction_curves import StudiedEffect, StudiedModel
from sim_backend.plant.presets import paper
from tests.experiments.bench_run import Ran
from tests.experiments.calibrated import calibrated_configuration

GRAVITY_M_S2 = 9.80665
LOADS_KG = (0.0, 0.05, 0.1)
FREQUENCIES_HZ = (0.5, 0.25)


def true_model(load_kg: float) -> StudiedModel:
    """The simulated joint under a load, as effects; friction of the arm counts as friction of the motor's side."""
    joint = paper()
    rotor, arm, ratio = joint.friction, joint.arm_friction, joint.gear.ratio
    growth = rotor.growth_per_n * GRAVITY_M_S2
    rise_n_m = (rotor.static_n_m - rotor.coulomb_n_m) * ratio * (1.0 + growth * load_kg)
    effects = {
        "gravity": ((), (0.0, 1.0)),
        "coulomb": ((), (rotor.coulomb_n_m * ratio + arm.coulomb_n_m,)),
        "viscous": ((), (rotor.viscous_n_m_s_rad * ratio**2 + arm.viscous_n_m_s_rad,)),
        "stribeck": (
            (rotor.stribeck_rad_s / ratio, rotor.stribeck_exponent),
            (rise_n_m + arm.static_n_m - arm.coulomb_n_m,),
        ),
        "weight_friction": ((), (rotor.coulomb_n_m * ratio * growth,)),
        "load_friction": ((), (joint.load_friction.driving,)),
    }
    return StudiedModel(
        study_id=1,
        model_id=1,
        effects=tuple(StudiedEffect(effect=name, shape=s, coefficients=c) for name, (s, c) in effects.items()),
        slow_rad_s=0.06,
        fast_rad_s=3.0,
        position_span_rad=3.0,
        inertia_n_m_s2_rad=joint.motor.rotor_inertia_kg_m2 * ratio**2 + joint.arm.inertia_kg_m2,
    )


def error_g(configuration: BenchConfiguration, load_kg: float, frequency_hz: float) -> float:
    """Of the reflected load, rms over a sinusoid."""
    ran = Ran(configuration, "sinusoid", load_kg=load_kg, frequency_hz=frequency_hz)
    return 1e3 * float(ran.summary["rms_error_kg"])


def with_model(configuration: BenchConfiguration, model: StudiedModel) -> BenchConfiguration:
    """The bench that compensates with a study's model."""
    assert configuration.friction is not None
    friction = configuration.friction.model_copy(update={"study": model})
    return configuration.model_copy(update={"friction": friction})


def main(seeds: int) -> None:
    """Print the mean over some seeds of the joint's scatter."""
    benches = [calibrated_configuration(seed) for seed in range(1, seeds + 1)]
    print(f"{'frequency [Hz]':>14} {'load [g]':>9} {'by curves [g]':>14} {'by its own constants [g]':>25}")
    for frequency_hz in FREQUENCIES_HZ:
        for load_kg in LOADS_KG:
            curves_g = fmean(error_g(one, load_kg, frequency_hz) for one in benches)
            true = true_model(load_kg)
            true_g = fmean(error_g(with_model(one, true), load_kg, frequency_hz) for one in benches)
            print(f"{frequency_hz:14g} {1e3 * load_kg:9g} {curves_g:14.2f} {true_g:25.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 4)
