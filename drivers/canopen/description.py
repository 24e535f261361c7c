"""What the drive is and can do, in the words of the contract."""

from math import nan
from typing import Final

from drivers.canopen.cia301.bus_load import cycle_s
from drivers.canopen.session import Session
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Description

# sums of the time limits in this package
_LONGEST_CALL_S: Final = 6.0
_LONGEST_OPEN_S: Final = 20.0


def describe(settings: CanopenSettings, session: Session | None) -> Description:
    """Identity and capabilities; what only the drive knows is empty until it is open."""
    if session is None:
        return Description(
            settings.device, "", "", "", "", simulated=False, modes=frozenset(), measured=frozenset(), resolution={},
            max_rate_hz=nan, watchdog_s=settings.watchdog_s, longest_call_s=_LONGEST_CALL_S,
            longest_open_s=_LONGEST_OPEN_S,
        )  # fmt: skip
    identity, measurement = session.found.identity, session.measurement
    on_the_bus_s = cycle_s(session.data.sizes, settings.bus.bitrate)
    return Description(
        device=settings.device,
        vendor=identity.vendor,
        product=identity.product,
        firmware=identity.firmware or f"revision 0x{identity.revision:X}",
        serial=f"{identity.serial_number:X}",
        simulated="simulat" in identity.name.lower(),
        modes=frozenset(session.found.modes),
        measured=measurement.measured,
        resolution=measurement.resolution,
        max_rate_hz=1.0 / max(session.round_trip_s, on_the_bus_s),
        watchdog_s=settings.watchdog_s,
        longest_call_s=_LONGEST_CALL_S,
        longest_open_s=_LONGEST_OPEN_S,
    )
