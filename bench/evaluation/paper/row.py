"""One row of the page: a figure or table of the paper, ours beside it, and the trials behind it."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby

from bench.report import Section
from bench.store import Trial

# what the paper shows, as numbers; read off its figures where it gives no table
TABLE_1_G = {
    0: -0.36, 10: 8.90, 20: 19.09, 30: 27.27, 40: 41.63, 50: 51.27, 60: 59.27, 70: 69.27, 80: 81.63, 90: 90.54,
    100: 100.54,
}  # fmt: skip
"""Actual load [g] -> reflected load [g]. At 90 degrees, as Fig. 8 says; the caption says 0."""

FIG_2 = {"speed_at_500_ma_rpm": 2000.0}
FIG_3 = {"duty_at_1200_rpm_lightest": 0.4}
"""About 400 counts, taken as counts of 1000."""
FIG_4 = {"lowest_ma": 100.0, "highest_ma": 850.0, "spread_ma": 750.0}
FIG_7 = {"largest_uncompensated_ma": 300.0, "largest_compensated_ma": 0.0}
FIG_9 = {"lowest_ma": -100.0, "highest_ma": 900.0}


Number = float | int | None
FIGURES = {
    "fig-2": "Fig. 2", "fig-3": "Fig. 3", "fig-4": "Fig. 4", "fig-7": "Fig. 7", "table-1": "Table 1, Fig. 8",
    "fig-9": "Fig. 9", "fig-10": "Fig. 10", "fig-11": "Fig. 11", "accelerated": "future work",
    "teleoperation": "master and slave",
}  # fmt: skip
"""The rows by name, as the paper calls them."""
_UNITS = {"ma": "mA", "g": "g", "rpm": "rpm", "ms": "ms"}


@dataclass(frozen=True)
class Row:
    """One figure or table.

    Attributes:
        name: as the paper counts ("fig-4").
        section: words, tables, figures.
        ours, paper: the numbers that are compared, by the same names, units in them; None where the paper gives none.
        experiment_ids, trial_ids: what it was drawn from.
    """

    name: str
    section: Section
    ours: dict[str, Number]
    paper: dict[str, Number] = field(default_factory=dict)
    experiment_ids: tuple[int, ...] = ()
    trial_ids: tuple[int, ...] = ()

    def to_json(self) -> dict[str, object]:
        """The numbers, and where they come from."""
        return {
            "name": self.name,
            "title": self.section.title,
            "ours": self.ours,
            "paper": {name: self.paper.get(name) for name in self.ours},
            "experiment_ids": list(self.experiment_ids),
            "trial_ids": list(self.trial_ids),
        }

    def lines(self) -> list[tuple[str, str, str, str]]:
        """Figure, quantity, ours, the paper's, in words: one line for each number that is compared."""
        cells = {name: (_cell(value), _cell(self.paper.get(name))) for name, value in self.ours.items()}
        return [(FIGURES[self.name], in_words(name), *pair) for name, pair in cells.items()]

    def with_source(self) -> Section:
        """The section, and a sentence that names its trials."""
        where = f"Drawn from {_named('trial', self.trial_ids)} of {_named('experiment', self.experiment_ids)}."
        return replace(self.section, sentences=[*self.section.sentences, where])


def ids_of(trials: Sequence[Trial]) -> tuple[int, ...]:
    """What a row names of trials."""
    return tuple(trial.id for trial in trials)


def in_words(name: str) -> str:
    """A quantity's name as people read it: `spread_ma` as "spread [mA]"."""
    words = [_UNITS.get(word, word) if index else word for index, word in enumerate(name.split("_"))]
    unit = f" [{words.pop()}]" if name.rsplit("_", 1)[-1] in _UNITS else ""
    return " ".join(words) + unit


def _cell(value: Number) -> str:
    return "-" if value is None else f"{value:.4g}"


def spans(numbers: Sequence[int]) -> str:
    """1, 2, 3, 5 as "1 .. 3, 5"."""
    ordered = sorted(set(numbers))
    runs = [[number for _, number in run] for _, run in groupby(enumerate(ordered), lambda pair: pair[1] - pair[0])]
    return ", ".join(f"{run[0]} .. {run[-1]}" if len(run) > 2 else ", ".join(map(str, run)) for run in runs)


def _named(what: str, ids: Sequence[int]) -> str:
    return f"{what}{'s' if len(ids) > 1 else ''} {spans(ids)}"
