"""What the `study` commands print of diagnoses, and of what is to be recorded next."""

import shlex
from collections.abc import Sequence
from typing import TYPE_CHECKING

from bench.cli.lab.study_tables import GAIN, HELD_OUT, tenths
from bench.cli.output import percent, say, table, text
from bench.json_types import as_option
from compensator.lab.chance import chance_cell

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.json_types import Json
    from bench.study.models.change import Searched
    from bench.study.models.diagnosis import Diagnosis, Finding, NotDiagnosed, Ranked
    from bench.study.models.study import Extended
    from bench.study.suggestion.suggested import Suggested


def diagnosis(found: "Diagnosis") -> None:
    """The verdict and the ranking."""
    say(found.sentence)
    if found.slight:
        say(found.advice)
    for finding in found.findings:
        if finding.code == "data-problem":
            say(f"data: {finding.text}")
    for members in found.classes:
        say(members.sentence)
        if members.separating_trial:
            say(f"  to tell them apart, record: {members.separating_trial}")
    _ranking(found.ranking, found.held_out_kind)
    if found.provisional:
        say(found.provisional.sentence)
    for finding in found.findings:
        if finding.code not in ("data-problem", "not-judged"):
            say(finding.text)
    for line in why_not_judged(found.findings):
        say(line)


def why_not_judged(findings: Sequence["Finding"]) -> list[str]:
    """A line for each reason why effects could not be judged on the trials."""
    effects: dict[str, list[str]] = {}
    for one in findings:
        if one.code == "not-judged":
            effect = str(one.values["effect"])
            effects.setdefault(str(one.values["reason"]).removeprefix(f"{effect} "), []).append(effect)
    some = {reason: f"{', '.join(names)}{': each' * (len(names) > 1)}" for reason, names in effects.items()}
    return [f"Not judged: {names} {reason}." for reason, names in some.items()]


def _ranking(ranking: Sequence["Ranked"], held_out_kind: str) -> None:
    """The effects and their numbers, and below what the errors are of, and what each effect lacks."""
    from bench.study.diagnosis.findings import numbers_explained  # imported when needed: `--help` starts at once
    from bench.study.models.diagnosis import ORDER

    rows = [
        (
            one.effect,
            one.score,
            percent(one.held_out_before),
            percent(one.held_out_after),
            f"{tenths(one.gain)}, {tenths(one.gain_low)} .. {tenths(one.gain_high)}",
            text(one.d_prime),
        )
        for one in ranking
    ]
    if rows:
        columns = ["effect", "score#", "before#", "after#", f"{GAIN}#", "d'#"]
        table(f"Effects by evidence: {ORDER}", columns, rows)
        say(" ".join(filter(None, (HELD_OUT[held_out_kind], numbers_explained(ranking)))))
        for line in why_not_named(ranking):
            say(line)


def why_not_named(ranking: Sequence["Ranked"]) -> list[str]:
    """A line for each effect that is not named though the rows speak for it, and one for all the others."""
    told = [f"not {one.effect}: {', '.join(one.why_not)}" for one in ranking if one.why_not and one.score > 0.0]
    others = [one.effect for one in ranking if one.why_not and not one.score > 0.0]
    return [*told, f"no evidence (score not above 0): {', '.join(others)}"] if others else told


def next_step(found: "Diagnosis", model_id: int | None) -> str:
    """What to do after a diagnosis or a search: add what is offered or helps, mend the data, keep, or record more.

    Args:
        found: the diagnosis, of a search that of its last model.
        model_id: the model that was asked for; None: the newest.
    """
    if one := found.offered or found.helps:
        beside = "" if model_id is None else f" --model {model_id}"
        add = f"next: friction-bench study add {found.study_id} {one}{beside}"
        if found.offered and any(members.separating_trial for members in found.classes):
            return f"{add}\nor tell it from its rivals first: {_more(found)}"
        if found.offered or found.joint == "nowhere":
            return add
        return (
            f"{add}\nIt may be luck: record more, and keep it if dropping it does harm then:\n{_more(found)}\n"
            f"friction-bench study drop {found.study_id} {one}"
        )
    if found.verdict == "data-problem":
        return "next: friction-bench study new NAME --experiment NUMBER --leave-out TRIAL"
    if found.slight or found.joint == "nowhere" or found.conclusion.code in ("nothing", "not-confirmed"):
        return f"next: friction-bench study report {found.study_id}"
    return f"next: {_more(found)}"


def _more(found: "Diagnosis") -> str:
    """The command that says which trials to record next: of this bench, or of any."""
    return f"friction-bench study {'suggest' if found.joint == 'here' else 'coverage'} {found.study_id}"


def search(found: "Searched") -> None:
    """The steps of a search, and what is left."""
    for step in found.steps:
        say(step.sentence)
    say(found.sentence)
    for one in found.findings:
        say(one.text)


def not_judged(last: "Diagnosis", model_id: int | None) -> str:
    """How many effects the trials could not judge, and the command that says why; empty where they judged all.

    Args:
        last: the diagnosis that a search ended with.
        model_id: the model that was asked for; None: the newest.
    """
    count = sum(finding.code == "not-judged" for finding in last.findings)
    beside = "" if model_id is None else f" --model {model_id}"
    what = f"{count} effect{'s' * (count != 1)} could not be judged on these trials"
    return f"{what}; why: friction-bench study diagnose {last.study_id}{beside}" if count else ""


def suggestion(found: "Suggested") -> None:
    """Trials to record next, and why."""
    say(found.diagnosis)
    say(found.sentence)
    rows = [
        (
            one.kind,
            _values(one.parameters),
            one.minutes,
            f"{one.before:.1f} -> {one.after:.1f}",
            one.sentence,
        )
        for one in found.trials
    ]
    if rows:
        table("Trials to record next", ["kind", "parameters", "minutes#", "predicted d'#", "why"], rows)
    for one in found.kept_out:
        say(f"kept out: {one.kind}, experiment {one.experiment_id}, {one.outcome}: {one.reason}")
    pairs = [(one.true, one.rival or "nothing", one.before, one.after, one.promised) for one in found.pairs]
    if pairs:
        columns = ["truth", "rival", "now#", "then#", "nine in ten#"]
        table("If the truth is one, predicted d' against the other", columns, pairs)


def commands(found: "Suggested") -> list[str]:
    """What records the trials that are suggested one by one, adds them and diagnoses; and what does all of it."""
    if not found.trials:
        return []
    note = shlex.quote(found.note)
    return [
        "one by one:",
        *(f"friction-bench run {one.kind} {_options(one.parameters)} --note {note}" for one in found.trials),
        f"friction-bench study extend {found.study_id}",
        f"friction-bench study diagnose {found.study_id}",
        "or all of it at once, the joint moves:",
        f"friction-bench study suggest {found.study_id} --trials {len(found.trials)} --start",
    ]


def _options(parameters: "Json") -> str:
    values = ((name.replace("_", "-"), shlex.quote(as_option(value))) for name, value in parameters.items())
    return " ".join(f"--{name} {value}" for name, value in values)


def not_settled(found: "Diagnosis", trials: int) -> str:
    """The last words after so many suggested trials, where they have not brought one name; else empty."""
    came = f"It is not settled: {trials} suggested trial{'s' * (trials != 1)} came, and"
    if found.conclusion.code == "likely":
        return f"{came} what is likely is not sure."
    if not found.classes or len(found.classes[0].effects) == 1:
        return ""
    names = " and ".join(found.classes[0].effects)
    return (
        f"{came} {names} are not told apart: take them as one class, or see what else would tell: friction-bench study "
        f"coverage {found.study_id}"
    )


def _values(parameters: "Json") -> str:
    return ", ".join(f"{name} {_value(value)}" for name, value in parameters.items())


def _value(value: object) -> str:
    return " ".join(map(_value, value)) or "none" if isinstance(value, list | tuple) else text(value)


def extended(found: "Extended") -> None:
    """What was added to a study."""
    say(found.sentence)
    if found.left_out:
        say(f"left out, too short for the study's filter or without its effort: {', '.join(found.left_out)}")
    table("Added", ["id#", "name"], [(one.trial_id, one.name) for one in found.added])


def diagnoses(found: "Sequence[Diagnosis | NotDiagnosed]") -> None:
    """One line for each study."""
    table("Diagnoses", ["study#", "verdict", "first", "held out before#", "after#", "p#", "sentence"], map(_row, found))


def _row(one: "Diagnosis | NotDiagnosed") -> tuple[object, ...]:
    from bench.study.models.diagnosis import NotDiagnosed

    if isinstance(one, NotDiagnosed):
        return one.study_id, "not judged", None, None, None, None, one.error
    first = one.ranking[0] if one.ranking else None
    errors = (None, None) if first is None else (percent(first.held_out_before), percent(first.held_out_after))
    return one.study_id, one.verdict, first and first.effect, *errors, chance_cell(one.p_value), one.sentence
