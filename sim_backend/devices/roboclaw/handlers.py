"""What each command does, by its number."""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from sim_backend.devices.roboclaw.channel import FULL_DUTY, Settings

if TYPE_CHECKING:
    from sim_backend.devices.roboclaw.device import RoboClaw

Values = tuple[int, ...]
Handler = Callable[..., Values]

_LOGIC_VOLTAGE = 120  # 0.1 V


def handlers_of(device: "RoboClaw") -> dict[int, Handler]:
    """Return a handler for each command: it takes the payload's values and returns those of the reply."""
    return _motion(device) | _encoders(device) | _measurements(device) | _settings(device)


def _motion(device: "RoboClaw") -> dict[int, Handler]:
    def both(duty_1: int, duty_2: int) -> Values:
        return device.drive(0, duty_1) + device.drive(1, duty_2)

    def both_ramped(duty_1: int, rate_1: int, duty_2: int, rate_2: int) -> Values:
        return device.drive(0, duty_1, rate_1) + device.drive(1, duty_2, rate_2)

    def both_speeds(speed_1: int, speed_2: int) -> Values:
        return device.turn(0, speed_1) + device.turn(1, speed_2)

    return {
        0: lambda value: device.drive(0, _seven_bits(value)),
        1: lambda value: device.drive(0, -_seven_bits(value)),
        4: lambda value: device.drive(1, _seven_bits(value)),
        5: lambda value: device.drive(1, -_seven_bits(value)),
        6: lambda value: device.drive(0, _around_64(value)),
        7: lambda value: device.drive(1, _around_64(value)),
        32: partial(device.drive, 0),
        33: partial(device.drive, 1),
        34: both,
        35: partial(device.turn, 0),
        36: partial(device.turn, 1),
        37: both_speeds,
        52: partial(device.drive, 0),
        53: partial(device.drive, 1),
        54: both_ramped,
    }


def _encoders(device: "RoboClaw") -> dict[int, Handler]:
    return {
        16: partial(device.read_count, 0),
        17: partial(device.read_count, 1),
        18: partial(device.read_speed, 0, raw=False),
        19: partial(device.read_speed, 1, raw=False),
        20: lambda: device.set_count(0, 0) + device.set_count(1, 0),
        22: partial(device.set_count, 0),
        23: partial(device.set_count, 1),
        30: partial(device.read_speed, 0, raw=True),
        31: partial(device.read_speed, 1, raw=True),
        78: device.read_counts,
        79: partial(device.read_speeds, raw=True),
        91: lambda: tuple(device.settings.encoder_modes),
        92: lambda mode: _put(device.settings.encoder_modes, 0, mode),
        93: lambda mode: _put(device.settings.encoder_modes, 1, mode),
        108: device.read_mean_speeds,
    }


def _measurements(device: "RoboClaw") -> dict[int, Handler]:
    return {
        21: lambda: (),  # a text, the same at every time
        24: device.read_main_voltage,
        25: lambda: (_LOGIC_VOLTAGE,),
        48: device.read_duties,
        49: device.read_currents,
        82: device.read_temperature,
        83: device.read_temperature,
        90: device.read_status,
    }


def _settings(device: "RoboClaw") -> dict[int, Handler]:
    def now() -> Settings:  # `restore_defaults` replaces them
        return device.settings

    def set_pid(motor: int, d: int, p: int, i: int, full_speed: int) -> Values:
        return _put(now().velocity_pids, motor, (p, i, d, full_speed))

    def set_current_limit(motor: int, most: int, least: int) -> Values:
        return _put(now().current_limits, motor, (most, least))

    return {
        14: lambda value: _set(now(), "serial_timeout", value),
        15: lambda: (now().serial_timeout,),
        28: partial(set_pid, 0),
        29: partial(set_pid, 1),
        55: lambda: now().velocity_pids[0],
        56: lambda: now().velocity_pids[1],
        57: lambda least, most: _set(now(), "main_limits", (least, most)),
        58: lambda least, most: _set(now(), "logic_limits", (least, most)),
        59: lambda: now().main_limits,
        60: lambda: now().logic_limits,
        80: device.restore_defaults,
        94: lambda _key: (),  # settings live as long as the process
        133: partial(set_current_limit, 0),
        134: partial(set_current_limit, 1),
        135: lambda: now().current_limits[0],
        136: lambda: now().current_limits[1],
        148: lambda value: _set(now(), "pwm_mode", value),
        149: lambda: (now().pwm_mode,),
    }


def _set(settings: Settings, name: str, value: object) -> Values:
    setattr(settings, name, value)
    return ()


def _put(values: list[Any], place: int, value: Any) -> Values:
    values[place] = value
    return ()


def _seven_bits(value: int) -> int:
    return min(value, 127) * FULL_DUTY // 127


def _around_64(value: int) -> int:
    return (min(value, 127) - 64) * FULL_DUTY // 64
