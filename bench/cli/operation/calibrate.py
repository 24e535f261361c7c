"""`friction-bench calibrate ...`: friction curves of the joint: measured, fitted, kept, shown, chosen."""

import shlex
from enum import Enum
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.bench_session import BenchSession, session_of
from bench.cli.operation.run import Pace
from bench.cli.output import Json, print_json, say, table

if TYPE_CHECKING:
    from bench.calibration.curves import Curve, Estimate
    from bench.store import CalibrationRow

app = typer.Typer(no_args_is_help=True)
Calibration = Annotated[int, typer.Argument(metavar="CALIBRATION", min=1, help="Number of the calibration.")]
Note = Annotated[str, typer.Option(help="Kept with the calibration.")]
NoStribeck = Annotated[bool, typer.Option("--no-stribeck", help="Coulomb and viscous friction alone.")]
DUTIES = "0.1,0.2,0.3"


@app.callback()
def _calibrate() -> None:
    """Friction curves of the joint, one per load, and what they are used for."""


@app.command("run")
def run(
    context: typer.Context,
    loads_kg: Annotated[
        str, typer.Option(metavar="A,B,...", help="Loads [kg]; left out: none and the heaviest, and between if needed.")
    ] = "",
    accuracy_ma: Annotated[
        float,
        typer.Option(min=0.01, help="Half of the 95 % interval of a curve at which it is known well enough [mA]."),
    ] = 5.0,
    minutes: Annotated[float, typer.Option(min=0.5, help="Time of the joint for the curves.")] = 4.0,
    duties: Annotated[
        str, typer.Option(metavar="A,B,...", help="Constant duties, for the motor's constants.")
    ] = DUTIES,
    after: Annotated[
        list[int] | None, typer.Option(metavar="EXPERIMENT", help="Records of a calibration that was broken off.")
    ] = None,
    pace: Annotated[Pace | None, typer.Option(help="As for `friction-bench run`.")] = None,
    note: Note = "",
    as_json: Json = False,
) -> None:
    """Search F_load, measure the balanced arm where its curves are known least, fit, and keep. The joint moves.

    Says before what it takes. Ctrl-C pauses between two strokes' records: what was measured is kept, and the command
    to go on is printed.
    """
    from bench.cli.operation.calibration_run import CalibrationRun
    from bench.cli.operation.signals import stoppable_command
    from bench.runs.sequential_calibration import Wish

    session, loads = session_of(context), tuple(_numbers(loads_kg))
    wish = Wish(loads, 1e-3 * accuracy_ma, 60.0 * minutes, tuple(_numbers(duties)))
    with session.open_store() as store, stoppable_command("calibrate run", session.configuration().name):
        again = _given(context, {"after", "as_json"})
        ids = CalibrationRun(session, store, wish, after or [], pace, note, again, as_json).carry_out()
    _fit_and_show(session, ids, True, note, as_json)


@app.command("fit")
def fit(
    context: typer.Context,
    experiment: Annotated[list[int], typer.Option(help="Speed sweep, load sweep or import; repeatable.")],
    no_stribeck: NoStribeck = False,
    note: Note = "",
    as_json: Json = False,
) -> None:
    """Fit and keep a calibration from what was recorded before, or imported."""
    _fit_and_show(session_of(context), experiment, not no_stribeck, note, as_json)


@app.command("list")
def list_(context: typer.Context, as_json: Json = False) -> None:
    """List the calibrations, newest first; the one in use is marked."""
    from bench.calibration import in_use
    from bench.service.routes.calibration.calibrations import represent

    session = session_of(context)
    with session.open_store() as store:
        found, used = store.calibrations.find(), in_use(store, session.configuration())
    used_id = used.id if used else None
    if as_json:
        print_json([represent(one, used_id).model_dump(mode="json") for one in found])
        return
    rows = [
        (one.id, "in use" if one.id == used_id else "", one.rig.get("name"), one.source, len(one.result["curves"]),
         ", ".join(map(str, one.experiment_ids)), one.created_utc, one.note)
        for one in found
    ]  # fmt: skip
    table("Calibrations", ["id#", "", "rig", "source", "curves#", "experiments", "made", "note"], rows)


@app.command("show")
def show(context: typer.Context, calibration: Calibration, as_json: Json = False) -> None:
    """Curves with their intervals, motor constants, and where they come from."""
    with session_of(context).open_store() as store:
        _show(store.calibrations.get(calibration), as_json)


@app.command("use")
def use(
    context: typer.Context,
    calibration: Annotated[int | None, typer.Argument(metavar="CALIBRATION", min=1)] = None,
    latest: Annotated[bool, typer.Option("--latest", help="The newest that fits, from now on.")] = False,
) -> None:
    """Choose the calibration that the bench compensates with; without a choice it is the newest that fits."""
    from bench import calibration as calibrations

    if (calibration is None) != latest:
        raise typer.BadParameter("give a calibration's number, or --latest")
    session = session_of(context)
    with session.open_store() as store:
        calibrations.use(store, session.configuration(), calibration)
        used = calibrations.in_use(store, session.configuration())
    say("No calibration fits this bench." if used is None else f"In use: calibration {used.id}.")


def _given(context: typer.Context, without: set[str]) -> str:
    """The options that a command was given, but for some, as they are typed."""
    words = []
    for one in context.command.params:
        value = context.params.get(one.name or "")
        if one.name not in without and value not in (None, one.default):
            words += [one.opts[0], shlex.quote(str(value.value if isinstance(value, Enum) else value))]
    return "".join(f" {word}" for word in words)


def _fit_and_show(session: BenchSession, experiment_ids: list[int], stribeck: bool, note: str, as_json: bool) -> None:
    from bench.calibration import calibrate

    with session.open_store() as store:
        _show(store.calibrations.get(calibrate(store, experiment_ids, stribeck, note)), as_json)


def _show(row: "CalibrationRow", as_json: bool) -> None:
    if as_json:
        from bench.service.routes.calibration.calibrations import represent

        print_json(represent(row, None).model_dump(mode="json", exclude={"in_use"}))
        return
    from bench.calibration.curves import Curve, Estimate

    experiments = ", ".join(map(str, row.experiment_ids))
    say(f"calibration {row.id} of rig '{row.rig.get('name')}', from experiments {experiments} ({row.source})")
    table(
        "Friction of the balanced joint; 95 % intervals",
        ["load [g]#", "F_load [mA]#", "Coulomb [mA]#", "static [mA]#", "Stribeck [rad/s]#", "shape#",
         "viscous [mA s/rad]#", "scatter [mA]#", "points#"],
        [_curve_cells(Curve.model_validate(one)) for one in row.result["curves"]],
    )  # fmt: skip
    motor = {name: row.result["motor"].get(name) for name in ("resistance_ohm", "back_emf_v_s_rad")}
    constants = [(name, _interval(one and Estimate.model_validate(one), 1.0)) for name, one in motor.items()]
    table("Motor, as the sweep tells it", ["", "value"], constants)
    for sentence in dict.fromkeys(row.result["motor"]["unidentified"].values()):
        say(sentence)
    if doubt := row.result.get("rest_unidentified") or row.result.get("rest_one_sided"):
        say(doubt)


def _curve_cells(curve: "Curve") -> tuple[object, ...]:
    found = curve.parameters
    intervals = [
        _interval(found[name], scale)
        for name, scale in (
            ("coulomb_a", 1e3), ("static_a", 1e3), ("stribeck_speed_rad_s", 1.0), ("shape", 1.0),
            ("viscous_a_s_rad", 1e3),
        )
    ]  # fmt: skip
    return (
        1e3 * curve.load_kg, 1e3 * curve.f_load_a, *intervals, 1e3 * curve.scatter_a, curve.points,
    )  # fmt: skip


def _interval(one: "Estimate | None", scale: float) -> str:
    """Value, and its interval where there is one."""
    if one is None or one.value is None:
        return "not told"
    if one.low is None or one.high is None:
        return f"{scale * one.value:.4g} (no interval)"
    return f"{scale * one.value:.4g} ({scale * one.low:.4g} .. {scale * one.high:.4g})"


def _numbers(text: str) -> list[float]:
    try:
        return [float(part) for part in text.split(",") if part.strip()]
    except ValueError as error:
        raise typer.BadParameter(f"'{text}' is no list of numbers, such as 0,0.05,0.1") from error
