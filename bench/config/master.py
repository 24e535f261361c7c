"""The `[master]` section: the joint that the operator holds, and what is reflected to it."""

from pydantic import Field

from bench.config.drives.registry import AnyDriveSettings
from bench.config.quantities import quantity
from bench.config.rig import Rig, Section
from bench.control.limits import Limits


class ReflectionSettings(Section):
    """How the slave's load is given to the master's motor; `compensator.reflection.reflection` says what each does."""

    torque_n_m: float = quantity(1.5, "N m", "Most torque that is reflected, either way", gt=0)
    slew_n_m_s: float = quantity(30.0, "N m/s", "Fastest change of it", gt=0)
    damping_n_m_s_rad: float = quantity(
        0.0, "N m s/rad", "Torque against the master's speed, beside what is reflected", ge=0
    )


class MasterSettings(Section):
    """A second joint, with the operator's hand on its arm. Its motor makes torque; the hand makes the motion."""

    rig: Rig | None = Field(default=None, description="The master's joint; that of the slave where left out")
    drive: AnyDriveSettings = Field(description="The master's drive, as in [drive]")
    limits: Limits = Limits()
    reflection: ReflectionSettings = ReflectionSettings()
