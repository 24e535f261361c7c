"""The map of our own drive, register for register as docs/modbus-map.md has it."""

from sim_backend.devices.modbus.registers import Kind, Register

U16, I16, U32, I32 = Kind.U16, Kind.I16, Kind.U32, Kind.I32
COMMAND_BLOCK = range(5)
DEVICE, FIRMWARE, SERIAL = 0xFB01, 0x0100, 1
PRODUCT = "simulated drive"
_PRODUCT_AT, _PRODUCT_WORDS = 210, 10

REGISTERS = (
    Register(0, "control", U16, 0, 3),
    Register(1, "mode", U16, 0, 1),
    Register(2, "duty_demand", I16, -10000, 10000),
    Register(3, "current_demand", I32, -100_000, 100_000),
    Register(16, "watchdog", U16, 0, 60_000),
    Register(17, "current_limit", U16, 1, 65_535),
    Register(18, "word_order", U16, 0, 1),
    Register(100, "status", U16),
    Register(101, "fault", U16),
    Register(102, "position", I32),
    Register(104, "velocity", I32),
    Register(106, "duty", I16),
    Register(107, "current", I16),
    Register(108, "supply", U16),
    Register(109, "temperature", I16),
    Register(110, "time", U32),
    Register(200, "device", U16),
    Register(201, "firmware", U16),
    Register(202, "serial_number", U32),
    *(Register(_PRODUCT_AT + place, f"product_{place}", U16) for place in range(_PRODUCT_WORDS)),
)

DEFAULTS = {
    "control": 0,
    "mode": 0,
    "duty_demand": 0,
    "current_demand": 0,
    "watchdog": 0,
    "current_limit": 3000,
    "word_order": 0,
}


def identity() -> dict[str, int]:
    """Return the values that never change."""
    text = PRODUCT.encode("ascii").ljust(2 * _PRODUCT_WORDS, b"\0")
    words = {f"product_{place}": text[2 * place] << 8 | text[2 * place + 1] for place in range(_PRODUCT_WORDS)}
    return {"device": DEVICE, "firmware": FIRMWARE, "serial_number": SERIAL, **words}
