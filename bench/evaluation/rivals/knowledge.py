"""What all rivals know: one calibration of the joint that they are compared on."""

from math import pi

from bench.calibration import calibrate, with_friction
from bench.config.configuration import BenchConfiguration
from bench.errors import ConfigurationError
from bench.evaluation.paper.measurements import Measurement, measure, own_store, quietly
from bench.experiments.parts.load_follower import estimator_settings, joint_model
from compensator.rivals import Knowledge

LOADS_KG = (0.0, 0.05, 0.1)
SWEEPS = (
    Measurement("speed-sweep", {"loads_kg": LOADS_KG, "strokes": 4}),
    Measurement("load-sweep", {"loads_kg": LOADS_KG, "angles_rad": (0.0, pi / 2), "searches": 2}),
)


def calibrated(configuration: BenchConfiguration) -> BenchConfiguration:
    """The configuration with friction curves, of a calibration made now where it has none. Nothing of it is kept.

    Raises:
        ExperimentError: a sweep did not complete.
    """
    if configuration.friction is not None:
        return configuration
    with own_store() as store:
        calibrate(store, [measure(configuration, store, sweep, quietly).id for sweep in SWEEPS])
        return with_friction(store, configuration)


def knowledge_of(configuration: BenchConfiguration) -> Knowledge:
    """From the friction curves of a configuration.

    Raises:
        ConfigurationError: it has none, or its rig leaves out what is needed.
    """
    model, settings = joint_model(configuration), estimator_settings(configuration)
    friction = configuration.friction
    if friction is None:
        raise ConfigurationError("there are no friction curves to compare with; calibrate first")
    middle = sorted(friction.curves, key=lambda one: one.load_kg)[len(friction.curves) // 2]
    return Knowledge(
        lookup=friction.over_friction(),
        fixed=middle.curve(),
        ratio=model.ratio,
        inertia_a_s2_rad=middle.inertia_a_s2_rad * model.ratio,
        breakaway_rad=configuration.search.onset_counts * settings.count_rad,
        settings=settings,
        model=model,
    )
