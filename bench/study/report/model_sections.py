"""Sections of a study's report: what was measured, the ladder, the newest model, what the models leave."""

from collections.abc import Sequence
from math import isfinite
from textwrap import wrap

from bench.report import Bars, Figure, Line, Points, Section, Table
from bench.report.wording import unit_text
from bench.store import Store
from bench.study.models.base import ROWS_IN_WORDS, STARTS
from bench.study.models.closed_loop import ClosedLoop, LoopError, TrialInLoop
from bench.study.models.comparison import AtRest, Comparison, FittedParameter, ResidualAgainst, TrialError
from bench.study.models.ladder import Ladder, Rung
from bench.study.models.study import Study
from bench.study.report.wording import condition_text
from compensator.lab.chance import chance_cell
from compensator.lab.model.gain import Gain
from compensator.lab.rows.drivers import DRIVERS

UNLIKE = "Errors count all rows alike; gains count each row by how well it is known."
NO_SHARE = 1e-7  # less is rounding
NO_GAIN = 5e-4  # less is shown as none
SMALL_SHARE = 5e-4  # two digits after the point would say next to nothing of it


def number(value: float | None) -> float | None:
    """NaN as None."""
    return None if value is None or not isfinite(value) else value


def percent(share: float | None) -> str:
    """A share as per cent; a small one by its first two digits."""
    if share is None or not isfinite(share):
        return "-"
    return f"{100 * share:.2g}%" if NO_SHARE < abs(share) < SMALL_SHARE else f"{share:.2%}"


def gain_cell(value: float, low: float, high: float) -> str:
    """A gain with its interval, as per cent; one that is next to nothing, in words."""
    if max(map(abs, (value, low, high))) < NO_GAIN:
        return "none"
    return f"{per_cent(value)} ({per_cent(low)} .. {per_cent(high)})"


def per_cent(share: float) -> str:
    """One digit after the point; what rounds to nothing has no sign."""
    return f"{round(100.0 * share, 1) + 0.0:.1f}%"


def cell(value: object) -> str:
    """A value of any kind, short."""
    if isinstance(value, list | tuple):
        return " ".join(map(cell, value)) or "none"
    return f"{value:g}" if isinstance(value, float) else str(value)


SHOWN_TRIALS = 2  # over time: the worst one that was fitted, and the worst one held out


def measured_section(study: Study, store: Store) -> Section:
    """Which trials, under which conditions, and what they are used for."""
    rows = []
    for one in study.trials:
        trial = store.trial(one.trial_id)
        held = ", ".join(condition_text(key, value) for key, value in sorted(one.conditions.items()))
        rows.append((trial.id, one.name, trial.kind, one.role.replace("_", " "), trial.rows, held))
    held_out = sum(one.role == "held_out" for one in study.trials)
    judged = f"of which {held_out} are held out" if held_out else "none of which is held out"
    return Section(
        "What was measured",
        [
            f"{len(rows)} trial{'s' * (len(rows) != 1)}, {judged}. Predicted is {study.effort.name} "
            f"[{study.effort.unit}]; effort and motion are filtered alike at {study.cutoff_hz:.3g} Hz; "
            f"rows that count: {study.rows}."
        ],
        [Table("Trials", ["id#", "name", "kind", "used as", "samples#", "conditions"], rows)],
    )


_HOW = {
    "hold-out": "trials held out",
    "leave-one-trial-out": "each trial left out in turn",
    "leave-one-block-out": "stretches left out in turn",
}
_NAME_WIDTH = 16  # characters of a line beneath a bar


def ladder_section(found: Ladder) -> Section:
    """The error from model to model."""
    rungs = found.rungs
    rows = [
        (
            rung.model_id,
            marked_change(rung, change_of(rung)),
            percent(rung.training),
            percent(rung.held_out),
            f"{percent(rung.held_out_low)} .. {percent(rung.held_out_high)}",
            gain_cell(rung.gain.gain, rung.gain.gain_low, rung.gain.gain_high) if rung.gain else "-",
            _HOW.get(rung.held_out_kind, rung.held_out_kind),
            percent(rung.breakaway.held_out) if rung.breakaway else "",
            rung.reflected_error_g,
        )
        for rung in rungs
    ]
    columns = [
        "model#",
        "change",
        "training#",
        "held out#",
        "90 % interval",
        "gain, 90 % interval",
        "how",
        "breakaway#",
        "reflected load [g]#",
    ]
    floor = found.floor
    return Section(
        "The ladder",
        [
            "Errors are shares of the effort's root mean square. "
            + (
                "No trial repeats another, so the floor is not known."
                if floor is None
                else f"Floor: repeated trials differ by {floor:.2%} among themselves, as far as the best model can "
                "tell. Only an effect with memory can go below."
            ),
            *uncounted_in_words(found),
        ],
        [Table("Models", columns, rows)],
    )


def ladder_figure(found: Ladder) -> Figure:
    """The error from model to model, down towards the floor."""
    rungs = found.rungs
    changes = [f"{rung.model_id}: {change_of(rung) if rung.parent_id else 'base'}" for rung in rungs]
    names = ["<br>".join(wrap(change, _NAME_WIDTH)) for change in changes]
    held = [100.0 * rung.held_out for rung in rungs]
    low, high = [100.0 * rung.held_out_low for rung in rungs], [100.0 * rung.held_out_high for rung in rungs]
    return Figure(
        "Error from model to model",
        "",
        "error [% of the effort]",
        [
            Bars("training", names, [100.0 * rung.training for rung in rungs]),
            Bars("held out, with its 90 % interval", names, held, low, high),
        ],
    )


def measured_figure(before: Comparison, now: Comparison) -> Figure:
    """What was measured, and what the first and the last model predict, in the trial that the first one is worst in."""
    worst = worst_trial(before)
    old, new = (next(s for s in one.series if s.trial_id == worst.trial_id) for one in (before, now))
    lines = [Line("measured", old.time_s, old.measured), Line("first model", old.time_s, old.predicted, dashed=True)]
    if now.model_id != before.model_id:
        lines.append(Line("last model", new.time_s, new.predicted))
    title = f"Measured and predicted in trial {worst.name}, the one in which the first model is worst"
    return Figure(title, "time [s]", f"{now.effort.name} [{now.effort.unit}]", lines)


def worst_trial(found: Comparison) -> TrialError:
    """Of all trials the one with the largest error."""
    return max(found.trials, key=lambda one: one.rms if isfinite(one.rms) else -1.0)


def change_of(rung: Rung) -> str:
    """What a rung changed, in words."""
    if rung.parent_id is None:
        return "base: " + ", ".join(rung.effects).replace("_", " ")
    signs = [f"+ {rung.added}" if rung.added else "", f"- {rung.removed}" if rung.removed else ""]
    return ", ".join(filter(None, signs)).replace("_", " ") or f"the same, {rung.trials} trials"


def marked_change(rung: Rung, change: str) -> str:
    """A change in a table of errors; one with a mark is explained by `uncounted_in_words`."""
    return f"{change} *" if rung.shows else change


def uncounted_in_words(found: Ladder) -> list[str]:
    """A sentence for each change that shows where the errors of the ladder do not count; and why gains are unlike."""
    gains = [one.gain for one in found.rungs if one.gain is not None]
    unlike = any(
        Gain(one.gain, one.gain_low, one.gain_high).is_unlike(one.held_out_before, one.held_out_after) for one in gains
    )
    return [*(_uncounted(rung) for rung in found.rungs if rung.shows), *([UNLIKE] if unlike else [])]


def _uncounted(rung: Rung) -> str:
    name = (rung.added or rung.removed or "").replace("_", " ")
    return f"* {name[:1].upper()}{name[1:]} shows {rung.shows}, which these errors do not count{judged_there(rung)}."


def judged_there(rung: Rung) -> str:
    """What a change did to the error where it shows, as the end of a sentence; empty where that was not kept."""
    if rung.gain is None or rung.gain.rows not in (ROWS_IN_WORDS["moving"], STARTS):
        return ""
    counting = "there the error went" if rung.gain.rows == STARTS else "counting them, too, the error went"
    return f": {counting} from {percent(rung.gain.held_out_before)} to {percent(rung.gain.held_out_after)}"


def model_section(found: Comparison) -> Section:
    """The newest model: parameters, errors per regime and trial, measured against predicted."""
    unit = found.effort.unit
    breakaway = found.breakaway
    regimes = [(one.name, one.rows, one.rms, percent(one.relative)) for one in found.regimes]
    trials = [(one.name, one.role.replace("_", " "), number(one.rms), percent(one.relative)) for one in found.trials]
    return Section(
        f"Model {found.model_id}",
        [
            f"Effects: {', '.join(found.effects).replace('_', ' ')}.",
            *found.notes,
            *([found.at_rest.sentence] if found.at_rest else []),
        ],
        [
            _parameters("Parameters", found.parameters),
            *([_parameters("Parameters of the breakaway effort", breakaway.parameters)] if breakaway else []),
            Table("Error by regime", ["regime", "rows#", f"rms [{unit}]#", "relative#"], regimes),
            *([_at_rest(found.at_rest, unit)] if found.at_rest else []),
            Table("Error by trial", ["trial", "used as", f"rms [{unit}]#", "relative#"], trials),
        ],
        [_over_time(found, trial) for trial in _worst(found)],
    )


def closed_loop_section(found: ClosedLoop) -> Section:
    """The newest model under the servo of the trials: error of the motion beside that of the effort."""
    unit = found.position_unit
    columns = [f"position, rms [{unit}]#", "of its spread#", "speed#", "effort#"]
    errors = [
        (name, *_in_loop(error))
        for error, name in ((found.training, "training"), (found.held_out, "held out"))
        if error
    ]
    trials = [(one.name, one.law, "" if one.settled else "no", *_in_loop(one)) for one in found.trials]
    return Section(
        "In closed loop",
        [
            f"Model {found.model_id}, moved under the servo that the trials ran under: how far its joint is from "
            "the measured one, and its servo's effort from the measured effort.",
            *found.notes,
        ],
        [
            Table("Errors", ["on", *columns], errors),
            Table("Error by trial", ["trial", "servo told by", "settled", *columns], trials),
        ],
        [_moved(one, unit) for one in sorted(found.trials, key=_farthest)[-1:]],
    )


def _in_loop(error: LoopError) -> tuple[object, ...]:
    shares = error.position_relative, error.velocity_relative, error.effort_relative
    return (number(error.position), *map(percent, shares))


def _farthest(trial: TrialInLoop) -> float:
    value = trial.position_relative
    return value if isfinite(value) else -1.0


def _moved(trial: TrialInLoop, unit: str) -> Figure:
    series = trial.series
    lines = [Line("measured", series.time_s, series.measured), Line("simulated", series.time_s, series.simulated)]
    return Figure(f"Trial {trial.name}, measured and simulated", "time [s]", f"position [{unit}]", lines)


def _parameters(title: str, found: Sequence[FittedParameter]) -> Table:
    rows = [(one.effect, one.name, number(one.value), _interval(one), unit_text(one.unit), one.note) for one in found]
    return Table(title, ["effect", "parameter", "value#", "95 % interval", "unit", "note"], rows)


def _at_rest(found: AtRest, unit: str) -> Table:
    rows = [
        (
            one.side,
            percent(one.outside),
            one.largest,
            chance_cell(one.p_value),
            one.trial,
            one.time_s,
        )
        for one in found.sides
    ]
    title = f"At rest, {found.stretches} stretches: beyond what friction holds"
    return Table(title, ["side", "outside#", f"largest [{unit}]#", "p#", "surest in", "at [s]#"], rows)


def _worst(found: Comparison) -> list[TrialError]:
    """Of each role, the trial with the largest error."""
    worst: dict[str, TrialError] = {}
    for one in found.trials:
        if isfinite(one.rms) and one.rms >= worst.get(one.role, one).rms:
            worst[one.role] = one
    return list(worst.values())[:SHOWN_TRIALS]


def _over_time(found: Comparison, trial: TrialError) -> Figure:
    series = next(one for one in found.series if one.trial_id == trial.trial_id)
    curves = {"measured": series.measured, "predicted": series.predicted, "residual": series.residual}
    drawn = [Line(name, series.time_s, values) for name, values in curves.items()]
    role = trial.role.replace("_", " ")
    title = f"Trial {trial.name} ({role}): the largest error of its role"
    return Figure(title, "time [s]", f"{found.effort.name} [{found.effort.unit}]", drawn)


def residual_section(before: Comparison, now: Comparison) -> Section:
    """Residual against every driving variable, of the first model and of the newest."""
    later = {one.driver: one for one in now.residual_against}
    same = before.model_id == now.model_id
    figures = []
    for one in before.residual_against:
        drawn = _bins(one, "" if same else f"model {before.model_id}, ")
        if not same and one.driver in later:
            drawn += _bins(later[one.driver], f"model {now.model_id}, ")
        name = DRIVERS[one.driver].title
        figures.append(
            Figure(f"Residual against {name}", f"{name} [{one.unit}]", f"residual [{now.effort.unit}]", drawn)
        )
    sentence = "Means of bins, with two standard errors from the scatter between stretches of 2 s."
    return Section("What the models leave", [sentence], figures=figures)


def _bins(against: ResidualAgainst, prefix: str) -> list[Points]:
    return [
        Points(f"{prefix}{group.direction}", group.x, group.mean, group.low, group.high) for group in against.groups
    ]


def _interval(one: FittedParameter) -> str:
    low, high = number(one.low), number(one.high)
    return "-" if low is None or high is None else f"{low:.4g} .. {high:.4g}"
