"""Current ramps from rest, both ways, at several rates and after several rests: what breakaway depends on."""

from functools import partial
from itertools import product
from math import ceil, sin
from typing import Annotated

import numpy as np
from pydantic import Field

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.config.reflected_load import load_current_a
from bench.config.rig import resolution_rad
from bench.control.cycle import Procedure, Reading
from bench.errors import LimitError, quantity_message
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan, a_current, trial_plan
from bench.experiments.parts.excursion import BRAKING_SHARE, comparing_cycles, slip_index
from bench.experiments.parts.joint import Joint, Part
from bench.experiments.parts.refusal import refuse_angles, refuse_load, refuse_many, refuse_servo, refuse_short
from bench.experiments.parts.search import STILL_COUNTS
from bench.json_types import Value, objects
from drivers.contract import Command, Mode

Rate = Annotated[float, Field(ge=0.005, le=100)]
Dwell = Annotated[float, Field(ge=0, le=3600)]
ONSET_COUNTS = 2.5  # that make a motion
EASE_S = 0.2  # from the current that the servo left to that of the rest
RUN_OUT_RAD = 0.25  # that a joint may run past the excursion before it is braked, at most
LARGEST_STEP = 0.05  # of the ceiling, in one control cycle: coarser, and the current at breakaway is not known
BREAKAWAY_SHARE = 0.15  # of the ceiling, roughly
RESTS_S = 3.0  # to the angle and back, and to settle, roughly


class BreakawayRampsParameters(Parameters):
    """Parameters of breakaway ramps.

    Before each ramp the joint stands for the dwell, under the current that holds up what hangs on it without friction
    (none at angle 0).
    """

    load_kg: float = quantity(0.0, "kg", "Load on the arm", ge=0)
    balanced: bool = quantity(False, "", "Balance the load: same weight on the axis, no gravity torque")
    angle_rad: float = quantity(0.0, "rad", "Angle at which the joint stands; 0 is vertically down")
    rates_a_s: tuple[Rate, ...] = quantity((0.1, 0.3, 1.0, 3.0), "A/s", "Rates of the ramps", min_length=1)
    dwells_s: tuple[Dwell, ...] = quantity((0.2, 2.0), "s", "Times at rest before each ramp", min_length=1)
    repeats: int = quantity(1, "", "Trials at each rate and dwell", ge=1, le=100)
    slip_speed_rad_s: float = quantity(0.05, "rad/s", "Speed that tells slip from pre-sliding", gt=0)
    excursion_rad: float = quantity(0.03, "rad", "Way after which a ramp ends; beyond the free play", gt=0, le=0.5)


def break_away(
    configuration: BenchConfiguration, parameters: BreakawayRampsParameters, rate_a_s: float, dwell_s: float
) -> Procedure:
    """The procedure: to the angle, and there one ramp up and one down, each after a dwell.

    Results:
        breakaways: one each way, as `_result`.
        search_ceiling_a: current at which a ramp is given up.
    """
    joint = Joint(configuration)
    yield from joint.wake()
    found = []
    for direction in (1, -1):
        yield from joint.rest_at(parameters.angle_rad)
        stood_s = yield from _rest(joint, parameters, configuration, dwell_s)
        readings, slipped = yield from _ramp(joint, parameters, configuration, direction * rate_a_s)
        found.append(_result(readings, slipped, direction, stood_s, parameters, configuration))
        detail = f"slip at {found[-1]['current_a']:.4g} A, {found[-1]['slip_s']:.4g} s" if slipped else "no slip"
        yield from joint.push(Command(Mode.CURRENT, _rest_current_a(parameters, configuration)), ("breakaway", detail))
        yield from joint.brake(BRAKING_SHARE * configuration.motion.acceleration_rad_s2)
    yield from joint.rest_at(0.0)
    return {"breakaways": found, "search_ceiling_a": configuration.search.ceiling_a}


def _rest(
    joint: Joint, parameters: BreakawayRampsParameters, configuration: BenchConfiguration, dwell_s: float
) -> Part[float]:
    """Ease to the current of the rest and dwell; how long the joint has stood by then [s]."""
    period_s, still_rad = configuration.control.period_s, STILL_COUNTS * resolution_rad(configuration.rig)
    begin_a, end_a = joint.command_a, _rest_current_a(parameters, configuration)
    ease, dwell = ceil(EASE_S / period_s), ceil(dwell_s / period_s)
    stood_rad, stood = joint.reading.sample.position_rad, configuration.motion.settled_cycles
    for cycle in range(1, ease + dwell + 1):
        share = min(cycle / ease, 1.0)
        event = ("breakaway", f"dwell {dwell_s:g} s") if cycle == ease + 1 else None
        reading = yield from joint.push(Command(Mode.CURRENT, begin_a + share * (end_a - begin_a)), event)
        stood += 1
        if abs(reading.sample.position_rad - stood_rad) > still_rad:
            stood_rad, stood = reading.sample.position_rad, 0
    return stood * period_s


def _ramp(
    joint: Joint, parameters: BreakawayRampsParameters, configuration: BenchConfiguration, rate_a_s: float
) -> Part[tuple[list[Reading], bool]]:
    """Readings from the last one at rest, and whether the joint moved by the excursion."""
    period_s, ceiling_a = configuration.control.period_s, configuration.search.ceiling_a
    readings = [joint.reading]
    begin_a = _rest_current_a(parameters, configuration)
    event: tuple[str, str] | None = ("breakaway", f"ramp {rate_a_s:+g} A/s")
    while True:
        current_a = begin_a + rate_a_s * len(readings) * period_s
        if abs(current_a) > ceiling_a:
            return readings, False
        readings.append((yield from joint.push(Command(Mode.CURRENT, current_a), event)))
        event = None
        # either way: what runs away against the ramp has to be caught, too
        if abs(readings[-1].sample.position_rad - readings[0].sample.position_rad) >= parameters.excursion_rad:
            return readings, True


def _result(
    readings: list[Reading], slipped: bool, direction: int, stood_s: float,
    parameters: BreakawayRampsParameters, configuration: BenchConfiguration,
) -> dict[str, Value]:  # fmt: skip
    """One breakaway.

    Returns:
        direction, stood_s: of the ramp, and how long the joint had not moved before.
        current_a: of the motor, measured or by eq. (3), in the last cycle before slip; None without slip.
        onset_current_a: in the cycle of the first motion, however slow; None where nothing moved.
        ramp_s, slip_s: from the start of the ramp, and of the trial, to that cycle.
        travel_before_slip_rad: from the rest to that cycle, along the ramp: pre-sliding, creep, and free play.
        travel_rad: along the ramp, to its end.
    """
    way_rad = direction * np.array([reading.sample.position_rad for reading in readings])
    way_rad -= way_rad[0]
    moved = np.flatnonzero(np.abs(way_rad) > ONSET_COUNTS * resolution_rad(configuration.rig))
    result: dict[str, Value] = {
        "direction": direction,
        "stood_s": stood_s,
        "travel_rad": float(way_rad[-1]),
        "onset_current_a": readings[moved[0]].current_a if len(moved) else None,
    }
    names = ("current_a", "ramp_s", "slip_s", "travel_before_slip_rad")
    if not slipped:
        return result | dict.fromkeys(names)
    period_s = configuration.control.period_s
    last = slip_index(way_rad, parameters.slip_speed_rad_s, period_s, resolution_rad(configuration.rig))
    at = readings[last]
    values = (at.current_a, at.time_s - readings[0].time_s, at.time_s, float(way_rad[last]))
    return result | dict(zip(names, values, strict=True))


def _rest_current_a(parameters: BreakawayRampsParameters, configuration: BenchConfiguration) -> float:
    """What holds the joint without friction; a rig that does not tell stands at angle 0 only."""
    if sin(parameters.angle_rad) == 0.0:
        return 0.0
    load_kg = 0.0 if parameters.balanced else parameters.load_kg
    return load_current_a(load_kg, parameters.angle_rad, configuration.rig)


def _plan(parameters: BreakawayRampsParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    rates, dwells = enumerate(parameters.rates_a_s, 1), enumerate(parameters.dwells_s, 1)
    return [
        trial_plan(
            configuration, f"dwell-{rest:02d}-rate-{number:02d}-{repeat:02d}",
            partial(break_away, configuration, parameters, rate_a_s, dwell_s), parameters.load_kg, parameters.balanced,
            angle_rad=parameters.angle_rad, rate_a_s=rate_a_s, dwell_s=dwell_s, repeat=repeat,
        )
        for (rest, dwell_s), (number, rate_a_s), repeat in product(dwells, rates, range(1, parameters.repeats + 1))
    ]  # fmt: skip


def _refuse(parameters: BreakawayRampsParameters, configuration: BenchConfiguration) -> None:
    trials = len(parameters.rates_a_s) * len(parameters.dwells_s) * parameters.repeats
    refuse_many(trials, "rates_a_s, dwells_s and repeats")
    refuse_load("load_kg", parameters.load_kg, configuration)
    refuse_angles("angle_rad", [0.0, parameters.angle_rad], parameters.excursion_rad + RUN_OUT_RAD, configuration)
    refuse_servo(configuration)
    ceiling_a, period_s = configuration.search.ceiling_a, configuration.control.period_s
    fastest_a_s = LARGEST_STEP * ceiling_a / period_s
    for rate_a_s in parameters.rates_a_s:
        if rate_a_s > fastest_a_s:
            allowed = f"at most {fastest_a_s:.4g}, which is {LARGEST_STEP:.0%} of search.ceiling_a in a control cycle"
            raise LimitError(quantity_message("a rate of rates_a_s", rate_a_s, allowed, "A/s"))
    _refuse_excursion(parameters, configuration)
    rest_a = _rest_current_a(parameters, configuration)
    if abs(rest_a) >= ceiling_a:
        allowed = f"below search.ceiling_a, {ceiling_a:g}"
        raise LimitError(quantity_message("the current that holds the load at angle_rad", rest_a, allowed, "A"))


def _refuse_excursion(parameters: BreakawayRampsParameters, configuration: BenchConfiguration) -> None:
    """The way has to hold the free play, and a few comparisons of positions."""
    count_rad, period_s = resolution_rad(configuration.rig), configuration.control.period_s
    cycles = comparing_cycles(parameters.slip_speed_rad_s, period_s, count_rad)
    compared_rad = 2.0 * parameters.slip_speed_rad_s * cycles * period_s
    least_rad = max(2.0 * (configuration.rig.gear.backlash_rad or 0.0), compared_rad)
    why = "twice the backlash, or what slip_speed_rad_s makes of it"
    refuse_short("excursion_rad", parameters.excursion_rad, least_rad, why)


def _duration_s(parameters: BreakawayRampsParameters, configuration: BenchConfiguration) -> float:
    breakaway_a = BREAKAWAY_SHARE * configuration.search.ceiling_a
    ramps = product(parameters.rates_a_s, parameters.dwells_s)
    one_way_s = [EASE_S + dwell_s + breakaway_a / rate_a_s + RESTS_S / 2.0 for rate_a_s, dwell_s in ramps]
    return 2.0 * parameters.repeats * sum(one_way_s)


def _summarise(_parameters: BreakawayRampsParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    rows = [
        {**{name: trial.conditions[name] for name in ("rate_a_s", "dwell_s", "repeat")}, **breakaway}
        for trial in trials
        for breakaway in objects(trial.results.get("breakaways"))
    ]
    slipped = [row for row in rows if row["current_a"] is not None]
    return {"rows": rows, "breakaways": len(slipped), "without_slip": len(rows) - len(slipped)}


KIND = ExperimentKind(
    name="breakaway-ramps",
    title="Breakaway ramps",
    summary="Raises the current from rest until the joint slips, both ways, at several rates and after several rests. "
    "It shows pre-sliding, and how breakaway depends on rate and dwell.",
    parameters=BreakawayRampsParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results={
        "breakaways": "of each ramp: direction; stood_s, how long the joint had stood; current_a in the last cycle "
        "before slip; onset_current_a in the cycle of the first motion; ramp_s and slip_s, from the start of the ramp "
        "and of the trial; travel_before_slip_rad; travel_rad to the end of the ramp. Null without slip",
        "search_ceiling_a": "highest current of the bench's own search, beside which breakaway is seen",
    },
    modes=a_current,
)
