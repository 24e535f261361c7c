"""Steady speed of a balanced arm against constant current, duty or speed, load after load (Figs 2, 3 of the paper)."""

from collections.abc import Iterator
from functools import partial
from typing import Annotated, NamedTuple

from pydantic import Field, model_validator

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.control.cycle import Procedure
from bench.errors import LimitError, quantity_message
from bench.experiments.analysis.saturation import Ending, next_run_up, remaining_rad_s
from bench.experiments.analysis.steady_speed import steady_speed_results
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan, trial_plan
from bench.experiments.kinds.load_sweep import PAPER_LOADS_KG, Load
from bench.experiments.parts.refusal import refuse_duty, refuse_load, refuse_servo, refuse_speed
from bench.experiments.parts.stroke import MARGIN_RAD, OVERSPEED, Held, Strokes, StrokeSettings, Window, refuse_travel
from bench.json_types import Value, numbers
from drivers.contract import Mode

Level = Annotated[float, Field(gt=0)]
Share = Annotated[float, Field(gt=0, le=1)]
DIRECTIONS = {"forward": 1.0, "backward": -1.0}
STROKE_S = 3.5  # one stroke and the way back, roughly
STROKES = 3.5  # that a held current or duty takes, roughly


class SpeedSweepParameters(Parameters):
    """Parameters of a speed sweep.

    Below the speed at which friction is least, a constant current has no steady speed: the more slowly the joint turns,
    the more friction slows it down. The speeds are held by the servo, and their mean current is measured; they fill in
    what the currents cannot reach.
    """

    loads_kg: tuple[Load, ...] = quantity(PAPER_LOADS_KG, "kg", "Loads, in the order they are hung", min_length=1)
    currents_a: tuple[Level, ...] = quantity(
        tuple(round(0.05 * step, 2) for step in range(1, 11)), "A", "Constant currents, each in both directions"
    )
    duties: tuple[Share, ...] = quantity((), "", "Constant duties, 0 .. 1, each in both directions")
    speeds_rad_s: tuple[Level, ...] = quantity(
        (0.03, 0.06, 0.1, 0.2, 0.3, 0.5, 1.0), "rad/s", "Constant speeds held by the servo, each in both directions"
    )
    top_speed_rad_s: float = quantity(6.3, "rad/s", "Fastest run-up of the joint", gt=0)
    acceleration_rad_s2: float = quantity(18.5, "rad/s2", "Of run-up and braking", gt=0)
    tolerance: float = quantity(0.02, "", "Share of its speed that a saturated joint may still gain", gt=0, le=0.2)
    strokes: int = quantity(8, "", "Strokes after which a level is given up", ge=2, le=100)
    hold_s: float = quantity(3.0, "s", "Longest time that a level is held in one stroke", gt=0, le=600)
    window_s: float = quantity(0.15, "s", "Shortest window that is measured", ge=0.05, le=10)

    @model_validator(mode="after")
    def _check_levels(self) -> "SpeedSweepParameters":
        if not (self.currents_a or self.duties or self.speeds_rad_s):
            raise ValueError("at least one of currents_a, duties, speeds_rad_s must not be empty")
        if self.hold_s < 2.0 * self.window_s:
            raise ValueError(f"hold_s must be at least twice window_s, {2.0 * self.window_s:g} s")
        return self

    def levels(self) -> Iterator["Step"]:
        """Everything that is held, in order."""
        by_kind = {Held.SPEED: self.speeds_rad_s, Held.CURRENT: self.currents_a, Held.DUTY: self.duties}
        for held, levels in by_kind.items():
            for number, level in enumerate(levels, 1):
                yield Step(held, number, level)


class Step(NamedTuple):
    """One level that is held."""

    held: Held
    number: int
    level: float

    @property
    def condition(self) -> dict[str, float]:
        """What is held constant, with its unit in the name."""
        name = {Held.CURRENT: "held_current_a", Held.DUTY: "held_duty", Held.SPEED: "held_speed_rad_s"}[self.held]
        return {name: self.level}


def measure_steady_speed(
    configuration: BenchConfiguration, parameters: SpeedSweepParameters, step: Step, direction: str
) -> Procedure:
    """The procedure: strokes until the speed is saturated, then back to angle 0.

    Results: `steady_speed.steady_speed_results`.
    """
    sign = DIRECTIONS[direction]
    strokes = Strokes(configuration, stroke_settings(parameters, configuration), step.held, step.level, sign)
    yield from strokes.begin()
    windows: list[Window] = []
    run_up = step.level if step.held is Held.SPEED else parameters.top_speed_rad_s / 2.0
    while True:
        windows.append((yield from strokes.run(run_up)))
        verdict = _verdict(step, windows, parameters)
        if isinstance(verdict, Ending):
            break
        run_up = verdict
    yield from strokes.end()
    ratio = configuration.rig.gear.ratio or 1.0  # a joint without one is refused before
    remaining_rad_s = _remaining(step, windows)
    return steady_speed_results(windows, verdict, remaining_rad_s, step.held, ratio, parameters.window_s)


def stroke_settings(parameters: SpeedSweepParameters, configuration: BenchConfiguration) -> StrokeSettings:
    """The travel that the limits leave, and what the parameters ask for."""
    limits = configuration.limits
    return StrokeSettings(
        low_rad=limits.position_min_rad + MARGIN_RAD,
        high_rad=limits.position_max_rad - MARGIN_RAD,
        top_speed_rad_s=parameters.top_speed_rad_s,
        acceleration_rad_s2=parameters.acceleration_rad_s2,
        hold_s=parameters.hold_s,
        window_s=parameters.window_s,
    )


def _verdict(step: Step, windows: list[Window], parameters: SpeedSweepParameters) -> Ending | float:
    shown = [window.stroke for window in windows]
    if step.held is Held.SPEED:
        if shown[-1].stalled:
            return Ending.STALLED
        # what accelerates the arm is taken for friction, which is no less at low speed: not a share of the speed held
        steady = abs(_remaining(step, windows)) <= parameters.tolerance * parameters.top_speed_rad_s
        return Ending.SATURATED if steady else Ending.NOT_SATURATED
    verdict = next_run_up(shown, parameters.tolerance, parameters.top_speed_rad_s)
    out_of_strokes = not isinstance(verdict, Ending) and len(shown) >= parameters.strokes
    return Ending.NOT_SATURATED if out_of_strokes else verdict


def _remaining(step: Step, windows: list[Window]) -> float:
    """Speed still to come; where the servo holds the speed, what it would change within a second."""
    if step.held is Held.SPEED:
        return windows[-1].stroke.acceleration_rad_s2
    return remaining_rad_s([window.stroke for window in windows])


def _plan(parameters: SpeedSweepParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    return [
        trial_plan(
            configuration,
            f"load-{number:02d}-{step.held.value}-{step.number:02d}-{direction}",
            partial(measure_steady_speed, configuration, parameters, step, direction),
            load_kg,
            True,
            direction=direction,
            **step.condition,
        )
        for number, load_kg in enumerate(parameters.loads_kg, 1)
        for step in parameters.levels()
        for direction in DIRECTIONS
    ]


def _refuse(parameters: SpeedSweepParameters, configuration: BenchConfiguration) -> None:
    for load_kg in parameters.loads_kg:
        refuse_load("a load of loads_kg", load_kg, configuration)
    settings = stroke_settings(parameters, configuration)
    for name, speed_rad_s in (
        ("top_speed_rad_s", parameters.top_speed_rad_s),
        *(("a speed of speeds_rad_s", speed_rad_s) for speed_rad_s in parameters.speeds_rad_s),
    ):
        refuse_speed(f"{name} and a tenth", OVERSPEED * speed_rad_s, configuration)
        refuse_travel(name, speed_rad_s, settings)
    refuse_servo(configuration)
    _refuse_levels(parameters, configuration)


def _refuse_levels(parameters: SpeedSweepParameters, configuration: BenchConfiguration) -> None:
    limit_a = configuration.limits.current_a
    for current_a in parameters.currents_a:
        if current_a > limit_a:
            raise LimitError(
                quantity_message("a current of currents_a", current_a, f"at most limits.current_a, {limit_a:g}", "A")
            )
    for duty in parameters.duties:
        refuse_duty("a duty of duties", duty, configuration)


def _duration_s(parameters: SpeedSweepParameters, _configuration: BenchConfiguration) -> float:
    free = len(parameters.currents_a) + len(parameters.duties)
    strokes = free * STROKES + len(parameters.speeds_rad_s)
    return len(parameters.loads_kg) * len(DIRECTIONS) * strokes * STROKE_S


def _summarise(_parameters: SpeedSweepParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    rows = [{**trial.conditions, **trial.results} for trial in trials if "speed_rad_s" in trial.results]
    return {"rows": rows, "steps": len(rows), "saturated": sum(numbers(rows, "saturated"))}


def _modes(parameters: SpeedSweepParameters) -> frozenset[Mode]:
    asked = {Mode.DUTY: parameters.duties, Mode.CURRENT: parameters.currents_a}
    return frozenset(mode for mode, levels in asked.items() if levels)


KIND = ExperimentKind(
    name="speed-sweep",
    title="Speed sweep",
    summary="Holds currents, duties or speeds on the balanced arm under one load after the other, in both directions, "
    "until the speed is steady. The motor then turns against friction alone: one friction curve for each load.",
    parameters=SpeedSweepParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results={
        "speed_rad_s": "steady speed of the joint",
        "motor_speed_rad_s": "the same of the motor",
        "remaining_speed_rad_s": "by how much the speed was still to change; null where that is not known",
        "current_a": "measured, or by the paper's eq. (3)",
        "measured_current_a": "null where the drive measures none",
        "duty": "mean over the window",
        "supply_v": "null where the drive measures none",
        "window_s": "of the stretch that the means are taken from",
        "strokes": "strokes that it took",
        "saturated": "whether the duty was at its limit",
        "ending": "why the trial ended",
        "windows": "the same of each stroke",
    },
    modes=_modes,
)
