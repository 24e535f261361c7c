"""The head of a study's report: when, who, on what, with which software; and what came out in three sentences."""

from collections.abc import Iterable, Sequence
from datetime import UTC, datetime

from bench.provenance import software
from bench.report import Figure, Section, Table
from bench.store import Store
from bench.store.records import Experiment
from bench.study.models.ladder import Ladder
from bench.study.models.study import Study
from bench.study.report.model_sections import percent

NOT_TOLD = "not told"
_JUDGED_BY = {
    "leave-one-trial-out": "each of which was left out in turn to judge the model",
    "leave-one-block-out": "too few to leave one out; stretches of 2 s were left out instead",
}


def head_section(
    study: Study, rungs: Ladder, diagnosis: str, store: Store, pictures: Sequence[Figure], confused: Sequence[str] = ()
) -> Section:
    """What whoever files the report looks for first.

    Args:
        study: which one.
        rungs: its models.
        diagnosis: of the newest model, in a sentence.
        store: with its experiments.
        pictures: what came out, in one look.
        confused: which of its effects could as well be others, in sentences.
    """
    numbers = dict.fromkeys(store.trial(one.trial_id).experiment_id for one in study.trials)
    experiments = [store.experiment(number) for number in numbers]
    now = software()
    drives = [one.provenance.get("drive") or {} for one in experiments]
    facts = [
        ("date", datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")),
        ("recorded", _days(experiments)),
        ("operator", _joined(one.operator for one in experiments)),
        ("rig", _joined(str(one.rig.get("name", "")) for one in experiments)),
        ("drive", _joined(" ".join(str(d[k]) for k in ("vendor", "product", "firmware") if d.get(k)) for d in drives)),
        ("source", _joined(one.source for one in experiments)),
        ("version", str(now.get("version") or NOT_TOLD)),
        ("commit", str(now.get("commit") or NOT_TOLD)),
    ]
    return Section("In short", summary(study, rungs, diagnosis, confused), [Table("Head", ["", ""], facts)], pictures)


def summary(study: Study, rungs: Ladder, diagnosis: str, confused: Sequence[str] = ()) -> list[str]:
    """What was measured, what the model is off by, what in it could be another name, what it lacks."""
    held = sum(one.role == "held_out" for one in study.trials)
    first, last = rungs.rungs[0], rungs.rungs[-1]
    added = [name.replace("_", " ") for name in last.effects if name not in first.effects]
    error = f"{percent(last.held_out)} ({percent(last.held_out_low)} .. {percent(last.held_out_high)})"
    if added:
        off = f"With {listed(added)} the error goes from {percent(first.held_out)} to {error} of the effort"
    else:
        off = f"The model is off by {error} of the effort"
    many = f"{len(study.trials)} trial{'s' if len(study.trials) != 1 else ''}"
    judged = f"of which {held} judge the model" if held else _JUDGED_BY.get(last.held_out_kind, "")
    return [
        f"{many} {'were' if len(study.trials) != 1 else 'was'} measured{f', {judged}' if judged else ''}.",
        f"{off}, on {'stretches' if 'block' in last.held_out_kind else 'trials'} that it was not fitted to.",
        *confused,
        diagnosis,
    ]


def listed(names: Sequence[str]) -> str:
    """`a, b and c`."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def _days(experiments: Iterable[Experiment]) -> str:
    days = sorted({one.started_utc.date().isoformat() for one in experiments})
    return days[0] if len(days) == 1 else f"{days[0]} .. {days[-1]}"


def _joined(values: Iterable[str]) -> str:
    return ", ".join(dict.fromkeys(value for value in values if value)) or NOT_TOLD
