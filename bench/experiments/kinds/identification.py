"""Identification: pushes of growing length, from which signs, friction, inertia and the motor's constants are told."""

from functools import partial
from typing import Literal

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.config.rig import resolution_rad
from bench.control.cycle import Procedure
from bench.errors import ExperimentError, LimitError, quantity_message
from bench.experiments.analysis.commissioning_checks import Push
from bench.experiments.analysis.identification import Identified, identified
from bench.experiments.kind import ExperimentKind, Parameters, TrialPlan, results_of_the_trial, trial_plan
from bench.experiments.parts.joint import Joint
from bench.experiments.parts.push import PushSettings, push
from bench.experiments.parts.refusal import refuse_angles, refuse_coasting, refuse_currents
from bench.json_types import Value, known
from compensator.line_fit import Interval
from drivers.contract import Mode

COAST_SHARE = 1.0  # of a push, that the joint moves on at most until it is braked to rest
FARTHER = 1.5  # times the farthest push, where those before tell too little
SURE_SHARE = 0.25  # of the inertia, that half of its interval may be before a farther push is made
ONSET_COUNTS = 20.0  # after which the joint has let go
NAME = "identification"


class IdentificationParameters(Parameters):
    """Parameters of the identification."""

    effort: Literal["current", "duty"] = quantity(
        "current", "", "What is raised; a drive without a current mode needs 'duty' while its motor is not known"
    )
    excursions_rad: tuple[float, ...] = quantity(
        (0.08, 0.16, 0.3), "rad", "Way of the pushes, each one way and the other", min_length=1
    )
    rate_a_s: float = quantity(0.3, "A/s", "How fast a current rises", gt=0, le=100)
    full_duty_s: float = quantity(20.0, "s", "Time in which a duty would rise from 0 to 1", ge=1, le=200)
    boost: float = quantity(
        1.6, "", "What the demand is multiplied by as the joint lets go: inertia shows beside friction", ge=1, le=4
    )
    boost_duty: float = quantity(
        3.0, "", "The same of a duty, more of which goes into the back-EMF as the joint gets faster", ge=1, le=10
    )
    ceiling_a: float = quantity(1.5, "A", "Largest motor current", gt=0)
    ceiling_duty: float = quantity(0.5, "", "Largest duty", gt=0, le=1)
    coast_s: float = quantity(5.0, "s", "Longest wait for the joint to stand again", gt=0, le=30)


def _plan(parameters: IdentificationParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    return [trial_plan(configuration, "pushes", partial(push_and_identify, parameters, configuration), 0.0)]


def _refuse(parameters: IdentificationParameters, configuration: BenchConfiguration) -> None:
    farthest_rad = FARTHER * (1.0 + COAST_SHARE) * max(parameters.excursions_rad)
    refuse_angles("angle 0", [0.0], farthest_rad, configuration)
    refuse_currents(configuration)
    refuse_coasting(configuration)
    limit_a = configuration.limits.current_a
    if parameters.ceiling_a > limit_a:
        raise LimitError(quantity_message("ceiling_a", parameters.ceiling_a, f"at most {limit_a:g}", "A"))


def push_and_identify(parameters: IdentificationParameters, configuration: BenchConfiguration) -> Procedure:
    """The procedure: for each way push, brake, push the other way, brake; once more and farther where they do not tell.

    Results:
        demand_sign, current_sign: as of `Identified`.
        breakaway_a: current at which the joint lets go.
        velocity_lag_s: of the drive's velocity.
        travel_rad: way of each push.
        inertia_a_s2_rad, coulomb_a, viscous_a_s_rad, gravity_a, resistance_ohm, back_emf_v_s_rad, supply_ohm: each
            [value, low, high, note], 95 %. The back-EMF constant is per speed of the joint.

    Raises:
        ExperimentError: the joint does not move, or the pushes do not tell; with what may be wrong.
    """
    joint = Joint(configuration)
    yield from joint.wake()
    settings, by_duty = _settings(parameters, configuration), parameters.effort == "duty"
    count_rad = resolution_rad(configuration.rig)
    pushes: list[Push] = []
    for excursion_rad in parameters.excursions_rad:
        there = yield from push(joint, 1, excursion_rad, settings)
        pushes += [there, (yield from push(joint, -1, excursion_rad, settings))]
    if not _is_told(pushes, count_rad, by_duty):
        farther_rad = FARTHER * max(parameters.excursions_rad)
        there = yield from push(joint, 1, farther_rad, settings)
        pushes += [there, (yield from push(joint, -1, farther_rad, settings))]
    found = identified(pushes, count_rad, by_duty)
    return {**_results(found), "travel_rad": [one.travel_rad for one in pushes]}


def _is_told(pushes: list[Push], count_rad: float, by_duty: bool) -> bool:
    """Whether the pushes tell the inertia well enough already."""
    try:
        inertia = identified(pushes, count_rad, by_duty).joint.inertia_a_s2_rad
    except ExperimentError:
        return False
    return inertia.high - inertia.value < SURE_SHARE * inertia.value


def _settings(parameters: IdentificationParameters, configuration: BenchConfiguration) -> PushSettings:
    mode, rate_s, ceiling, boost = Mode.CURRENT, parameters.rate_a_s, parameters.ceiling_a, parameters.boost
    if parameters.effort == "duty":
        mode, rate_s, ceiling = Mode.DUTY, 1.0 / parameters.full_duty_s, parameters.ceiling_duty
        boost = parameters.boost_duty
    return PushSettings(
        mode, rate_s, ceiling, parameters.ceiling_a, "ceiling_a", parameters.coast_s, configuration.control.period_s,
        ONSET_COUNTS * resolution_rad(configuration.rig), boost, brakes=True,
    )  # fmt: skip


def _results(found: Identified) -> dict[str, Value]:
    intervals = {
        "inertia_a_s2_rad": found.joint.inertia_a_s2_rad,
        "coulomb_a": found.joint.coulomb_a,
        "viscous_a_s_rad": found.joint.viscous_a_s_rad,
        "gravity_a": found.joint.gravity_a,
        **found.electrics._asdict(),
    }
    return {
        "demand_sign": found.demand_sign,
        "current_sign": found.current_sign,
        "breakaway_a": found.breakaway_a,
        "velocity_lag_s": known(found.velocity_lag_s),
        **{name: _interval(interval) for name, interval in intervals.items()},
    }


def _interval(found: Interval) -> list[Value]:
    return [known(found.value), known(found.low), known(found.high), found.note]


def _duration_s(parameters: IdentificationParameters, _configuration: BenchConfiguration) -> float:
    return 6.0 * len(parameters.excursions_rad)


def _modes(parameters: IdentificationParameters) -> frozenset[Mode]:
    return frozenset({Mode.CURRENT if parameters.effort == "current" else Mode.DUTY})


KIND = ExperimentKind(
    name=NAME,
    title="Identification",
    summary="Pushes the unloaded joint both ways, farther each time, and tells from it the sign of the demand, "
    "breakaway, friction, inertia, and the motor's resistance and back-EMF constant where the drive measures enough.",
    parameters=IdentificationParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=results_of_the_trial,
    results={
        "demand_sign": "1 where a positive demand turns the joint forward, else -1",
        "current_sign": "1 where the measured current has the sign of the demand, else -1",
        "breakaway_a": "current at which the joint first moved",
        "velocity_lag_s": "by which the measured velocity is late",
        "inertia_a_s2_rad": "inertia, as a current",
        "coulomb_a": "dry friction, as a current",
        "viscous_a_s_rad": "viscous friction, as a current",
        "gravity_a": "the arm's own weight when level, as a current",
        "resistance_ohm": "of the motor",
        "back_emf_v_s_rad": "of the motor",
        "supply_ohm": "of the supply: by how much it sags",
        "travel_rad": "of each push",
    },
    modes=_modes,
)
