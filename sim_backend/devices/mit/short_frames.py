"""The eight bytes of the Mini Cheetah's frames: 16 bits of position, 12 of everything else."""

from sim_backend.devices.mit.motor import Command, MitMotor, number, word_of

STIFFNESS_MAX, DAMPING_MAX = 500.0, 5.0
Top = tuple[float, float, float]
"""Ranges of position [rad], speed [rad/s] and torque [N m], either way."""


def command_of(data: bytes, top: Top) -> Command:
    """Return what a command says."""
    bits = int.from_bytes(data, "big")
    position, speed, torque = top
    return Command(
        number(bits >> 48, 16, -position, position),
        number(bits >> 36 & 0xFFF, 12, -speed, speed),
        number(bits >> 24 & 0xFFF, 12, 0.0, STIFFNESS_MAX),
        number(bits >> 12 & 0xFFF, 12, 0.0, DAMPING_MAX),
        number(bits & 0xFFF, 12, -torque, torque),
    )


def motion_of(motor: MitMotor, top: Top) -> bytes:
    """Return the five bytes of position, speed and torque."""
    position, speed, torque = top
    word = word_of(motor.position_rad, 16, -position, position) << 24
    word |= word_of(motor.speed_rad_s, 12, -speed, speed) << 12
    word |= word_of(motor.torque_n_m, 12, -torque, torque)
    return word.to_bytes(5, "big")
