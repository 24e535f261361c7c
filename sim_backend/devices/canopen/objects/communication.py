"""The communication objects (CiA 301)."""

from collections.abc import Iterator

from sim_backend.devices.canopen.data_types import TEXT, U8, U16, U32
from sim_backend.devices.canopen.objects.entry import Access, Entry, Object, record, variable

RO, RW, CONST = Access.RO, Access.RW, Access.CONST

DEVICE_TYPE_SERVO = 0x00020192  # CiA 402, servo drive
PDO_DOES_NOT_EXIST = 0x80000000
PDOS, MOST_PDOS = 4, 8  # that this node has; that a data sheet may give it
ERRORS_KEPT = 5
CONSUMERS = 2
_SYNCHRONOUS = 1
_EVENT = 255

_CONTROLWORD = 0x60400010
_STATUSWORD = 0x60410010


def communication(vendor: int, product: int, revision: int, serial: int, name: str, version: str) -> list[Object]:
    """Return the communication objects of a node with an identity.

    After a reset RPDO 1 brings the controlword and TPDO 1 tells the statusword; the other PDOs do not exist.
    """
    return [
        variable(0x1000, "Device type", U32, CONST, DEVICE_TYPE_SERVO),
        variable(0x1001, "Error register", U8, RO, mappable=True),
        _error_history(),
        variable(0x1005, "COB-ID SYNC message", U32, RW, 0x80),
        variable(0x1008, "Manufacturer device name", TEXT, CONST, name),
        variable(0x100A, "Manufacturer software version", TEXT, CONST, version),
        variable(0x100C, "Guard time", U16),  # ms
        variable(0x100D, "Life time factor", U8),
        variable(0x1014, "COB-ID emergency message", U32, RO, 0x80, with_node_id=True),
        record(
            0x1016,
            "Consumer heartbeat time",
            *(Entry(number, f"Consumer heartbeat time {number}", U32) for number in range(1, CONSUMERS + 1)),
        ),
        variable(0x1017, "Producer heartbeat time", U16),
        record(
            0x1018,
            "Identity object",
            Entry(1, "Vendor-ID", U32, CONST, vendor),
            Entry(2, "Product code", U32, CONST, product),
            Entry(3, "Revision number", U32, CONST, revision),
            Entry(4, "Serial number", U32, CONST, serial),
        ),
        record(0x1029, "Error behavior", Entry(1, "Communication error", U8, RW, 0, high=2)),
        record(
            0x1200,
            "SDO server parameter",
            Entry(1, "COB-ID client to server", U32, RO, 0x600, with_node_id=True),
            Entry(2, "COB-ID server to client", U32, RO, 0x580, with_node_id=True),
        ),
        *pdos(range(PDOS)),
    ]


def _error_history() -> Object:
    kept = (Entry(number, f"Standard error field {number}", U32, RO) for number in range(1, ERRORS_KEPT + 1))
    return Object(0x1003, "Pre-defined error field", (Entry(0, "Number of errors", U8), *kept))


def pdos(numbers: range) -> Iterator[Object]:
    """Return communication and mapping parameters of PDOs, from 0; CiA 301 has COB-IDs for the first four."""
    for number in numbers:
        name = f"RPDO {number + 1}"
        timer = Entry(5, "Event timer", U16)  # ms
        yield record(0x1400 + number, f"{name} communication parameter", *_link(number, 0x200), timer)
        yield _mapping(0x1600 + number, f"{name} mapping parameter", number, _CONTROLWORD)
    for number in numbers:
        name = f"TPDO {number + 1}"
        timers = (Entry(3, "Inhibit time", U16), Entry(5, "Event timer", U16))  # 100 us, ms
        yield record(0x1800 + number, f"{name} communication parameter", *_link(number, 0x180), *timers)
        yield _mapping(0x1A00 + number, f"{name} mapping parameter", number, _STATUSWORD)


def _link(number: int, first_cob_id: int) -> tuple[Entry, Entry]:
    exists = 0 if number == 0 else PDO_DOES_NOT_EXIST
    cob_id = first_cob_id + 0x100 * number if number < PDOS else 0
    return (
        Entry(1, "COB-ID", U32, RW, exists | cob_id, with_node_id=number < PDOS),
        Entry(2, "Transmission type", U8, RW, _EVENT if number == 0 else _SYNCHRONOUS),
    )


def _mapping(index: int, name: str, number: int, first: int) -> Object:
    used = number == 0
    places = (Entry(place, f"Mapped object {place}", U32, RW, first if used and place == 1 else 0)
              for place in range(1, 9))  # fmt: skip
    return Object(index, name, (Entry(0, "Number of mapped objects", U8, RW, int(used)), *places))
