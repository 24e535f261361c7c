"""What the `study` commands print of models: one function per answer of `bench.study`."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from bench.cli.output import conditions, percent, say, share_interval, table
from compensator.lab.chance import chance_cell

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.study.models.change import Changed
    from bench.study.models.closed_loop import ClosedLoop, LoopError
    from bench.study.models.comparison import AtRest, BreakawayError, Comparison, FittedParameter
    from bench.study.models.coverage import Coverage
    from bench.study.models.ladder import Ladder, Rung
    from bench.study.models.study import Study
    from bench.study.models.units import UnitComparison, UnitParameter
    from bench.study.refit import Refitted

HELD_OUT = {
    "hold-out": "Held out: on trials that no model of the study is fitted to.",
    "leave-one-trial-out": "Held out: each trial in turn is predicted by a fit to all the others.",
    "leave-one-block-out": "Held out: each stretch in turn is predicted by a fit to all the others.",
}
"""What a held-out error is of, by how trials are held out."""


def study(found: "Study") -> None:
    """A study and its trials."""
    say(f"study {found.study_id}: {found.name}, effort: {found.effort.name} [{found.effort.unit}]")
    rows = [(one.trial_id, one.name, one.role, conditions(one.conditions)) for one in found.trials]
    table("Trials", ["id#", "name", "role", "conditions"], rows)
    if found.left_out:
        say(f"too short for the low-pass of {found.cutoff_hz:.3g} Hz, and left out: {', '.join(found.left_out)}")


def comparison(found: "Comparison") -> None:
    """Errors, parameters, trials and regimes of a model."""
    unit = found.effort.unit
    say(f"model {found.model_id}: {', '.join(found.effects)}")
    held_out = found.error.held_out
    errors = [("training", found.error.training), (held_out.kind or "held out", held_out)]
    errors += [("floor", found.error.floor)] if found.error.floor else []
    table(
        "Error",
        ["on", f"rms [{unit}]#", "relative#"],
        [(name, one.rms, percent(one.relative)) for name, one in errors],
    )
    _parameters("Parameters", found.parameters)
    _breakaway(found.breakaway)
    columns = ["name", "", f"rms [{unit}]#", "relative#"]
    table("Trials", columns, [(one.name, one.role, one.rms, percent(one.relative)) for one in found.trials])
    regimes = [(one.name, f"{one.rows} rows", one.rms, percent(one.relative)) for one in found.regimes]
    table("Regimes", columns, regimes)
    if found.at_rest:
        _at_rest(found.at_rest, unit)
    for note in found.notes:
        say(note)


def coverage(found: "Coverage") -> None:
    """What the trials can and cannot tell."""
    rows = [(one.quantity, one.found, one.lacking or "-") for one in found.held]
    table("What there is", ["of", "found", "what that leaves open"], rows)
    effects = [
        (one.effect, one.standing, one.reason or "-", ", ".join(one.rivals) or "-", percent(one.smallest))
        for one in found.effects
    ]
    columns = ["effect", "these trials", "why", "looks like", "shows from, of the effort#"]
    table("Effects beside the model", columns, effects)
    trials = [(one.trial, len(one.effects) or "all", ", ".join(one.effects)) for one in found.advice]
    if trials:
        table("What would help", ["trial", "opens#", "effects"], trials)
    say(found.sentence)
    for one in found.findings:
        say(one.text)


def _parameters(title: str, found: Sequence["FittedParameter"]) -> None:
    rows = [(one.effect, one.name, one.value, one.low, one.high, one.unit, one.note) for one in found]
    table(title, ["effect", "name", "value#", "low#", "high#", "unit", "note"], rows)


def _breakaway(found: "BreakawayError | None") -> None:
    if found is None:
        return
    errors = f"{percent(found.training.relative)}, held out {percent(found.held_out.relative)}"
    _parameters(f"Breakaway, {found.starts} starts from rest: error {errors}", found.parameters)


def _at_rest(found: "AtRest", unit: str) -> None:
    rows = [
        (one.side, percent(one.outside), one.largest, chance_cell(one.p_value), one.trial, one.time_s)
        for one in found.sides
    ]
    columns = ["side", "outside#", f"largest [{unit}]#", "p#", "surest in", "at [s]#"]
    if found.outside:
        rests = f"{found.rests} rest{'s' if found.rests != 1 else ''}"
        table(f"At rest, {found.stretches} stretches of {rests}: beyond what friction holds", columns, rows)
    say(found.sentence)


def simulation(found: "ClosedLoop") -> None:
    """Errors of a model in closed loop, by trial; coefficients before and after a refinement."""
    say(f"model {found.model_id}: {', '.join(found.effects)}")
    refined = found.refined
    rows = [("training", found.training), ("held out", found.held_out)]
    if refined:
        rows += [("training, refined", refined.training), ("held out, refined", refined.held_out)]
    columns = [f"position [{found.position_unit}]#", "of its spread#", "speed#", "effort#"]
    table("In closed loop, rms error", ["on", *columns], [(name, *_in_loop(one)) for name, one in rows if one])
    trials = [
        (one.name, one.role.replace("_", " "), one.law, "" if one.settled else "no", *_in_loop(one))
        for one in found.trials
    ]
    table("Trials", ["name", "used as", "servo told by", "settled", *columns], trials)
    if refined:
        values = [(one.effect, one.name, one.before, one.after, one.unit) for one in refined.parameters]
        table("Coefficients", ["effect", "name", "by least squares#", "refined#", "unit"], values)
        say(refined.sentence)
        before, after = percent(refined.inverse_before), percent(refined.inverse_after)
        say(f"Along the measured motion the error of the effort is {before} before and {after} after.")
    for note in found.notes:
        say(note)


def _in_loop(error: "LoopError") -> tuple[object, ...]:
    shares = error.position_relative, error.velocity_relative, error.effort_relative
    return (error.position, *map(percent, shares))


def refitted(found: "Refitted") -> None:
    """A model's parameters on the study's trials, and on all that were read."""
    say(
        f"model {found.model_id} on {found.trials} trials, {found.samples} samples, {found.rows} rows: "
        f"error {percent(found.training)}, each trial left out in turn {percent(found.held_out)}"
    )
    rows = [(one.effect, one.name, one.study, one.all, one.unit) for one in found.parameters]
    table("Parameters", ["effect", "name", "study#", "all#", "unit"], rows)
    for reason in found.skipped:
        say(f"left out: {reason}")


def units(found: "UnitComparison") -> None:
    """What units have in common, and each unit that stands out or has the largest deviation; of two, what differs."""
    if found.differences:
        _two_units(found)
    else:
        _many_units(found)
    errors = [(one.study_id, one.name, one.trials, percent(one.error)) for one in found.units]
    table("Units", ["study#", "name", "trials#", "error#"], errors)
    if found.undetermined:
        fewest = "two" if found.differences else "three"
        say(f"determined by the trials of fewer than {fewest} units: {'; '.join(found.undetermined)}")
    for sentence in (*found.notes, found.sentence):
        say(sentence)


def _two_units(found: "UnitComparison") -> None:
    first, second = (one.name for one in found.units)
    rows = [
        (
            one.name,
            one.first,
            one.second,
            one.difference,
            _interval(one.low, one.high),
            one.unit,
            "differs" if one.low > 0.0 or one.high < 0.0 else "",
        )
        for one in found.differences
    ]
    columns = ["parameter", f"{first}#", f"{second}#", "difference#", "90 %#", "unit", ""]
    table(f"{second} beside {first}", columns, rows)


def _many_units(found: "UnitComparison") -> None:
    rows = [
        (
            one.name,
            one.mean,
            _interval(one.mean_low, one.mean_high),
            one.scatter,
            _interval(one.scatter_low, one.scatter_high),
            _interval(one.next_low, one.next_high),
            one.unit,
            "yes" if one.differs else "not shown",
            chance_cell(one.p_value),
        )
        for one in found.parameters
    ]
    table(
        f"What {len(found.units)} units have in common",
        ["parameter", "mean#", "95 %#", "scatter#", "95 %#", "one more unit#", "unit", "units differ", "p#"],
        rows,
    )
    shown = [row for one in found.parameters for row in _unit_rows(one)]
    table("Unit by unit", ["parameter", "unit", "value#", "beside the others#", "95 %#", "expected#", "p#", ""], shown)


def _unit_rows(found: "UnitParameter") -> list[tuple[object, ...]]:
    return [
        (
            found.name,
            one.name,
            one.value,
            one.deviation,
            _interval(one.deviation_low, one.deviation_high),
            _interval(one.expected_low, one.expected_high),
            chance_cell(one.p_value),
            "outlier" if one.outlier else "",
        )
        for one in found.values
    ]


def _interval(low: float, high: float) -> str:
    return f"{low:.3g} .. {high:.3g}"


def change(found: "Changed") -> None:
    """What adding or dropping an effect did."""
    say(found.sentence)
    rows = [
        (f"training, {found.ladder_rows}", percent(found.before.training), percent(found.after.training)),
        (f"held out, {found.rows}", percent(found.before.held_out), percent(found.after.held_out)),
    ]
    if found.rows != found.ladder_rows:
        held_out = percent(found.ladder_before), percent(found.ladder_after)
        rows.append((f"held out, {found.ladder_rows}, as in the ladder", *held_out))
    table(f"Model {found.model_id}", ["error on", "before#", "after#"], rows)
    if found.parameters:
        _parameters("Its parameters, 95 % intervals", found.parameters)
    if found.breakaway and found.breakaway.parameters:
        _parameters("Its parameters in breakaway, 95 % intervals", found.breakaway.parameters)


GAIN = "gain, low .. high [%]"


def gain_text(rung: "Rung") -> str:
    """The gain of a rung's change, with its 90 % interval."""
    one = rung.gain
    return "" if one is None else f"{tenths(one.gain)}, {tenths(one.gain_low)} .. {tenths(one.gain_high)}"


def tenths(share: float) -> str:
    """A share as per cent, to a tenth; nothing has no sign."""
    return f"{round(100.0 * share, 1) + 0.0:.1f}"


def ladder(found: "Ladder") -> None:
    """The rungs."""
    from bench.study.report.model_sections import (  # imported when needed: `--help` starts at once
        marked_change,
        uncounted_in_words,
    )

    rows = [
        (
            one.model_id,
            marked_change(one, _change(one)),
            percent(one.training),
            share_interval(one.held_out, one.held_out_low, one.held_out_high),
            gain_text(one),
            percent(one.breakaway.held_out) if one.breakaway else "",
            f"{one.motion.position:.3g} {one.motion.unit}" if one.motion else "",
            one.reflected_error_g,
        )
        for one in found.rungs
    ]
    errors = ["training error#", "held-out error#", f"{GAIN}#", "breakaway#", "position in closed loop#"]
    columns = ["model#", "change", *errors, "reflected load, error [g]#"]
    table(f"Ladder of study {found.study_id}: errors in the effort, {found.rows}", columns, rows)
    for sentence in uncounted_in_words(found):
        say(sentence)
    if kind := found.rungs[-1].held_out_kind:
        say(HELD_OUT[kind])
    if found.floor is not None:
        say(f"floor, from repeated trials, as far as the best model can tell: {percent(found.floor)}")


def _change(rung: "Rung") -> str:
    signs = [f"+ {rung.added}"] * bool(rung.added) + [f"- {rung.removed}"] * bool(rung.removed)
    if not signs and rung.parent_id is not None:
        return f"the same, {rung.trials} trials"
    return ", ".join(signs) or f"base: {', '.join(rung.effects)}"
