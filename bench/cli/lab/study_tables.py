"""What the `study` commands print: one function per answer of `bench.study`."""

from typing import Any

from bench.cli.output import conditions, percent, say, share_interval, table, text
from compensator.lab.chance import chance_cell

Found = dict[str, Any]


def study(found: Found) -> None:
    """A study and its trials."""
    say(f"study {found['study_id']}: {found['name']}, effort: {found['effort']['name']} [{found['effort']['unit']}]")
    rows = [(one["trial_id"], one["name"], one["role"], conditions(one["conditions"])) for one in found["trials"]]
    table("Trials", ["id#", "name", "role", "conditions"], rows)


def comparison(found: Found) -> None:
    """Errors, parameters, trials and regimes of a model."""
    unit = found["effort"]["unit"]
    say(f"model {found['model_id']}: {', '.join(found['effects'])}")
    kinds = {
        "training": "training",
        "held_out": (found["error"]["held_out"] or {}).get("kind", "held out"),
        "floor": "floor",
    }
    errors = [(kinds[name], found["error"][name]) for name in kinds if found["error"].get(name)]
    table(
        "Error",
        ["on", f"rms [{unit}]#", "relative#"],
        [(name, one["rms"], percent(one["relative"])) for name, one in errors],
    )
    _parameters("Parameters", found["parameters"])
    _breakaway(found["breakaway"])
    _errors("Trials", f"rms [{unit}]#", [({"name": one["name"], **one}, one["role"]) for one in found["trials"]])
    _errors("Regimes", f"rms [{unit}]#", [(one, f"{one['rows']} rows") for one in found["regimes"]])
    if found["at_rest"]:
        _at_rest(found["at_rest"], unit)
    for note in found["notes"]:
        say(note)


def _parameters(title: str, found: list[Found]) -> None:
    names = ("effect", "name", "value", "low", "high", "unit", "note")
    rows = [tuple(one[name] for name in names) for one in found]
    table(title, ["effect", "name", "value#", "low#", "high#", "unit", "note"], rows)


def _breakaway(found: Found | None) -> None:
    if found is None:
        return
    errors = f"{percent(found['training']['relative'])}, held out {percent(found['held_out']['relative'])}"
    _parameters(f"Breakaway, {found['starts']} starts from rest: error {errors}", found["parameters"])


def _at_rest(found: Found, unit: str) -> None:
    rows = [
        (one["side"], percent(one["outside"]), one["largest"], chance_cell(one["p_value"]), one["trial"], one["time_s"])
        for one in found["sides"]
    ]
    columns = ["side", "outside#", f"largest [{unit}]#", "p#", "surest in", "at [s]#"]
    if found["outside"]:
        rests = f"{found['rests']} rest{'s' if found['rests'] != 1 else ''}"
        table(f"At rest, {found['stretches']} stretches of {rests}: beyond what friction holds", columns, rows)
    say(found["sentence"])


def simulation(found: Found) -> None:
    """Errors of a model in closed loop, by trial; coefficients before and after a refinement."""
    say(f"model {found['model_id']}: {', '.join(found['effects'])}")
    refined = found["refined"]
    rows = [("training", found["training"]), ("held out", found["held_out"])]
    if refined:
        rows += [("training, refined", refined["training"]), ("held out, refined", refined["held_out"])]
    columns = [f"position [{found['position_unit']}]#", "of its spread#", "speed#", "effort#"]
    table("In closed loop, rms error", ["on", *columns], [(name, *_in_loop(one)) for name, one in rows if one])
    trials = [
        (one["name"], one["role"].replace("_", " "), one["law"], "" if one["settled"] else "no", *_in_loop(one))
        for one in found["trials"]
    ]
    table("Trials", ["name", "used as", "servo told by", "settled", *columns], trials)
    if refined:
        values = [
            (one["effect"], one["name"], one["before"], one["after"], one["unit"]) for one in refined["parameters"]
        ]
        table("Coefficients", ["effect", "name", "by least squares#", "refined#", "unit"], values)
        say(refined["sentence"])
        before, after = percent(refined["inverse_before"]), percent(refined["inverse_after"])
        say(f"Along the measured motion the error of the effort is {before} before and {after} after.")
    for note in found["notes"]:
        say(note)


def _in_loop(error: Found) -> tuple[object, ...]:
    shares = (error[f"{name}_relative"] for name in ("position", "velocity", "effort"))
    return (error["position"], *map(percent, shares))


def diagnosis(found: Found) -> None:
    """The verdict and the ranking."""
    say(found["sentence"])
    for problem in found["data_problems"]:
        if problem not in found["sentence"]:
            say(f"data: {problem}")
    for one in found["classes"]:
        say(one["sentence"])
        if one["separating_trial"]:
            say(f"  to tell them apart: {one['separating_trial']}")
    rows = [
        (
            one["effect"],
            "yes" if one["in_class"] else "",
            one["score"],
            chance_cell(one["p_value"]),
            percent(one["held_out_before"]),
            percent(one["held_out_after"]),
            share_interval(one["gain"], one["gain_low"], one["gain_high"]),
            text(one["d_prime"]),
        )
        for one in found["ranking"]
    ]
    if rows:
        columns = ["effect", "named", "score#", "p#", "held out before#", "after#", "gain#", "d'#"]
        table("Effects by evidence", columns, rows)
    if found["provisional"]:
        say(found["provisional"]["sentence"])
    for note in found["notes"]:
        say(note)


def refitted(found: Found) -> None:
    """A model's parameters on the study's trials, and on all that were read."""
    say(
        f"model {found['model_id']} on {found['trials']} trials, {found['samples']} samples, {found['rows']} rows: "
        f"error {percent(found['training'])}, each trial left out in turn {percent(found['held_out'])}"
    )
    rows = [(one["effect"], one["name"], one["study"], one["all"], one["unit"]) for one in found["parameters"]]
    table("Parameters", ["effect", "name", "study#", "all#", "unit"], rows)
    for reason in found["skipped"]:
        say(f"left out: {reason}")


def search(found: Found) -> None:
    """The steps of a search, and what is left."""
    for step in found["steps"]:
        say(step["sentence"])
    say(found["sentence"])


def suggestion(found: Found) -> None:
    """Trials to record next, and why."""
    say(found["diagnosis"])
    say(found["sentence"])
    rows = [
        (
            one["kind"],
            _values(one["parameters"]),
            one["minutes"],
            f"{one['before']:.1f} -> {one['after']:.1f}",
            one["sentence"],
        )
        for one in found["trials"]
    ]
    if rows:
        table("Trials to record next", ["kind", "parameters", "minutes#", "predicted d'#", "why"], rows)
    for one in found["kept_out"]:
        say(f"kept out: {one['kind']}, experiment {one['experiment_id']}, {one['outcome']}: {one['reason']}")
    pairs = [
        (one["true"], one["rival"] or "nothing", one["before"], one["after"], one["promised"]) for one in found["pairs"]
    ]
    columns = ["truth", "rival", "now#", "then#", "nine in ten#"]
    table("If the truth is one, predicted d' against the other", columns, pairs)


def _values(parameters: Found) -> str:
    return ", ".join(f"{name} {_value(value)}" for name, value in parameters.items())


def _value(value: object) -> str:
    return " ".join(map(_value, value)) or "none" if isinstance(value, list | tuple) else text(value)


def extended(found: Found) -> None:
    """What was added to a study."""
    say(found["sentence"])
    if found["left_out"]:
        say(f"left out, too short for the study's filter or without its effort: {', '.join(found['left_out'])}")
    table("Added", ["id#", "name"], [(one["trial_id"], one["name"]) for one in found["added"]])


def change(found: Found) -> None:
    """What adding or dropping an effect did."""
    say(found["sentence"])
    rows = [
        (name, percent(found["before"][key]), percent(found["after"][key]))
        for key, name in (("training", "training"), ("held_out", "held out"))
    ]
    table(f"Model {found['model_id']}", ["error on", "before#", "after#"], rows)


def ladder(found: Found) -> None:
    """The rungs."""
    rows = [
        (
            one["model_id"],
            _change(one),
            percent(one["training"]),
            share_interval(one["held_out"], one["held_out_low"], one["held_out_high"]),
            percent(one["breakaway"]["held_out"]) if one["breakaway"] else "",
            f"{one['motion']['position']:.3g} {one['motion']['unit']}" if one["motion"] else "",
            one["reflected_error_g"],
        )
        for one in found["rungs"]
    ]
    errors = ["training error#", "held-out error#", "breakaway#", "position in closed loop#"]
    columns = ["model#", "change", *errors, "reflected load, error [g]#"]
    table(f"Ladder of study {found['study_id']}", columns, rows)
    floor = found["floor"]
    if floor is not None:
        say(f"floor, from repeated trials: {percent(floor['relative'] if isinstance(floor, dict) else floor)}")


def _change(rung: Found) -> str:
    signs = [f"+ {name}" for name in _names(rung["added"])] + [f"- {name}" for name in _names(rung["removed"])]
    if not signs and rung["parent_id"] is not None:
        return f"the same, {rung['trials']} trials"
    return ", ".join(signs) or f"base: {', '.join(rung['effects'])}"


def _names(value: str | list[str] | None) -> list[str]:
    if value is None:
        return []
    return [value] if isinstance(value, str) else value


def _errors(title: str, unit: str, rows: list[tuple[Found, str]]) -> None:
    table(
        title,
        ["name", "", unit, "relative#"],
        [(one["name"], extra, one["rms"], percent(one["relative"])) for one, extra in rows],
    )
