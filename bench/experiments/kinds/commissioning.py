"""The commissioning move: two small pushes that tell whether a drive's signs and scales are those of the joint."""

from collections.abc import Iterator
from functools import partial
from math import ceil

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.config.rig import resolution_rad
from bench.control.cycle import OFF, Procedure, Reading
from bench.errors import ExperimentError, LimitError, quantity_message
from bench.experiments.analysis.commissioning_checks import Finding, Push, findings, position_findings
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan, conditions
from bench.experiments.parts.joint import Joint, Part
from bench.experiments.parts.position_push import push_there_and_back
from bench.experiments.parts.refusal import refuse_angles, refuse_currents
from bench.json_types import Value
from drivers.contract import Command, Mode

MARGIN_RAD = 0.5  # what the joint may coast beyond the excursion, or hang beside angle 0
LONGEST_RAD = 0.6
STILL_CYCLES = 10
NAME = "commissioning"


class CommissioningParameters(Parameters):
    """Parameters of the commissioning move."""

    excursion_rad: float = quantity(
        0.15,
        "rad",
        "Way of each push, after which the power is taken away; longer where it does not tell",
        gt=0,
        le=0.5,
    )
    rate_a_s: float = quantity(0.3, "A/s", "How fast the current rises until the joint moves", gt=0, le=10)
    coast_s: float = quantity(3.0, "s", "Longest wait for the joint to stand again", gt=0, le=30)


class PositionMoveParameters(CommissioningParameters):
    """The same, of a drive that closes positions and takes nothing else."""


def _adapt(parameters: CommissioningParameters, modes: frozenset[Mode]) -> CommissioningParameters:
    return PositionMoveParameters(**parameters.model_dump()) if modes == {Mode.POSITION} else parameters


def _plan(parameters: CommissioningParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    return [
        TrialPlan(
            name="push",
            conditions=conditions(configuration, load_kg=0.0, balanced=False),
            procedure=partial(commission, parameters, configuration),
            load_kg=0.0,
        )
    ]


def _refuse(parameters: CommissioningParameters, configuration: BenchConfiguration) -> None:
    refuse_angles("angle 0", [0.0], parameters.excursion_rad + MARGIN_RAD, configuration)
    refuse_currents(configuration)
    least_rad = 20.0 * resolution_rad(configuration.rig)
    if parameters.excursion_rad < least_rad:
        allowed = f"at least {least_rad:.3g} (20 encoder counts)"
        raise LimitError(quantity_message("excursion_rad", parameters.excursion_rad, allowed, "rad"))


def commission(parameters: CommissioningParameters, configuration: BenchConfiguration) -> Procedure:
    """The procedure: push one way, coast, push the other way, coast; then compare.

    A drive that closes positions alone is asked for a position there, and back.

    Raises:
        ExperimentError: the joint does not move, or a check is not passed; with what to correct.
    """
    joint = Joint(configuration)
    yield from joint.wake()
    pushes: list[Push] = []
    found: list[Finding] = []
    for longer in _lengthened(parameters, configuration):
        if isinstance(longer, PositionMoveParameters):
            pushes = yield from push_there_and_back(joint, longer.excursion_rad, longer.coast_s, configuration)
            found = position_findings(pushes, configuration.rig)
        else:
            forward = yield from _push(joint, 1, longer, configuration)
            pushes = [forward, (yield from _push(joint, -1, longer, configuration))]
            found = findings(pushes, configuration.rig)
        if not any(finding.asks_for_more for finding in found):
            break
    wrong = [f"{finding.name}: {finding.sentence}" for finding in found if finding.passed is False]
    if wrong:
        raise ExperimentError("; ".join(wrong))
    return {
        "travel_rad": [push.travel_rad for push in pushes],
        "passed": [finding.name for finding in found if finding.passed],
        "not_checked": [finding.name for finding in found if finding.passed is None],
        "sentences": [f"{finding.name}: {finding.sentence}" for finding in found],
    }


def _lengthened(
    parameters: CommissioningParameters, configuration: BenchConfiguration
) -> Iterator[CommissioningParameters]:
    """As asked, then twice and four times as far, as long as the limits leave room.

    Encoder counts four times too large end a push after a quarter of the way, too slow to be told by it.
    """
    yield parameters
    limits = configuration.limits
    room_rad = min(limits.position_max_rad, -limits.position_min_rad) - MARGIN_RAD
    for factor in (2.0, 4.0):
        excursion_rad = factor * parameters.excursion_rad
        if excursion_rad <= min(room_rad, LONGEST_RAD):
            yield parameters.model_copy(update={"excursion_rad": excursion_rad})


def _push(
    joint: Joint, direction: int, parameters: CommissioningParameters, configuration: BenchConfiguration
) -> Part[Push]:
    start_rad = joint.reading.sample.position_rad
    step_a = parameters.rate_a_s * configuration.control.period_s
    driven: list[Reading] = []
    current_a = 0.0
    # either way: a wrong sign must end the push, too
    while not driven or abs(driven[-1].sample.position_rad - start_rad) < parameters.excursion_rad:
        current_a += step_a
        if current_a > configuration.search.ceiling_a:
            raise ExperimentError(
                f"the joint moved by {_way(driven, start_rad):.3g} rad only at {configuration.search.ceiling_a:g} A "
                f"(search.ceiling_a); {parameters.excursion_rad:g} rad is wanted. Is the motor connected, the brake "
                "released, the encoder plugged in, the arm free?"
            )
        driven.append((yield from joint.push(Command(Mode.CURRENT, direction * current_a))))
    return Push(direction, driven, (yield from _coast(joint, parameters, configuration)))


def _coast(joint: Joint, parameters: CommissioningParameters, configuration: BenchConfiguration) -> Part[list[Reading]]:
    """Without power, until the joint has stood for a few cycles."""
    readings: list[Reading] = []
    still = 0
    for _ in range(ceil(parameters.coast_s / configuration.control.period_s)):
        before_rad = joint.reading.sample.position_rad
        readings.append((yield from joint.push(OFF)))
        still = still + 1 if readings[-1].sample.position_rad == before_rad else 0
        if still >= STILL_CYCLES:
            return readings
    raise ExperimentError(
        f"the joint still moves {parameters.coast_s:g} s after the power was taken away; let it hang free, and see "
        "that the encoder is quiet"
    )


def _way(driven: list[Reading], start_rad: float) -> float:
    return abs(driven[-1].sample.position_rad - start_rad) if driven else 0.0


def _duration_s(parameters: CommissioningParameters, _configuration: BenchConfiguration) -> float:
    return 2.0 * (1.0 / parameters.rate_a_s + 1.0)


def _summarise(_parameters: CommissioningParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    return dict(trials[0].results) if trials else {}


KIND = ExperimentKind(
    name=NAME,
    title="Commissioning move",
    summary="Pushes the joint a few degrees one way and the other, without load, and compares signs, velocity, current "
    "and encoder counts with the rig. A real drive has to pass it before anything else is run.",
    parameters=CommissioningParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    adapt=_adapt,
)
