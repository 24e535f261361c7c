"""Sections of a report on what the trials can and cannot tell, and on what to record next."""

from math import isfinite

from bench.report import Section, Table
from bench.study.models.coverage import Coverage

_WORDS = {
    "judgeable": "can be judged",
    "confounded": "looks like others",
    "hidden": "hides in the model",
    "not measured": "not measured",
}


def coverage_section(found: Coverage) -> Section:
    """Directions, speeds, loads, temperatures, starts, repeats; and how the trials stand to every effect."""
    held = [(one.quantity, one.found, one.lacking or "-") for one in found.held]
    effects = [
        (one.title, _WORDS[one.standing], _why(one.reason, one.rivals), _size(one.smallest)) for one in found.effects
    ]
    return Section(
        "What these data can and cannot tell",
        [found.sentence],
        [
            Table("What there is", ["of", "found", "what that leaves open"], held),
            Table(
                "Effects beside the model", ["effect", "these trials", "why", "shows from [% of the effort]#"], effects
            ),
        ],
    )


def advice_section(found: Coverage, separating: list[str]) -> Section:
    """What to record next, what opens most first."""
    rows = [(one.trial, len(one.effects) or "all", _names(one.effects)) for one in found.advice]
    rows += [(text, "", "tells the effects that are named together apart") for text in separating]
    if not rows:
        return Section("What to record next", ["These trials lack nothing that a further trial would add."])
    columns = ["trial", "opens#", "effects"]
    return Section("What to record next", ["What opens most effects comes first."], [Table("Trials", columns, rows)])


def _why(reason: str, rivals: list[str]) -> str:
    return "; ".join(filter(None, [reason, f"like {_names(rivals)}" if rivals else ""])) or "-"


def _size(share: float) -> float | None:
    return 100.0 * share if isfinite(share) else None


def _names(effects: list[str]) -> str:
    return ", ".join(effects).replace("_", " ")
