"""A sinusoid under one load, with the load estimated all along: accelerated motion and reversals."""

from functools import partial
from math import cos, pi, sin

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.control.cycle import Procedure
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan, a_current, trial_plan
from bench.experiments.parts.followed_motion import ERROR_RESULTS, FollowedJoint, errors, refuse_unknown_joint
from bench.experiments.parts.profile import SetPoint
from bench.experiments.parts.refusal import refuse_angles, refuse_load, refuse_servo, refuse_speed
from bench.json_types import Value, number, numbers

OVERSHOOT_RAD = 0.1  # of the servo, at most
REST_S = 6.0  # to settle, to search, and back, roughly


class SinusoidParameters(Parameters):
    """Parameters of a sinusoid."""

    load_kg: float = quantity(0.05, "kg", "Load at the tip of the arm", ge=0)
    frequency_hz: float = quantity(0.5, "Hz", "Frequency", gt=0, le=10)
    amplitude_rad: float = quantity(pi / 4, "rad", "Angle either way of straight down", gt=0)
    periods: int = quantity(4, "", "Periods that are measured; one more before them fades in", ge=1, le=1000)
    repeats: int = quantity(1, "", "Number of trials", ge=1, le=100)

    @property
    def peak_rad_s(self) -> float:
        """Highest speed of the set point."""
        return 2.0 * pi * self.frequency_hz * self.amplitude_rad


def follow_sinusoid(configuration: BenchConfiguration, parameters: SinusoidParameters) -> Procedure:
    """The procedure. Results: as `followed_motion.errors`, over the measured periods; search_failure."""
    joint = FollowedJoint(configuration)
    failure = yield from joint.begin()
    if failure:
        yield from joint.end()
        return {"estimates": 0, "search_failure": failure}
    period_s = configuration.control.period_s
    fade = round(1.0 / (parameters.frequency_hz * period_s))
    cycles = fade * (1 + parameters.periods)
    followed = yield from joint.follow(_point(parameters, cycle * period_s) for cycle in range(1, cycles + 1))
    yield from joint.end()
    return errors(followed[fade:], parameters.load_kg, configuration) | {"search_failure": ""}


def _point(parameters: SinusoidParameters, time_s: float) -> SetPoint:
    omega, reach_rad = 2.0 * pi * parameters.frequency_hz, parameters.amplitude_rad
    share = min(time_s * parameters.frequency_hz, 1.0)
    growth = parameters.frequency_hz if share < 1.0 else 0.0
    speed_rad_s = reach_rad * (share * omega * cos(omega * time_s) + growth * sin(omega * time_s))
    return SetPoint(reach_rad * share * sin(omega * time_s), speed_rad_s)


def _plan(parameters: SinusoidParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    return [
        trial_plan(
            configuration,
            f"sinusoid-{repeat:02d}",
            partial(follow_sinusoid, configuration, parameters),
            parameters.load_kg,
            frequency_hz=parameters.frequency_hz,
            amplitude_rad=parameters.amplitude_rad,
            repeat=repeat,
        )
        for repeat in range(1, parameters.repeats + 1)
    ]


def _refuse(parameters: SinusoidParameters, configuration: BenchConfiguration) -> None:
    refuse_load("load_kg", parameters.load_kg, configuration)
    reach_rad = parameters.amplitude_rad
    refuse_angles("amplitude_rad", [-reach_rad, reach_rad], OVERSHOOT_RAD, configuration)
    refuse_speed("2 pi frequency_hz amplitude_rad", parameters.peak_rad_s, configuration)
    refuse_servo(configuration)
    refuse_unknown_joint(configuration)


def _duration_s(parameters: SinusoidParameters, _configuration: BenchConfiguration) -> float:
    return parameters.repeats * (REST_S + (1 + parameters.periods) / parameters.frequency_hz)


def _summarise(_parameters: SinusoidParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    done = [trial.results for trial in trials if trial.results.get("estimates")]
    summary: dict[str, Value] = {"trials": len(done)}
    if done:
        for name in ("rms_error_kg", "uncompensated_rms_error_kg", "in_band"):
            summary[name] = sum(numbers(done, name)) / len(done)
        summary["rms_ratio"] = number(summary["rms_error_kg"]) / number(summary["uncompensated_rms_error_kg"])
    return summary


KIND = ExperimentKind(
    name="sinusoid",
    title="Sinusoid",
    summary="Swings the arm under one load and estimates the load all along, through acceleration and reversals, from "
    "the calibration in use. The estimate is compared with the weight that hangs there.",
    parameters=SinusoidParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results=ERROR_RESULTS,
    modes=a_current,
)
