"""Which Feetech servos are on a port."""

from collections.abc import Iterator

from bench.config.drives.scanning import FoundDrive, SerialPlace

_BAUD_RATES = (1_000_000, 115200)
_IDS = range(254)


def scan(place: SerialPlace) -> Iterator[FoundDrive]:
    """Ask one id after the other, at each baud rate: where all are asked, all answer at once."""
    from drivers.feetech.frames import SCS
    from drivers.servos.scan import answering

    for baud_rate in place.baud_rates or _BAUD_RATES:
        for found in answering(place.port, baud_rate, SCS, _IDS):
            yield FoundDrive("Feetech servo; IT HAS NO WATCHDOG, see the guide before you accept that", {
                "kind": "feetech", "port": place.port, "baud_rate": baud_rate, "servo_id": found.servo_id,
                "accept_no_watchdog": False,
            })  # fmt: skip
