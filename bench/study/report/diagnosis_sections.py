"""Sections of a study's report: the diagnosis, what to record next, and where the trials come from."""

from collections.abc import Mapping
from typing import Any

from bench.report import Figure, Line, Points, Section, Table
from bench.store import Store
from bench.study.diagnosis.findings import numbers_explained
from bench.study.models.comparison import Comparison
from bench.study.models.diagnosis import ORDER, Diagnosis, ProvisionalTerm, Ranked
from bench.study.models.study import Study
from bench.study.report.model_sections import cell, gain_cell, number, percent
from bench.study.report.wording import KEYS, condition_text
from bench.study.suggestion.suggested import Suggested

PICTURES = 3  # of a diagnosis, best effects first


def diagnosis_section(title: str, found: Diagnosis, compared: Comparison) -> Section:
    """The answer, the evidence in words, the ranking, and the pictures of the best effects."""
    problems = [f"Data: {one.text}" for one in found.findings if one.code == "data-problem"]
    words = [found.sentence, *([found.advice] if found.slight else []), *problems]
    for one in found.classes:
        words.append(one.sentence)
        if one.separating_trial:
            words.append(f"To tell them apart: {one.separating_trial}.")
    words += [found.provisional.sentence] if found.provisional else []
    words += [f"{one.title}: {one.sentence}" for one in found.ranking[:PICTURES]]
    rows = [
        (
            one.title,
            "yes" if one.in_class else "",
            number(one.score),
            percent(one.held_out_before),
            percent(one.held_out_after),
            gain_cell(one.gain, one.gain_low, one.gain_high),
            number(one.d_prime),
            ", ".join(one.confused_with).replace("_", " ") or "-",
            ", ".join(one.why_not) or "-",
        )
        for one in found.ranking
    ]
    columns = [
        "effect",
        "named",
        "score#",
        "held out before#",
        "then#",
        "gain, 90 % interval",
        "d'#",
        "rivals",
        "why not",
    ]
    shown: list[Ranked | ProvisionalTerm] = [found.provisional] if found.provisional else []
    shown += found.ranking[:PICTURES]
    figures = [figure for one in shown if (figure := picture(one, compared.effort.unit))]
    tables = [Table(f"Effects by evidence: {ORDER}", columns, rows)] if rows else []
    explained = numbers_explained(found.ranking)
    return Section(title, [*words, *([explained] if explained else []), *found.notes], tables, figures)


def picture(ranked: Ranked | ProvisionalTerm, unit: str) -> Figure | None:
    """Partial residual over the effect's driving variable, with its curve; None where it is not measured."""
    drawn = ranked.picture
    if drawn is None:
        return None
    against = ", against the motion" if drawn.against_motion else ""
    return Figure(
        f"{ranked.title}: what the model leaves{against}, and the effect's curve",
        f"{drawn.driver} [{drawn.unit}]",
        f"residual [{unit}]",
        [
            Points("residual", drawn.x, drawn.residual, drawn.low, drawn.high),
            Line(ranked.title, drawn.curve_x, drawn.curve),
        ],
    )


def suggestion_section(found: Suggested) -> Section:
    """Trials to record next."""
    rows = [
        (
            one.kind,
            ", ".join(
                condition_text(name, value if isinstance(value, int | float) else cell(value))
                for name, value in one.parameters.items()
            ),
            one.minutes,
            f"{one.before:.1f} -> {one.after:.1f}",
            one.sentence,
        )
        for one in found.trials
    ]
    columns = ["kind", "parameters", "minutes#", "predicted d'#", "why"]
    return Section("Trials to record next", [found.sentence], [Table("Trials", columns, rows)] if rows else [])


def provenance_section(study: Study, store: Store) -> Section:
    """Where the trials come from: experiments, software, drive, operator, rig."""
    numbers = dict.fromkeys(store.trial(one.trial_id).experiment_id for one in study.trials)
    experiments = [store.experiment(number) for number in numbers]
    rows = []
    for one in experiments:
        software, drive = one.provenance.get("software", {}), one.provenance.get("drive") or {}
        rows.append(
            (
                one.id,
                one.kind,
                one.source,
                one.started_utc.isoformat(timespec="seconds"),
                one.operator or "-",
                " ".join(str(software[key]) for key in ("version", "commit") if software.get(key)) or "-",
                " ".join(str(drive[key]) for key in ("vendor", "product", "firmware") if drive.get(key)) or "-",
            )
        )
    rig = [(key, cell(value)) for key, value in sorted(_flat(experiments[-1].rig).items())]
    columns = ["id#", "kind", "source", "started", "operator", "software", "drive"]
    return Section(
        "Where it comes from",
        tables=[Table("Experiments", columns, rows), Table(KEYS, ["value", ""], rig)],
    )


def _flat(values: Mapping[str, Any], prefix: str = "") -> dict[str, object]:
    found: dict[str, object] = {}
    for key, value in values.items():
        found |= _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return found
