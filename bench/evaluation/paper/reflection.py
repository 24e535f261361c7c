"""What a current amounts to as a load at the tip."""

from bench.config.configuration import BenchConfiguration
from bench.config.reflected_load import reflected_load_kg
from bench.errors import ConfigurationError
from bench.experiments.parts.at_rest import RIGHT_ANGLE_RAD


def grams_per_ma(configuration: BenchConfiguration) -> float:
    """Grams at the tip that a milliampere holds at 90 degrees, an arm of its own weight aside.

    Raises:
        ConfigurationError: the rig lacks what turns a current into a load.
    """
    one_a, nothing = (reflected_load_kg(current_a, RIGHT_ANGLE_RAD, configuration.rig) for current_a in (1.0, 0.0))
    if one_a is None or nothing is None:
        raise ConfigurationError("at 90 degrees gravity has a lever; a rig without one cannot reflect a load")
    return one_a - nothing
