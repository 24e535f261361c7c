"""The sections of a study's report, from the answers of `bench.study`."""

from math import isfinite
from typing import Any

from bench.report import Bars, Figure, Line, Points, Section, Table
from bench.store import Store
from compensator.lab.chance import chance_cell

Found = dict[str, Any]
NO_SHARE = 1e-7  # less is rounding
SMALL_SHARE = 5e-4  # two digits after the point would say next to nothing of it
PICTURES = 3  # of a diagnosis, best effects first
SHOWN_TRIALS = 2  # over time: the worst one that was fitted, and the worst one held out


def measured_section(study: Found, store: Store) -> Section:
    """Which trials, under which conditions, and what they are used for."""
    rows = []
    for one in study["trials"]:
        trial = store.trial(one["trial_id"])
        held = ", ".join(f"{key} {_cell(value)}" for key, value in sorted(one["conditions"].items()))
        rows.append((trial.id, one["name"], trial.kind, one["role"].replace("_", " "), trial.rows, held))
    held_out = sum(one["role"] == "held_out" for one in study["trials"])
    return Section(
        "What was measured",
        [
            f"{len(rows)} trials, of which {held_out} are held out. Predicted is {study['effort']['name']} "
            f"[{study['effort']['unit']}]; effort and motion are filtered alike at {study['cutoff_hz']:.3g} Hz; "
            f"rows that count: {study['rows']}."
        ],
        [Table("Trials", ["id#", "name", "kind", "used as", "samples#", "conditions"], rows)],
    )


def ladder_section(found: Found) -> Section:
    """The error from model to model."""
    rungs = found["rungs"]
    rows = [
        (
            rung["model_id"],
            change_of(rung),
            _percent(rung["training"]),
            _percent(rung["held_out"]),
            f"{_percent(rung['held_out_low'])} .. {_percent(rung['held_out_high'])}",
            rung["held_out_kind"],
            _percent(rung["breakaway"]["held_out"]) if rung["breakaway"] else "",
            rung["reflected_error_g"],
        )
        for rung in rungs
    ]
    columns = [
        "model#",
        "change",
        "training#",
        "held out#",
        "90 % interval",
        "how",
        "breakaway#",
        "reflected load [g]#",
    ]
    floor = found["floor"]
    names = [f"{rung['model_id']}: {change_of(rung)}" for rung in rungs]
    held = [100.0 * rung["held_out"] for rung in rungs]
    ends = [[100.0 * rung[key] for rung in rungs] for key in ("held_out_low", "held_out_high")]
    return Section(
        "The ladder",
        [
            "Errors are shares of the effort's root mean square. "
            + (
                "No trial repeats another, so the floor is not known."
                if floor is None
                else f"Repeated trials differ by {floor:.2%}: no model of the motion can beat that floor."
            )
        ],
        [Table("Models", columns, rows)],
        [
            Figure(
                "Error from model to model",
                "",
                "error [% of the effort]",
                [
                    Bars("training", names, [100.0 * rung["training"] for rung in rungs]),
                    Bars("held out", names, held, *ends),
                ],
            )
        ],
    )


def change_of(rung: Found) -> str:
    """What a rung changed, in words."""
    if rung["parent_id"] is None:
        return "base: " + ", ".join(rung["effects"])
    signs = [f"+ {rung['added']}" if rung["added"] else "", f"- {rung['removed']}" if rung["removed"] else ""]
    return ", ".join(filter(None, signs)) or f"the same, {rung['trials']} trials"


def model_section(found: Found) -> Section:
    """The newest model: parameters, errors per regime and trial, measured against predicted."""
    unit = found["effort"]["unit"]
    breakaway = found["breakaway"]
    regimes = [(one["name"], one["rows"], one["rms"], _percent(one["relative"])) for one in found["regimes"]]
    trials = [
        (one["name"], one["role"].replace("_", " "), _number(one["rms"]), _percent(one["relative"]))
        for one in found["trials"]
    ]
    return Section(
        f"Model {found['model_id']}",
        [
            f"Effects: {', '.join(found['effects'])}.",
            *found["notes"],
            *([found["at_rest"]["sentence"]] if found["at_rest"] else []),
        ],
        [
            _parameters("Parameters", found["parameters"]),
            *([_parameters("Parameters of the breakaway effort", breakaway["parameters"])] if breakaway else []),
            Table("Error by regime", ["regime", "rows#", f"rms [{unit}]#", "relative#"], regimes),
            *([_at_rest(found["at_rest"], unit)] if found["at_rest"] else []),
            Table("Error by trial", ["trial", "used as", f"rms [{unit}]#", "relative#"], trials),
        ],
        [_over_time(found, trial) for trial in _worst(found)],
    )


def closed_loop_section(found: Found) -> Section:
    """The newest model under the servo of the trials: error of the motion beside that of the effort."""
    unit = found["position_unit"]
    columns = [f"position, rms [{unit}]#", "of its spread#", "speed#", "effort#"]
    errors = [
        (name, *_in_loop(found[key]))
        for key, name in (("training", "training"), ("held_out", "held out"))
        if found[key]
    ]
    trials = [(one["name"], one["law"], "" if one["settled"] else "no", *_in_loop(one)) for one in found["trials"]]
    return Section(
        "In closed loop",
        [
            f"Model {found['model_id']}, moved under the servo that the trials ran under: how far its joint is from "
            "the measured one, and its servo's effort from the measured effort.",
            *found["notes"],
        ],
        [
            Table("Errors", ["on", *columns], errors),
            Table("Error by trial", ["trial", "servo told by", "settled", *columns], trials),
        ],
        [_moved(one, unit) for one in sorted(found["trials"], key=_farthest)[-1:]],
    )


def _in_loop(error: Found) -> tuple[object, ...]:
    shares = (error[f"{name}_relative"] for name in ("position", "velocity", "effort"))
    return (_number(error["position"]), *map(_percent, shares))


def _farthest(trial: Found) -> float:
    value = trial["position_relative"]
    return value if isfinite(value) else -1.0


def _moved(trial: Found, unit: str) -> Figure:
    series = trial["series"]
    lines = [Line(name, series["time_s"], series[name]) for name in ("measured", "simulated")]
    return Figure(f"Trial {trial['name']}, measured and simulated", "time [s]", f"position [{unit}]", lines)


def _parameters(title: str, found: list[Found]) -> Table:
    rows = [
        (one["effect"], one["name"], _number(one["value"]), _interval(one), one["unit"], one["note"]) for one in found
    ]
    return Table(title, ["effect", "parameter", "value#", "95 % interval", "unit", "note"], rows)


def _at_rest(found: Found, unit: str) -> Table:
    rows = [
        (
            one["side"],
            _percent(one["outside"]),
            one["largest"],
            chance_cell(one["p_value"]),
            one["trial"],
            one["time_s"],
        )
        for one in found["sides"]
    ]
    title = f"At rest, {found['stretches']} stretches: beyond what friction holds"
    return Table(title, ["side", "outside#", f"largest [{unit}]#", "p#", "surest in", "at [s]#"], rows)


def _worst(found: Found) -> list[Found]:
    """Of each role, the trial with the largest error."""
    worst: dict[str, Found] = {}
    for one in found["trials"]:
        if isfinite(one["rms"]) and one["rms"] >= worst.get(one["role"], one)["rms"]:
            worst[one["role"]] = one
    return list(worst.values())[:SHOWN_TRIALS]


def _over_time(found: Found, trial: Found) -> Figure:
    series = next(one for one in found["series"] if one["trial_id"] == trial["trial_id"])
    drawn = [Line(name, series["time_s"], series[name]) for name in ("measured", "predicted", "residual")]
    role = trial["role"].replace("_", " ")
    title = f"Trial {trial['name']} ({role}): the largest error of its role"
    return Figure(title, "time [s]", f"{found['effort']['name']} [{found['effort']['unit']}]", drawn)


def residual_section(before: Found, now: Found) -> Section:
    """Residual against every driving variable, of the first model and of the newest."""
    later = {one["driver"]: one for one in now["residual_against"]}
    same = before["model_id"] == now["model_id"]
    figures = []
    for one in before["residual_against"]:
        drawn = _bins(one, "" if same else f"model {before['model_id']}, ")
        if not same and one["driver"] in later:
            drawn += _bins(later[one["driver"]], f"model {now['model_id']}, ")
        title = f"Residual against {one['driver'].replace('_', ' ')}"
        figures.append(Figure(title, f"{one['driver']} [{one['unit']}]", f"residual [{now['effort']['unit']}]", drawn))
    sentence = "Means of bins, with two standard errors from the scatter between stretches of 2 s."
    return Section("What the models leave", [sentence], figures=figures)


def _bins(against: Found, prefix: str) -> list[Points]:
    return [
        Points(f"{prefix}{group['direction']}", group["x"], group["mean"], group["low"], group["high"])
        for group in against["groups"]
    ]


def diagnosis_section(title: str, found: Found, compared: Found) -> Section:
    """The answer, the evidence in words, the ranking, and the pictures of the best effects."""
    problems = [f"Data: {problem}" for problem in found["data_problems"] if problem not in found["sentence"]]
    words = [found["sentence"], *problems]
    for one in found["classes"]:
        words.append(one["sentence"])
        if one["separating_trial"]:
            words.append(f"To tell them apart: {one['separating_trial']}.")
    words += [found["provisional"]["sentence"]] if found["provisional"] else []
    words += [f"{one['title']}: {one['sentence']}" for one in found["ranking"][:PICTURES]]
    rows = [
        (
            one["title"],
            "yes" if one["in_class"] else "",
            _number(one["score"]),
            chance_cell(one["p_value"]),
            _percent(one["held_out_before"]),
            _percent(one["held_out_after"]),
            f"{one['gain']:.1%} ({one['gain_low']:.1%} .. {one['gain_high']:.1%})",
            _number(one["d_prime"]),
            ", ".join(one["confused_with"]) or "-",
        )
        for one in found["ranking"]
    ]
    columns = ["effect", "named", "score#", "p#", "held out before#", "then#", "gain, 90 % interval", "d'#", "rivals"]
    shown = [*([found["provisional"]] if found["provisional"] else []), *found["ranking"][:PICTURES]]
    figures = [figure for one in shown if (figure := picture(one, compared["effort"]["unit"]))]
    tables = [Table("Effects by evidence", columns, rows)] if rows else []
    return Section(title, [*words, *found["notes"]], tables, figures)


def picture(ranked: Found, unit: str) -> Figure | None:
    """Partial residual over the effect's driving variable, with its curve; None where it is not measured."""
    drawn = ranked["picture"]
    if drawn is None:
        return None
    against = ", against the motion" if drawn["against_motion"] else ""
    return Figure(
        f"{ranked['title']}: what the model leaves{against}, and the effect's curve",
        f"{drawn['driver']} [{drawn['unit']}]",
        f"residual [{unit}]",
        [
            Points("residual", drawn["x"], drawn["residual"], drawn["low"], drawn["high"]),
            Line(ranked["title"], drawn["curve_x"], drawn["curve"]),
        ],
    )


def suggestion_section(found: Found) -> Section:
    """Trials to record next."""
    rows = [
        (
            one["kind"],
            ", ".join(f"{name} {_cell(value)}" for name, value in one["parameters"].items()),
            one["minutes"],
            f"{one['before']:.1f} -> {one['after']:.1f}",
            one["sentence"],
        )
        for one in found["trials"]
    ]
    columns = ["kind", "parameters", "minutes#", "predicted d'#", "why"]
    return Section("Trials to record next", [found["sentence"]], [Table("Trials", columns, rows)] if rows else [])


def provenance_section(study: Found, store: Store) -> Section:
    """Where the trials come from: experiments, software, drive, operator, rig."""
    numbers = dict.fromkeys(store.trial(one["trial_id"]).experiment_id for one in study["trials"])
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
    rig = [(key, _cell(value)) for key, value in sorted(_flat(experiments[-1].rig).items())]
    columns = ["id#", "kind", "source", "started", "operator", "software", "drive"]
    return Section(
        "Where it comes from",
        tables=[Table("Experiments", columns, rows), Table("Rig", ["value", ""], rig)],
    )


def _flat(values: Found, prefix: str = "") -> Found:
    found: Found = {}
    for key, value in values.items():
        found |= _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return found


def _number(value: float | None) -> float | None:
    return None if value is None or not isfinite(value) else value


def _percent(share: float | None) -> str:
    if share is None or not isfinite(share):
        return "-"
    return f"{100 * share:.2g}%" if NO_SHARE < abs(share) < SMALL_SHARE else f"{share:.2%}"


def _interval(one: Found) -> str:
    low, high = _number(one["low"]), _number(one["high"])
    return "-" if low is None or high is None else f"{low:.4g} .. {high:.4g}"


def _cell(value: object) -> str:
    if isinstance(value, list | tuple):
        return " ".join(map(_cell, value)) or "none"
    return f"{value:g}" if isinstance(value, float) else str(value)
