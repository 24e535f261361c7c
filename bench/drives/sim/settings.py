"""Settings of the simulated drive."""

from typing import Any, Literal

from pydantic import Field

from bench.config.drives.kind import DriveSettings
from bench.config.quantities import quantity
from bench.drives.sim.faults import AnyFault


class SimulatedDriveSettings(DriveSettings):
    """A drive and a joint in software."""

    kind: Literal["sim"] = "sim"
    preset: str = quantity("paper", "", "Plant that is simulated")
    seed: int = quantity(1, "", "Seed of the plant's scatter and noise; the same seed gives the same samples", ge=0)
    faults: tuple[AnyFault, ...] = Field(default=(), description="What goes wrong with drive and joint, and when")
    plant: dict[str, Any] = Field(default_factory=dict, description="Plant parameters that differ from the preset")
