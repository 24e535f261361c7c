"""Checks of what is asked against the limits of the bench, before anything moves."""

from collections.abc import Iterable

from bench.configuration import BenchConfiguration
from bench.errors import LimitError, quantity_message


def refuse_load(name: str, load_kg: float, configuration: BenchConfiguration) -> None:
    """Raise `LimitError` for a load heavier than the bench carries."""
    limit_kg = configuration.limits.load_kg
    if load_kg > limit_kg:
        raise LimitError(quantity_message(name, load_kg, f"at most {limit_kg:g}", "kg", "Hang a lighter load"))


def refuse_angles(name: str, angles_rad: Iterable[float], margin_rad: float, configuration: BenchConfiguration) -> None:
    """Raise `LimitError` for angles that, with a margin for what the motion may overshoot, leave the allowed range."""
    limits = configuration.limits
    low_rad, high_rad = limits.position_min_rad + margin_rad, limits.position_max_rad - margin_rad
    for angle_rad in angles_rad:
        if not low_rad <= angle_rad <= high_rad:
            allowed = f"{low_rad:.4g} .. {high_rad:.4g} (the limits less a margin of {margin_rad:.4g} rad)"
            raise LimitError(quantity_message(name, angle_rad, allowed, "rad"))


def refuse_speed(name: str, speed_rad_s: float, configuration: BenchConfiguration) -> None:
    """Raise `LimitError` for a speed above the limit."""
    limit_rad_s = configuration.limits.speed_rad_s
    if speed_rad_s > limit_rad_s:
        raise LimitError(quantity_message(name, speed_rad_s, f"at most {limit_rad_s:g}", "rad/s"))


def refuse_currents(configuration: BenchConfiguration) -> None:
    """Raise `LimitError` where the servo or the search may ask for more current than the limit."""
    limit_a = configuration.limits.current_a
    for name, asked_a in (
        ("servo.current_a", configuration.servo.current_a),
        ("search.ceiling_a", configuration.search.ceiling_a),
    ):
        if asked_a > limit_a:
            step = "Correct the bench configuration"
            raise LimitError(quantity_message(name, asked_a, f"at most limits.current_a, {limit_a:g}", "A", step))
