"""The commissioning move: two small pushes that tell whether a drive's signs and scales are those of the joint."""

from collections.abc import Iterator
from functools import partial

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.config.rig import resolution_rad
from bench.control.cycle import Procedure
from bench.errors import ExperimentError
from bench.experiments.analysis.commissioning_checks import Finding, Push, findings, position_findings
from bench.experiments.kind import ExperimentKind, Parameters, TrialPlan, results_of_the_trial, trial_plan
from bench.experiments.parts.joint import Joint
from bench.experiments.parts.position_push import push_there_and_back
from bench.experiments.parts.push import PushSettings, push
from bench.experiments.parts.refusal import refuse_angles, refuse_currents, refuse_short
from drivers.contract import Mode

MARGIN_RAD = 0.5  # what the joint may coast beyond the excursion, or hang beside angle 0
LONGEST_RAD = 0.6
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
    return [trial_plan(configuration, "push", partial(commission, parameters, configuration), 0.0)]


def _refuse(parameters: CommissioningParameters, configuration: BenchConfiguration) -> None:
    refuse_angles("angle 0", [0.0], parameters.excursion_rad + MARGIN_RAD, configuration)
    refuse_currents(configuration)
    least_rad = 20.0 * resolution_rad(configuration.rig)
    refuse_short("excursion_rad", parameters.excursion_rad, least_rad, "20 encoder counts")


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
            settings, way_rad = _settings(longer, configuration), longer.excursion_rad
            forward = yield from push(joint, 1, way_rad, settings)
            pushes = [forward, (yield from push(joint, -1, way_rad, settings))]
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


def _settings(parameters: CommissioningParameters, configuration: BenchConfiguration) -> PushSettings:
    ceiling_a = configuration.search.ceiling_a
    return PushSettings(
        Mode.CURRENT, parameters.rate_a_s, ceiling_a, ceiling_a, "search.ceiling_a", parameters.coast_s,
        configuration.control.period_s, brakes=True,
    )  # fmt: skip


def _duration_s(parameters: CommissioningParameters, _configuration: BenchConfiguration) -> float:
    return 2.0 * (1.0 / parameters.rate_a_s + 1.0)


KIND = ExperimentKind(
    name=NAME,
    title="Commissioning move",
    summary="Pushes the joint a few degrees one way and the other, without load, and compares signs, velocity, current "
    "and encoder counts with the rig. A real drive has to pass it before anything else is run.",
    parameters=CommissioningParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=results_of_the_trial,
    results={
        "travel_rad": "of each push",
        "passed": "what is as the rig says",
        "not_checked": "what the drive does not measure",
        "sentences": "what was found, in words",
    },
    adapt=_adapt,
)
