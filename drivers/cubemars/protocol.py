"""CubeMars' part of the MIT protocol: ranges of the models, and answers with an error code. Pure functions.

The answer has the id, position, speed and torque, a temperature and an error code. There is no question: each frame
that is answered is a command. There are no registers either.

Source: CubeMars, "AK series actuator driver manual", chapter 5.3; error codes from its chapter 5.2.
"""

from typing import NamedTuple

from drivers.mit.frames import Motion, Ranges, motion

_COLDEST_C = 40  # the byte of the temperature counts from -40 degC

_ERRORS = {
    1: "motor over-temperature", 2: "over-current", 3: "over-voltage", 4: "under-voltage", 5: "encoder fault",
    6: "driver over-temperature", 7: "motor locked",
}  # fmt: skip

MODELS: dict[str, Ranges] = {
    "AK10-9": Ranges(12.5, 50.0, 65.0), "AK40-10": Ranges(12.5, 45.5, 5.0), "AK45-10": Ranges(12.5, 20.0, 8.0),
    "AK45-36": Ranges(12.5, 6.0, 34.0), "AK60-6": Ranges(12.5, 45.0, 15.0), "AK70-10": Ranges(12.5, 50.0, 25.0),
    "AK80-6": Ranges(12.5, 76.0, 12.0), "AK80-8": Ranges(12.5, 37.5, 32.0), "AK80-9": Ranges(12.5, 50.0, 18.0),
    "AK80-64": Ranges(12.5, 8.0, 144.0),
}  # fmt: skip
"""Ranges of the models by the present manual; older firmware of some has others."""


class Feedback(NamedTuple):
    """What an actuator answers."""

    motor_id: int
    motion: Motion
    temperature_c: float
    fault: str


def feedback(data: bytes, ranges: Ranges) -> Feedback:
    """Take an answer of eight bytes apart."""
    code = data[7]
    fault = _ERRORS.get(code, f"error {code}") if code else ""
    return Feedback(data[0], motion(int.from_bytes(data[1:6], "big"), ranges), data[6] - _COLDEST_C, fault)
