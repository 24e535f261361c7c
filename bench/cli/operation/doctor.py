"""`friction-bench doctor`: is this drive wired, scaled and watched as bench.toml says?"""

from dataclasses import asdict
from math import degrees, isnan, radians
from typing import TYPE_CHECKING, Annotated, Any

import typer

from bench.cli.bench_session import BenchSession, session_of
from bench.cli.exit_codes import ExitCode
from bench.cli.output import Json, print_json, say, table, text
from bench.config.quantities import unit_of

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.runs.connection import Connection
    from bench.runs.scope import Scope
    from bench.store import Experiment
    from drivers.contract import Description

_VERDICTS = {"proven": "proven", "configured, not proven": "NOT PROVEN", "none": "DOES NOT STOP IT"}
_NEXT = "Nothing was powered. 'friction-bench doctor --move' checks signs and scales with a small move."
QUANTITIES = ("position_rad", "velocity_rad_s", "duty", "current_a", "supply_v", "temperature_c")


def doctor(
    context: typer.Context,
    move: Annotated[bool, typer.Option("--move", help="Power the drive and push the joint a few degrees.")] = False,
    set_zero: Annotated[
        bool, typer.Option("--set-zero", help="The arm hangs straight down: write that to drive.zero_rad.")
    ] = False,
    at_deg: Annotated[
        float, typer.Option(help="With --set-zero: it stands at this angle [degrees], at an end stop for instance.")
    ] = 0.0,
    home: Annotated[
        bool,
        typer.Option("--home", help="Find the zero as [drive.homing] says, and write it: the joint moves slowly."),
    ] = False,
    operator: Annotated[str, typer.Option(help="Who stands at the bench; kept with the record.")] = "",
    as_json: Json = False,
) -> None:
    """Connect to the drive and say what it is, what it measures and how fast; with --move, whether it is right.

    A real drive has to pass `doctor --move` before experiments are run on it, and again after a change of its section
    of bench.toml or of gear, sensor or motor of the rig. A new zero is no such change.
    """
    from bench.cli.operation.signals import stoppable_command
    from bench.runs.connection import connect
    from bench.runs.scope import scope_of, setting_to_add

    session = session_of(context)
    found = connect(session.configuration())
    doubt = _count_doubt(session, found)
    if not as_json:
        _show(session, found)
    if doubt and not as_json and not set_zero and not home:
        say(session.in_full(doubt))
    if set_zero:
        _set_zero(session, found.sample.position_rad - radians(at_deg), as_json)
    scope = scope_of(session.configuration(), found.description)
    if not as_json:
        _show_scope(session, scope)
    answer: dict[str, object] = {
        "connection": _represent(found), "count_doubt": doubt, "scope": [one._asdict() for one in scope],
    }  # fmt: skip
    passed = True
    if home or move:
        with stoppable_command("doctor", session.configuration().name):
            passed = not home or _home(session, found, doubt, operator, answer, as_json)
            passed = passed and (not move or _move(session, operator, answer, as_json))
    elif not as_json:
        say(session.in_full(_NEXT))
    if as_json:
        print_json(answer)
    elif lacking := setting_to_add(session.configuration(), found.description):
        say(f"To be added to the bench's file: {lacking}.")
    _conclude(found.description, passed, set_zero)


def _conclude(drive: "Description", passed: bool, set_zero: bool) -> None:
    """End as what was found is to end.

    Raises:
        ConfigurationError: the drive can be asked for nothing; its zero can be set all the same.
        typer.Exit: something is not as wanted.
    """
    from bench.control.servo import without_mode
    from bench.errors import ConfigurationError

    if not drive.modes and not set_zero:
        raise ConfigurationError(without_mode(drive))
    if not passed:
        raise typer.Exit(ExitCode.NOT_COMPLETED)


def _count_doubt(session: BenchSession, found: "Connection") -> str:
    """See `bench.runs.count_check`."""
    from bench.runs.count_check import count_doubt

    with session.open_store() as store:
        return count_doubt(store, session.configuration(), found.description, lambda: found.sample.position_rad)


def _set_zero(session: BenchSession, off_rad: float, quiet: bool) -> None:
    """Shift the zero of bench.toml by what the angle that was measured is off [rad]."""
    from bench.config.drives.real import RealDriveSettings
    from bench.config.toml_text import set_number
    from bench.errors import ConfigurationError

    drive = session.configuration().drive
    if session.config is None or not isinstance(drive, RealDriveSettings):
        raise ConfigurationError("--set-zero needs a drive on a wire, and its bench.toml: give --config")
    zero_rad = round(drive.zero_rad + off_rad, 6)
    set_number(session.config, "drive", "zero_rad", zero_rad)
    if not quiet:
        say(f"drive.zero_rad was {drive.zero_rad:g}, and is {zero_rad:g} rad now, in {session.config}.")


def _home(
    session: BenchSession, found: "Connection", doubt: str, operator: str, answer: dict[str, object], quiet: bool
) -> bool:
    """Find the zero as the bench says, and write it where nothing is in doubt. Returns whether it stands.

    Raises:
        ConfigurationError: the bench does not say how.
        LimitError: the search asks for more than the bench allows.
    """
    from bench.cli.operation.run import carry_out
    from bench.experiments.kinds import homing

    bench = session.configuration()
    if homing.settings_of(bench).method == "absolute":
        if not quiet:
            kept = "The encoder keeps its count: nothing was moved, and the zero stays as it is."
            say(session.in_full(doubt) or kept)
        return not doubt
    narrow = homing.search_bench(bench, found.sample.position_rad)
    ended, _ = carry_out(session, homing.NAME, {}, operator, "friction-bench doctor --home", None, quiet, bench=narrow)
    answer["homing"] = {"outcome": ended.outcome, "reason": ended.reason, "results": ended.results}
    if not quiet:
        say(f"homing: {ended.outcome}{f': {ended.reason}' if ended.reason else ''}")
    if ended.outcome != "completed":
        return False
    _set_zero(session, float(ended.results[homing.OFF_RAD]), quiet)
    return True


def _move(session: BenchSession, operator: str, answer: dict[str, object], quiet: bool) -> bool:
    """The trial of the watchdog and the commissioning move. Returns whether both are as wanted."""
    from bench.cli.operation.run import carry_out
    from bench.control.commissioned import KIND

    ended, _ = carry_out(session, KIND, {}, operator, "friction-bench doctor --move", None, quiet)
    answer["commissioning"] = {"outcome": ended.outcome, "reason": ended.reason, "results": ended.results}
    if not quiet:
        _show_move(ended)
    return ended.outcome == "completed"


def _show(session: BenchSession, found: "Connection") -> None:
    description = found.description
    table("Drive", ["what", "value"], [
        ("device", description.device),
        ("identity", " ".join(filter(None, (description.vendor, description.product))) or "not told"),
        ("firmware, serial", f"{description.firmware or 'not told'}, {description.serial or 'not told'}"),
        ("simulated", "yes, by what it says of itself" if description.simulated else "no"),
        ("modes", ", ".join(sorted(mode.value for mode in description.modes)) or "none"),
        ("highest rate", f"{description.max_rate_hz:.0f} cycles/s"),
        ("rate now", f"{found.rate_hz:.1f} cycles/s at a period of {1e3 * found.period_s:g} ms"),
        ("one exchange", f"{1e3 * found.exchange_s:.2f} ms, the slowest {1e3 * found.slowest_s:.2f} ms"),
        ("lost cycles", found.lost_cycles),
        ("watchdog", _watchdog(description)),
    ])  # fmt: skip
    for found_table in description.tables:
        table(found_table.title, list(found_table.columns), list(found_table.rows))
    for note in description.notes:
        say(f"note: {note}")
    table("Measured now, with the power off", ["quantity", "unit", "value#", "smallest step#", "age in ms#"], [
        (name, unit_of(name), _value(found, name), description.resolution.get(name), _age_ms(found, name))
        for name in QUANTITIES
    ])  # fmt: skip
    if found.torque_off:
        say(found.torque_off)
    standing = (
        f"The joint stands at {degrees(found.sample.position_rad):.2f} degrees. Where the arm hangs straight down now, "
        "'friction-bench doctor --set-zero' makes that 0."
    )
    say(session.in_full(standing))


def _show_scope(session: BenchSession, scope: "tuple[Scope, ...]") -> None:
    rows = [(one.what, one.answer.value, session.in_full(one.why)) for one in scope]
    table("What can be compensated here, and what cannot", ["what", "", "why"], rows)


def _watchdog(description: "Description") -> str:
    if description.watchdog_s is None:
        return "NONE: the motor goes on with the last demand where this host falls silent"
    return f"is to stop it after {description.watchdog_s:g} s of silence; {description.watchdog}"


def _value(found: "Connection", name: str) -> object:
    value = getattr(found.sample, name)
    return "not measured" if isnan(value) else value


def _age_ms(found: "Connection", name: str) -> float | None:
    if isnan(getattr(found.sample, name)):
        return None
    short = name.split("_")[0]
    return 1e3 * float(getattr(found.sample.ages, f"{short}_s"))


def _show_move(ended: "Experiment") -> None:
    from bench.control.commissioned import WATCHDOG_RESULT, WATCHDOG_SEEN

    if WATCHDOG_RESULT in ended.results:
        say(f"watchdog: {_VERDICTS[ended.results[WATCHDOG_RESULT]]}: {ended.results[WATCHDOG_SEEN]}")
    for sentence in ended.results.get("sentences", []):
        say(sentence)
    say(f"commissioning move: {ended.outcome}{f': {ended.reason}' if ended.reason else ''}")
    if ended.outcome == "completed":
        first, second = (degrees(way_rad) for way_rad in ended.results["travel_rad"])
        say(
            f"By the drive's count the joint turned {text(first)} degrees, then {text(second)} degrees. If you saw the "
            "arm turn otherwise, correct gear.ratio or sensor.counts_per_turn before you go on: no drive can see that."
        )


def _represent(found: "Connection") -> dict[str, Any]:
    values = asdict(found)
    values["description"]["modes"] = sorted(mode.value for mode in found.description.modes)
    values["description"]["measured"] = sorted(found.description.measured)
    sample = found.sample._asdict()
    values["sample"] = sample | {"status": found.sample.status.name, "ages": found.sample.ages._asdict()}
    return values
