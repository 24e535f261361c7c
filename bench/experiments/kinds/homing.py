"""Homing: against an end stop, slowly, with little current, twice; or by the drive itself, watched from here.

It is no experiment that one chooses: `friction-bench doctor --home` runs it, on a bench whose limits are those of the
search (`search_bench`), and writes the zero that comes of it.
"""

from collections.abc import Generator
from functools import partial
from math import ceil, degrees

from bench.config.configuration import BenchConfiguration
from bench.config.drives.real import HomingSettings, RealDriveSettings
from bench.config.rig import resolution_rad
from bench.control.cycle import Action, Procedure, Reading
from bench.errors import ConfigurationError, ExperimentError, LimitError, quantity_message
from bench.experiments.kind import ExperimentKind, Parameters, TrialPlan, results_of_the_trial, trial_plan
from bench.experiments.parts.joint import Joint
from bench.experiments.parts.profile import SetPoint
from bench.experiments.parts.search import STILL_COUNTS
from drivers.contract import Command, Mode

NAME = "homing"
OFF_RAD = "off_rad"  # result: what drive.zero_rad grows by
MARGIN_RAD = 0.3  # beyond the travel, for what the joint overshoots
SEARCH_SHARE = 0.75  # of the current that the search takes; all of it tells a stop from a weight that is too heavy
PRESSING_SHARE = 0.9  # of that: the servo presses against something
PATIENCE_S = 5.0  # beyond twice the time of the travel
TOLD_S = 0.1  # a drive may count from home a moment before it says that it is there
ANYWHERE_RAD = 1e3  # the drive's count begins anew when it is at home: the way is watched instead
Search = Generator[Action, Reading, float]


class HomingParameters(Parameters):
    """It has none of its own: `[drive.homing]` says how."""


def settings_of(configuration: BenchConfiguration) -> HomingSettings:
    """How the joint is homed.

    Raises:
        ConfigurationError: the bench does not say.
    """
    homing = configuration.drive.homing if isinstance(configuration.drive, RealDriveSettings) else None
    if homing is None:
        raise ConfigurationError(
            f"bench '{configuration.name}' does not say how its joint is homed: add [drive.homing] with a method to "
            "bench.toml; it is for drives on a wire"
        )
    return homing


def search_bench(configuration: BenchConfiguration, here_rad: float) -> BenchConfiguration:
    """The bench with the limits of the search: the zero is not known yet, so positions count from here [rad].

    Raises:
        ConfigurationError: the bench does not say how.
        LimitError: the search asks for more current or speed than the bench allows.
    """
    homing, limits, servo = settings_of(configuration), configuration.limits, configuration.servo
    for name, value, limit, unit in (
        ("current_a", homing.current_a, min(limits.current_a, servo.current_a), "A"),
        ("speed_rad_s", homing.speed_rad_s, limits.speed_rad_s, "rad/s"),
    ):
        if value > limit:
            raise LimitError(quantity_message(f"drive.homing.{name}", value, f"at most {limit:g}", unit))
    reach_rad = ANYWHERE_RAD if homing.method == "drive" else homing.travel_rad + MARGIN_RAD
    return configuration.model_copy(update={
        "limits": limits.model_copy(update={
            "position_min_rad": here_rad - reach_rad, "position_max_rad": here_rad + reach_rad,
            "speed_rad_s": min(limits.speed_rad_s, 5.0 * homing.speed_rad_s + 0.5),
            "current_a": min(limits.current_a, 1.5 * homing.current_a),
            "tracking_error_rad": 2.0 * _lead_rad(homing, configuration) + MARGIN_RAD,
        }),
        "servo": servo.model_copy(update={"current_a": SEARCH_SHARE * homing.current_a}),
    })  # fmt: skip


def _lead_rad(homing: HomingSettings, configuration: BenchConfiguration) -> float:
    """How far the set point leads at most: there the servo gives all its current."""
    servo = configuration.servo
    return servo.dead_band_rad + 1.5 * homing.current_a / max(servo.proportional_a_rad, 1e-3)


def home_at_end_stop(configuration: BenchConfiguration) -> Procedure:
    """The procedure: to the stop, press, back, to the stop again, then to where the arm hangs straight down.

    Results:
        stops_rad: where the joint stood at the stop, by the zero so far.
        off_rad: what `drive.zero_rad` has to grow by.

    Raises:
        ExperimentError: no stop is found within the travel, or not twice at the same place.
    """
    homing = settings_of(configuration)
    joint = Joint(configuration)
    yield from joint.wake()
    stops_rad: list[float] = []
    for _ in range(2):
        stops_rad.append((yield from _to_the_stop(joint, homing, configuration)))
        yield from joint.move(stops_rad[-1] - homing.direction * homing.back_off_rad, homing.speed_rad_s)
    first_rad, second_rad = stops_rad
    if abs(first_rad - second_rad) > homing.repeat_rad:
        raise ExperimentError(
            f"the stop was found at {degrees(first_rad):.2f} and then at {degrees(second_rad):.2f} degrees; they may "
            f"differ by {degrees(homing.repeat_rad):.2f} (drive.homing.repeat_rad). Nothing was written. Does "
            "something else hold the joint, is the stop soft, does a coupling slip?"
        )
    off_rad = 0.5 * (first_rad + second_rad) - homing.angle_rad
    yield from joint.move(off_rad, homing.speed_rad_s)
    return {"stops_rad": [*stops_rad], OFF_RAD: off_rad}


def home_by_drive(configuration: BenchConfiguration) -> Procedure:
    """The procedure: the drive searches; how far it goes, and for how long, is watched. It ends there, without power.

    Results:
        way_rad: that the joint went from where it began.
        off_rad: what `drive.zero_rad` has to grow by.

    Raises:
        ExperimentError: home is not found within the travel, or in time.
    """
    homing, joint = settings_of(configuration), Joint(configuration)
    start_rad = (yield from joint.wake()).sample.position_rad
    slowest_rad_s = min(homing.speed_rad_s, homing.slow_speed_rad_s)
    period_s, beyond = configuration.control.period_s, 0
    way_rad, longest_s = 0.0, 2.0 * homing.travel_rad / slowest_rad_s + PATIENCE_S
    for _ in range(ceil(longest_s / period_s)):
        reading = yield from joint.push(Command(Mode.HOME, 1.0))
        if reading.sample.homed:
            # home is 0 by the drive's count
            return {"way_rad": way_rad, OFF_RAD: -_zero_rad(configuration) - homing.angle_rad}
        way_rad = reading.sample.position_rad - start_rad
        beyond = beyond + 1 if abs(way_rad) > homing.travel_rad else 0
        if beyond * period_s > TOLD_S:
            raise ExperimentError(
                f"the drive went {way_rad:.3g} rad and was not at home; {homing.travel_rad:g} rad are allowed "
                "(drive.homing.travel_rad). Nothing was written. Is drive.homing.drive_method the right one, and "
                "does it go the right way?"
            )
    raise ExperimentError(
        f"the drive was not at home within {longest_s:.0f} s; the joint went {way_rad:.3g} rad. Nothing was written. "
        "Look at its homing method and speeds, and at what keeps the joint from moving"
    )


def _zero_rad(configuration: BenchConfiguration) -> float:
    drive = configuration.drive
    return drive.zero_rad if isinstance(drive, RealDriveSettings) else 0.0


def _to_the_stop(joint: Joint, homing: HomingSettings, configuration: BenchConfiguration) -> Search:
    """Go on slowly until the joint stands while the servo gives all that it may; where that is [rad]."""
    period_s, direction = configuration.control.period_s, homing.direction
    lead_rad, still_rad = _lead_rad(homing, configuration), STILL_COUNTS * resolution_rad(configuration.rig)
    start_rad = target_rad = rest_rad = joint.reading.sample.position_rad
    stood = 0
    for _ in range(ceil((2.0 * homing.travel_rad / homing.speed_rad_s + PATIENCE_S) / period_s)):
        position_rad = joint.reading.sample.position_rad
        ahead_rad = direction * (target_rad - position_rad) + homing.speed_rad_s * period_s
        target_rad = position_rad + direction * min(ahead_rad, lead_rad)
        [reading] = yield from joint.follow([SetPoint(target_rad, direction * homing.speed_rad_s)])
        position_rad = reading.sample.position_rad
        if abs(position_rad - rest_rad) > still_rad:
            rest_rad, stood = position_rad, 0
        elif abs(joint.command_a) >= PRESSING_SHARE * SEARCH_SHARE * homing.current_a:
            stood += 1
        if stood * period_s >= homing.stand_s:
            yield from _press(joint, homing, configuration)
            return position_rad
        way_rad = direction * (position_rad - start_rad)
        if not -MARGIN_RAD < way_rad < homing.travel_rad:
            break
    raise ExperimentError(
        f"no end stop was found within {homing.travel_rad:g} rad (drive.homing.travel_rad) in direction {direction}; "
        f"the joint went from {start_rad:.3g} to {joint.reading.sample.position_rad:.3g} rad. Nothing was written. Is "
        "the direction right, and drive.homing.current_a enough to move the arm?"
    )


def _press(joint: Joint, homing: HomingSettings, configuration: BenchConfiguration) -> Generator[Action, Reading, None]:
    """Press with all the current: what was only held up by its weight or by friction goes on."""
    stood_rad = joint.reading.sample.position_rad
    for _ in range(ceil(homing.stand_s / configuration.control.period_s)):
        reading = yield from joint.push(Command(Mode.CURRENT, homing.direction * homing.current_a))
        gone_rad = homing.direction * (reading.sample.position_rad - stood_rad)
        if gone_rad > homing.repeat_rad:
            raise ExperimentError(
                f"what held the joint at {degrees(stood_rad):.2f} degrees is no stop: at {homing.current_a:g} A "
                f"(drive.homing.current_a) it went on by {degrees(gone_rad):.2f} degrees. Nothing was written. Take "
                "the load off, or allow more current"
            )


def _plan(_parameters: HomingParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    by_drive = settings_of(configuration).method == "drive"
    procedure = partial(home_by_drive if by_drive else home_at_end_stop, configuration)
    return [trial_plan(configuration, "search", procedure, load_kg=0.0)]


def _refuse(_parameters: HomingParameters, configuration: BenchConfiguration) -> None:
    homing = settings_of(configuration)
    if homing.method == "absolute":
        raise ConfigurationError(
            "drive.homing.method is 'absolute': the encoder keeps its count, and nothing is searched. Set the zero "
            "once: 'friction-bench doctor --set-zero'"
        )
    if configuration.servo.current_a > homing.current_a:
        raise ConfigurationError(
            "a search for the end stop has limits of its own (drive.homing): run 'friction-bench doctor --home'"
        )
    if configuration.servo.closed_by == "drive" and homing.method != "drive":
        raise ConfigurationError(
            "servo.closed_by is 'drive': this bench cannot keep the current against an end stop within "
            "drive.homing.current_a then. Have the drive do it (drive.homing.method = 'drive'), or set the zero by "
            "hand: 'friction-bench doctor --set-zero'"
        )


def _duration_s(_parameters: HomingParameters, configuration: BenchConfiguration) -> float:
    homing = settings_of(configuration)
    return 3.0 * homing.travel_rad / homing.speed_rad_s


KIND = ExperimentKind(
    name=NAME,
    title="Homing",
    summary="Finds the zero of the joint again, at an end stop or by the drive's own homing.",
    parameters=HomingParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=results_of_the_trial,
    results={
        "stops_rad": "where the end stop was found, each time",
        "way_rad": "how far the joint went, where the drive searched",
        OFF_RAD: "what `drive.zero_rad` has to grow by",
    },
)
