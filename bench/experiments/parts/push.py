"""A push: the effort rises slowly until the joint has moved so far, then the power is off until it stands."""

from math import ceil, inf
from typing import NamedTuple

from bench.control.cycle import OFF, Reading
from bench.errors import ExperimentError
from bench.experiments.analysis.commissioning_checks import Push
from bench.experiments.parts.joint import Joint, Part
from drivers.contract import Command, Mode

STILL_CYCLES = 10
LONGEST_BRAKING_S = 0.5
SLOW_SHARE = 0.25  # of the speed at which braking began, where it ends


class PushSettings(NamedTuple):
    """How the joint is pushed.

    Attributes:
        mode: CURRENT, or DUTY of a drive whose motor is not known yet.
        rate_s: how fast the demand rises, per second, in the unit of the mode.
        ceiling: largest demand, in the unit of the mode.
        ceiling_a: largest motor current [A]; what is measured is compared where the demand is no current.
        ceiling_name: what sets the ceiling, for messages.
        coast_s: longest wait for the joint to stand again [s].
        period_s: control period [s].
        onset_rad: way after which the joint counts as let go.
        boost: what the demand is multiplied by then, so that inertia shows beside friction.
        brakes: the demand is reversed after the way until the joint is slow, so that a joint with little friction does
            not coast far; these readings count as coasting.
    """

    mode: Mode
    rate_s: float
    ceiling: float
    ceiling_a: float
    ceiling_name: str
    coast_s: float
    period_s: float
    onset_rad: float = inf
    boost: float = 1.0
    brakes: bool = False


def push(joint: Joint, direction: int, excursion_rad: float, settings: PushSettings) -> Part[Push]:
    """Push one way and coast.

    Args:
        joint: at rest, after its first reading.
        direction: 1 or -1, of the demand.
        excursion_rad: way after which the power is taken away, either way: a wrong sign must end the push, too.
        settings: how.

    Raises:
        ExperimentError: the joint does not move under the ceiling, or does not come to stand.
    """
    start_rad = joint.reading.sample.position_rad
    driven: list[Reading] = []
    demand, way_rad, has_let_go = 0.0, 0.0, False
    while way_rad < excursion_rad:
        demand += settings.rate_s * settings.period_s
        if not has_let_go and way_rad >= settings.onset_rad:
            has_let_go, demand = True, min(settings.boost * demand, settings.ceiling)
        if demand > settings.ceiling or (driven and abs(driven[-1].current_a) > settings.ceiling_a):
            raise ExperimentError(_stuck(driven, way_rad, excursion_rad, settings))
        driven.append((yield from joint.push(Command(settings.mode, direction * demand))))
        way_rad = abs(driven[-1].sample.position_rad - start_rad)
    braked = (yield from _brake(joint, -direction * demand, driven, settings)) if settings.brakes else []
    return Push(direction, driven, [*braked, *(yield from _coast(joint, settings))])


def _brake(joint: Joint, demand: float, driven: list[Reading], settings: PushSettings) -> Part[list[Reading]]:
    """Hold a demand against the motion until the joint is slow; for a short while only, whatever the sensor says."""
    end_rad_s = driven[-1].velocity_rad_s
    readings: list[Reading] = []
    while len(readings) * settings.period_s < LONGEST_BRAKING_S:
        readings.append((yield from joint.push(Command(settings.mode, demand))))
        if readings[-1].velocity_rad_s * end_rad_s <= SLOW_SHARE * end_rad_s**2:
            break
    return readings


def _coast(joint: Joint, settings: PushSettings) -> Part[list[Reading]]:
    """Without power, until the joint has stood for a few cycles."""
    readings: list[Reading] = []
    still = 0
    for _ in range(ceil(settings.coast_s / settings.period_s)):
        before_rad = joint.reading.sample.position_rad
        readings.append((yield from joint.push(OFF)))
        still = still + 1 if readings[-1].sample.position_rad == before_rad else 0
        if still >= STILL_CYCLES:
            return readings
    raise ExperimentError(
        f"the joint still moves {settings.coast_s:g} s after the power was taken away; let it hang free, and see "
        "that the encoder is quiet"
    )


def _stuck(driven: list[Reading], way_rad: float, excursion_rad: float, settings: PushSettings) -> str:
    at = f"{settings.ceiling:g} A ({settings.ceiling_name})"
    if settings.mode is not Mode.CURRENT:
        current_a = driven[-1].current_a if driven else 0.0
        at = f"a duty of {driven[-1].sample.duty:.3g} and {current_a:.3g} A ({settings.ceiling_name})"
    return (
        f"the joint moved by {way_rad:.3g} rad only at {at}; {excursion_rad:g} rad is wanted. Is the motor connected, "
        "the brake released, the encoder plugged in, the arm free?"
    )
