"""The drive's position controller: a cascade P-PI, or PD with gravity feed-forward, on quantised position.

It gives a current; a voltage drive turns it into a duty by the resistance and the back-EMF constant of its data sheet.
While the current is commanded open loop, a tether stops the joint when it has left its place. The position loop takes
over without a bump: what the joint is off by fades out.
"""

from math import pi, sin
from typing import NamedTuple

from sim_backend.second_plant.compiled import compiled

CLOSED, OPEN = 0, 1  # modes of a trial's tick
FADE_S = 0.2  # in which the joint comes back to its target after an open-loop part


class Control(NamedTuple):
    """Gains of the drive, per rad and A at the joint."""

    cascade: bool
    voltage_drive: bool
    position_per_s: float  # speed asked for, per rad of error
    speed_a_s: float
    integral_a: float
    stiffness_a_rad: float
    inertia_a_s2: float  # feed-forward of the acceleration
    gravity_a: float  # feed-forward at 90 degrees
    most_a: float
    resistance_ohm: float  # as the drive believes
    emf_per_rad_s: float
    count_rad: float  # encoder count at the joint
    speed_filter_s: float
    tether_rad: float


class Loop(NamedTuple):
    """What the controller remembers."""

    position_rad: float
    speed_rad_s: float
    integral_a: float
    anchor_rad: float
    tethered: bool
    offset_rad: float  # from target to where the loop took over, fading


@compiled
def measured(control: Control, loop: Loop, position: float, tick_s: float) -> Loop:
    """Differentiate and filter the quantised position."""
    raw = (position - loop.position_rad) / tick_s
    share = tick_s / (control.speed_filter_s + tick_s)
    speed = loop.speed_rad_s + share * (raw - loop.speed_rad_s)
    return Loop(position, speed, loop.integral_a, loop.anchor_rad, loop.tethered, loop.offset_rad)


@compiled
def closed_a(
    control: Control, loop: Loop, target: float, speed: float, acceleration: float, tick_s: float
) -> tuple[float, float]:
    """Current asked for and the integral behind it [A]."""
    error = target - loop.position_rad
    feed = control.inertia_a_s2 * acceleration
    if control.cascade:
        speed_error = speed + control.position_per_s * error - loop.speed_rad_s
        integral = loop.integral_a + control.integral_a * speed_error * tick_s
        integral = min(max(integral, -control.most_a), control.most_a)
        return control.speed_a_s * speed_error + integral + feed, integral
    integral = loop.integral_a + control.integral_a * error * tick_s
    integral = min(max(integral, -0.5 * control.most_a), 0.5 * control.most_a)
    held = control.gravity_a * sin(loop.position_rad)
    damped = control.speed_a_s * (speed - loop.speed_rad_s)
    return control.stiffness_a_rad * error + damped + held + feed + integral, integral


@compiled
def asked(
    control: Control, loop: Loop, mode: int, tick: tuple[float, float, float, float], tick_s: float
) -> tuple[float, Loop]:
    """Current of one tick and the controller after it.

    Args:
        control: gains.
        loop: what is remembered.
        mode: CLOSED or OPEN.
        tick: target [rad], its speed [rad/s], its acceleration [rad/s^2], open-loop current [A].
        tick_s: period.
    """
    target, speed, acceleration, open_a = tick
    position, anchor, tethered, offset = loop.position_rad, loop.anchor_rad, loop.tethered, loop.offset_rad
    if mode == OPEN:
        offset = position - target
        if not tethered and abs(position - anchor) > control.tether_rad:
            anchor, tethered = position, True
        target, speed, acceleration = anchor, 0.0, 0.0
    else:
        anchor, tethered = position, False
        target, speed = target + offset, speed - offset / FADE_S
        offset *= 1.0 - tick_s / FADE_S
    if mode == OPEN and not tethered:
        current = open_a
        integral = open_a if control.cascade else open_a - control.gravity_a * sin(position)
    else:
        current, integral = closed_a(control, loop, target, speed, acceleration, tick_s)
    current = min(max(current, -control.most_a), control.most_a)
    return current, Loop(position, loop.speed_rad_s, integral, anchor, tethered, offset)


@compiled
def encoder(
    turns: float, counts_rad: float, angle: float, eccentricity_rad: float, interpolation: tuple[float, float, float]
) -> float:
    """Reading of the position sensor [rad at the joint], with its errors once and several times a turn.

    Args:
        turns: motor turns per joint turn.
        counts_rad: one count; 0 does not quantise.
        angle: of the motor / gear ratio.
        eccentricity_rad: amplitude once a motor turn.
        interpolation: amplitude [rad], order and pole pairs.
    """
    amplitude, order, pairs = interpolation
    motor = angle * turns
    reading = angle + eccentricity_rad * sin(motor) + amplitude * sin(order * pairs * motor + 0.25 * pi)
    if counts_rad <= 0.0:
        return reading
    return counts_rad * round(reading / counts_rad)
