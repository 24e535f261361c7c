"""The items of the control table that the driver uses, and what their words mean; low byte first.

Source: ROBOTIS e-Manual, control tables of the X series; addresses compared with the tables of `dynamixel-sdk` 4.1.
"""

from struct import Struct

from drivers.servos.frames import Item

MODEL_NUMBER = Item(0, 2, "Model Number")
FIRMWARE = Item(6, 1, "Firmware Version")
RETURN_DELAY = Item(9, 1, "Return Delay Time")  # [2 us]
OPERATING_MODE = Item(11, 1, "Operating Mode")
CURRENT_LIMIT = Item(38, 2, "Current Limit")
TORQUE_ENABLE = Item(64, 1, "Torque Enable")
STATUS_RETURN = Item(68, 1, "Status Return Level")
HARDWARE_ERROR = Item(70, 1, "Hardware Error Status")
BUS_WATCHDOG = Item(98, 1, "Bus Watchdog")
GOAL_PWM = Item(100, 2, "Goal PWM")
GOAL_CURRENT = Item(102, 2, "Goal Current")
GOAL_POSITION = Item(116, 4, "Goal Position")
INDIRECT_ADDRESS = 168  # of two bytes for each byte of indirect data

WATCHDOG_STEP_S = 0.02
WATCHDOG_TRIPPED = 0xFF  # -1: nothing was heard for so long; demands are refused until 0 is written
CURRENT_MODE, POSITION_MODE, PWM_MODE = 0, 4, 16  # 4: extended position, over many turns
ANSWERS_ALL = 2  # Status Return Level
DUTY_FULL = 885  # of Goal PWM and Present PWM
VELOCITY_RPM = 0.229  # one step of Present Velocity
COUNTS_PER_TURN = 4096
COUNTS_S = VELOCITY_RPM / 60.0 * COUNTS_PER_TURN  # the same, in counts a second
SUPPLY_V = 0.1
TICK_S, TICK_BITS = 1e-3, 15  # of Realtime Tick

# what each exchange asks for, gathered by indirect addresses into one piece
GATHERED = (
    *range(124, 136),  # Present PWM, Current (or Load), Velocity, Position
    TORQUE_ENABLE.address,
    HARDWARE_ERROR.address,
    BUS_WATCHDOG.address,
    *range(120, 122),  # Realtime Tick
    *range(144, 147),  # Present Input Voltage, Temperature
)
LAYOUT = Struct("<hhiiBBBHHB")

ERRORS = {0: "input voltage", 2: "overheating", 3: "motor encoder", 4: "electrical shock", 5: "overload"}
