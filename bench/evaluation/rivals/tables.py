"""The comparison as tables, and as numbers."""

from collections.abc import Sequence
from math import degrees

from bench.evaluation.rivals.comparison import LOAD_KG, Comparison
from bench.evaluation.rivals.scoring import REGIMES, Score
from bench.json_types import Value
from bench.report import Section, Table
from compensator.rivals import RIVALS

DYNAMIC = ("dahl", "reset-integrator", "lugre-observer")
FAR_LESS = 0.5
WHEN = {"at rest": "at rest", "reversal": "at reversals"}
_MEANS = ("seconds", "travel_rad", "energy_j")


def section_of(comparisons: Sequence[Comparison], seeds: int) -> Section:
    """One table for each rig."""
    return Section(
        title="Rivals on the same samples",
        sentences=[
            f"{1e3 * LOAD_KG:g} g, seeds: {seeds}. At rest after steps to 90 degrees, at steady speeds, in a sinusoid "
            "of 0.5 Hz and 45 degrees, within 0.15 s of its reversals, and pressed against a wall. All know the same "
            "calibration. Those who know of no load have the curve of 50 g, which is the load that hangs there; "
            "breakaway takes them as many encoder counts as the search takes for a departure. What does not filter by "
            "itself is smoothed as the observers are, at 5 Hz. The errors are grams at 90 degrees: mean absolute, and "
            "largest.",
            "Those who need no search give something at once; at rest it is before the search. The two that search are "
            "given the result of one at angle 0 before each motion.",
            *_free_play(comparisons),
        ],
        tables=[_table(one) for one in comparisons],
    )


def _free_play(comparisons: Sequence[Comparison]) -> list[str]:
    """What free play, the paper's reason to set the dynamic models aside, makes of them."""
    if len(comparisons) < 2:
        return []
    found = []
    for rival in RIVALS:
        if rival.name in DYNAMIC:
            errors = (f"{one.scores[rival.name].mean_g('at rest') or 0.0:.1f} g {one.rig}" for one in comparisons)
            found.append(f"{rival.title} {', '.join(errors)}")
    return [
        "The paper sets dynamic models aside because free play parts the surfaces. Their mean error at rest here: "
        f"{'; '.join(found)}. {_verdict(comparisons[0], comparisons[-1])}"
    ]


def _verdict(one: Comparison, other: Comparison) -> str:
    """Whether the dynamic models fail by free play: whether they err far less without it."""
    names = [rival.name for rival in RIVALS if rival.name in DYNAMIC]
    better = {
        words: sum(_far_less(other.scores[name].mean_g(regime), one.scores[name].mean_g(regime)) for name in names)
        for regime, words in WHEN.items()
    }
    told = " and ".join(f"{count} of {len(names)} {words}" for words, count in better.items())
    borne_out = "borne out" if any(better.values()) else "not borne out"
    return f"Half of that error or less {other.rig} have {told}: on this joint the reason is {borne_out}."


def _far_less(error_g: float | None, than_g: float | None) -> bool:
    return error_g is not None and than_g is not None and error_g < FAR_LESS * than_g


def numbers_of(comparisons: Sequence[Comparison]) -> list[dict[str, Value]]:
    """Rig, rival, and for each regime mean and largest error [g] and rows without an estimate; what a search took."""
    return [
        {
            "rig": one.rig,
            "rival": rival.name,
            "title": rival.title,
            "source": rival.source,
            **{
                regime.replace(" ", "_"): {
                    "mean_absolute_error_g": score.mean_g(regime),
                    "max_error_g": score.max_g(regime),
                    "without_estimate": score.missing[regime],
                }
                for regime in REGIMES
            },
            **{f"search_{name}": _mean(getattr(score, name)) for name in _MEANS},
        }
        for one in comparisons
        for rival in RIVALS
        for score in [one.scores[rival.name]]
    ]


def _table(one: Comparison) -> Table:
    columns = ["", *(f"{regime} [g]#" for regime in REGIMES), "search [s]#", "its way [deg]#", "its energy [J]#"]
    rows = [(rival.title, *_cells(one.scores[rival.name])) for rival in RIVALS]
    return Table(f"Error {one.rig}: mean / largest", columns, rows)


def _cells(score: Score) -> list[str]:
    errors = [_pair(score.mean_g(regime), score.max_g(regime)) for regime in REGIMES]
    seconds, travel_rad, energy_j = (_mean(getattr(score, name)) for name in _MEANS)
    way = None if travel_rad is None else degrees(travel_rad)
    return [*errors, *(_short(value) for value in (seconds, way, energy_j))]


def _pair(mean: float | None, largest: float | None) -> str:
    return "-" if mean is None or largest is None else f"{mean:.3g} / {largest:.3g}"


def _short(value: float | None) -> str:
    return "none" if value is None else f"{value:.2g}"


def _mean(values: Sequence[float]) -> float | None:
    return sum(values) / len(values) if values else None
