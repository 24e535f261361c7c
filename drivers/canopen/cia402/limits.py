"""The limit that the drive itself keeps."""

from drivers.canopen.capabilities import Capabilities
from drivers.canopen.cia301.object_access import ObjectAccess
from drivers.canopen.settings import CanopenSettings
from drivers.errors import DriveConfigurationError


def set_current_limit(access: ObjectAccess, settings: CanopenSettings, found: Capabilities) -> None:
    """Set the highest motor current in the drive, where the settings name one, and read it back.

    Raises:
        DriveConfigurationError: the drive refuses, or keeps another one.
    """
    if settings.current_limit_a is None:
        return
    item = found.profile.current_limit
    per_count_a = found.scale.current_a(item)
    counts = int(settings.current_limit_a / per_count_a)  # never above what was asked for
    access.write(item, counts)
    kept = access.read(item)
    if kept != counts:
        raise DriveConfigurationError(
            settings.device,
            f"{item} reads back as {kept * per_count_a:g} A; {counts * per_count_a:g} A is wanted. "
            "Correct current_limit_a",
        )
