"""Which kinds of drive there are. `kind` in bench.toml chooses one; `bench.control.drive_factory` makes it."""

from typing import Annotated, Any

from pydantic import Discriminator, Tag

from bench.config.drives.canopen import CanopenDriveSettings
from bench.config.drives.modbus import ModbusDriveSettings
from bench.config.drives.roboclaw import RoboclawDriveSettings
from bench.config.drives.simulated import SimulatedDriveSettings

KINDS = ("sim", "canopen", "roboclaw", "modbus")


def _tag(section: Any) -> str:
    """Which of the kinds a section is; the simulated drive where it does not say."""
    kind = section.get("kind", "sim") if isinstance(section, dict) else getattr(section, "kind", "")
    return f"tagged-{kind}"  # so that messages name the key without the tag


DriveSettings = Annotated[
    Annotated[SimulatedDriveSettings, Tag("tagged-sim")]
    | Annotated[RoboclawDriveSettings, Tag("tagged-roboclaw")]
    | Annotated[CanopenDriveSettings, Tag("tagged-canopen")]
    | Annotated[ModbusDriveSettings, Tag("tagged-modbus")],
    Discriminator(_tag, custom_error_type="kind", custom_error_message=f"kind should be one of {', '.join(KINDS)}"),
]
