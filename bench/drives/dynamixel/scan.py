"""Which Dynamixels are on a port."""

from collections.abc import Iterator

from bench.config.drives.scanning import FoundDrive, SerialPlace

_BAUD_RATES = (57600, 1_000_000, 2_000_000, 4_000_000, 115200)


def scan(place: SerialPlace) -> Iterator[FoundDrive]:
    """Ask everybody, at each baud rate."""
    from drivers.dynamixel.frames import PROTOCOL_2
    from drivers.dynamixel.models import MODELS
    from drivers.servos.scan import answering

    for baud_rate in place.baud_rates or _BAUD_RATES:
        for found in answering(place.port, baud_rate, PROTOCOL_2, None):
            number = int.from_bytes(found.data[:2], "little")
            name = MODELS[number].name if number in MODELS else f"model {number}, not one of the X series"
            yield FoundDrive(f"Dynamixel {name}, firmware {found.data[2]}", {
                "kind": "dynamixel", "port": place.port, "baud_rate": baud_rate, "servo_id": found.servo_id,
            })  # fmt: skip
