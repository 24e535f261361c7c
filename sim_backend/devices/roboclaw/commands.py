"""The commands of packet serial that this device knows: number, name, payload, reply.

Layouts are of `struct`, big-endian: B u8, H u16, h i16, I u32, i i32. A command that is answered with data has no
payload and comes without a CRC; every other is acknowledged with 0xFF, and nothing answers one that is not valid.
"""

from dataclasses import dataclass
from struct import calcsize

ACKNOWLEDGED = b"\xff"


@dataclass(frozen=True, slots=True)
class Command:
    """One command of the manual.

    Attributes:
        payload: layout of what comes with it.
        reply: layout of what it is answered with; "" is the acknowledgement, "text" a text.
    """

    name: str
    payload: str = ""
    reply: str = ""

    @property
    def payload_length(self) -> int:
        """Bytes of payload."""
        return calcsize(">" + self.payload)


COMMANDS: dict[int, Command] = {
    0: Command("forward_1", "B"),
    1: Command("backward_1", "B"),
    4: Command("forward_2", "B"),
    5: Command("backward_2", "B"),
    6: Command("drive_1", "B"),
    7: Command("drive_2", "B"),
    14: Command("set_serial_timeout", "B"),
    15: Command("serial_timeout", reply="B"),
    16: Command("count_1", reply="IB"),
    17: Command("count_2", reply="IB"),
    18: Command("speed_1", reply="iB"),
    19: Command("speed_2", reply="iB"),
    20: Command("reset_counts"),
    21: Command("version", reply="text"),
    22: Command("set_count_1", "i"),
    23: Command("set_count_2", "i"),
    24: Command("main_voltage", reply="H"),
    25: Command("logic_voltage", reply="H"),
    28: Command("set_velocity_pid_1", "IIII"),
    29: Command("set_velocity_pid_2", "IIII"),
    30: Command("raw_speed_1", reply="iB"),
    31: Command("raw_speed_2", reply="iB"),
    32: Command("duty_1", "h"),
    33: Command("duty_2", "h"),
    34: Command("duty_both", "hh"),
    35: Command("speed_command_1", "i"),
    36: Command("speed_command_2", "i"),
    37: Command("speed_command_both", "ii"),
    48: Command("applied_duties", reply="hh"),
    49: Command("currents", reply="hh"),
    52: Command("ramped_duty_1", "hI"),
    53: Command("ramped_duty_2", "hI"),
    54: Command("ramped_duty_both", "hIhI"),
    55: Command("velocity_pid_1", reply="IIII"),
    56: Command("velocity_pid_2", reply="IIII"),
    57: Command("set_main_limits", "HH"),
    58: Command("set_logic_limits", "HH"),
    59: Command("main_limits", reply="HH"),
    60: Command("logic_limits", reply="HH"),
    78: Command("counts", reply="II"),
    79: Command("raw_speeds", reply="ii"),
    80: Command("restore_defaults"),
    82: Command("temperature", reply="H"),
    83: Command("temperature_2", reply="H"),
    90: Command("status", reply="I"),
    91: Command("encoder_modes", reply="BB"),
    92: Command("set_encoder_mode_1", "B"),
    93: Command("set_encoder_mode_2", "B"),
    94: Command("save_settings", "I"),
    108: Command("speeds", reply="ii"),
    133: Command("set_current_limit_1", "II"),
    134: Command("set_current_limit_2", "II"),
    135: Command("current_limit_1", reply="II"),
    136: Command("current_limit_2", reply="II"),
    148: Command("set_pwm_mode", "B"),
    149: Command("pwm_mode", reply="B"),
}
