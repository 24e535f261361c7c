"""What the encoder of the rig can tell apart."""

from math import pi

from bench.config.configuration import BenchConfiguration
from bench.errors import ConfigurationError


def resolution_rad(configuration: BenchConfiguration) -> float:
    """The joint angle of one encoder count [rad].

    Raises:
        ConfigurationError: the rig leaves out counts or gear ratio.
    """
    counts, ratio = configuration.rig.sensor.counts_per_turn, configuration.rig.gear.ratio
    if counts is None or ratio is None:
        raise ConfigurationError(
            f"rig '{configuration.rig.name}': sensor.counts_per_turn and gear.ratio are needed to tell motion from "
            "rest; add them to the rig"
        )
    return 2.0 * pi / (counts * ratio)
