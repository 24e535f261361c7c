"""What is reflected to the operator: by which law, and what came of it in a cycle."""

from dataclasses import dataclass

from bench.config.configuration import BenchConfiguration
from bench.control.cycle import PairReading
from compensator.reflection.reflection import Reflection


@dataclass(frozen=True, slots=True)
class Conveyed:
    """One cycle of teleoperation.

    Attributes:
        reading: of both joints.
        reflected_n_m: what the master's motor was asked to make of the load when this cycle began.
    """

    reading: PairReading
    reflected_n_m: float


def reflection_of(configuration: BenchConfiguration, force_scale: float, about_n_m: float = 0.0) -> Reflection:
    """The law of reflection, as bench.toml has it.

    Raises:
        ConfigurationError: there is no master.
    """
    settings = configuration.require_master().reflection
    return Reflection(
        force_scale=force_scale,
        torque_n_m=settings.torque_n_m,
        slew_n_m_s=settings.slew_n_m_s,
        damping_n_m_s_rad=settings.damping_n_m_s_rad,
        period_s=configuration.control.period_s,
        about_n_m=about_n_m,
    )
