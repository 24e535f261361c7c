"""The items of an STS servo's memory that the driver uses, and what their words mean; low byte first.

Source: Feetech, "SMS/STS memory table"; addresses compared with `ftservo-python-sdk` 2.0 and with the table that
LeRobot keeps. Neither knows the open-loop mode (2) and its place at Goal Time with the sign in bit 10: these are of
the manual, from memory.
"""

from math import nan
from struct import Struct

from drivers.actuator.reading import Reading
from drivers.feetech.frames import signed
from drivers.servos.frames import Item, error_names
from drivers.wraps import Turns

FIRMWARE = Item(0, 2, "firmware version")
MODEL_NUMBER = Item(3, 2, "model number")
LOWEST = Item(9, 2, "lowest position")
HIGHEST = Item(11, 2, "highest position")
OPERATING_MODE = Item(33, 1, "operating mode")
TORQUE_ENABLE = Item(40, 1, "torque enable")
GOAL_POSITION = Item(42, 6, "goal position, time and speed")
GOAL_DUTY = Item(44, 2, "goal time, in open loop the duty")
TORQUE_LIMIT = Item(48, 2, "torque limit")
LOCK = Item(55, 1, "lock")  # 0: what is written to the operating mode stays beyond power-off

# from torque enable to present current: what each exchange reads
PIECE = Item(TORQUE_ENABLE.address, 31, "what it measures")
LAYOUT = Struct("<B15x HHH BB x B x 2x H".replace(" ", ""))

POSITION_MODE, OPEN_LOOP_MODE = 0, 2
COUNTS_PER_TURN = 4096
DUTY_FULL = 1000  # of the goal in open loop, and of Present Load
LOAD_SIGN, SPEED_SIGN, CURRENT_SIGN, DUTY_SIGN = 10, 15, 15, 10
CURRENT_A = 6.5e-3
SUPPLY_V = 0.1

MODELS = {777: "STS3215", 2825: "STS3250", 11272: "SM8512BL"}

_ERRORS = {0: "voltage", 1: "position sensor", 2: "overheating", 3: "over-current", 5: "overload"}


def reading_of(data: bytes, asked_s: float, turns: Turns) -> Reading:
    """The piece `PIECE` in SI."""
    is_on, position, speed, load, supply, temperature, status, current = LAYOUT.unpack(data)
    counts_s = signed(speed, SPEED_SIGN)
    return Reading(
        asked_s, turns.follow(position, counts_s, asked_s), counts_s,
        signed(load, LOAD_SIGN) / DUTY_FULL,
        signed(current, CURRENT_SIGN) * CURRENT_A, nan,
        supply * SUPPLY_V, temperature, bool(is_on), error_names(status, _ERRORS),
    )  # fmt: skip
