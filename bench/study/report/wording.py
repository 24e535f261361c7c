"""Names of the lab as words for a report: "viscous asymmetry" and not `viscous_asymmetry`."""

import re
from collections.abc import Collection, Sequence
from dataclasses import replace

from bench.config.quantities import UNITS, unit_of
from bench.report import Section, Table

# none in quotes: that is to be typed
_NAME = re.compile(r'(?<![\w./"-])[a-z]+(?:_[a-z0-9]+)+(?![\w/"-])(?!\.\w)')
_FACTORS = {"kg": ("g", 1000.0)}  # as a load is said
KEYS = "Rig"  # the table whose names are those of a file


def in_words(sections: Sequence[Section], kept: Collection[str]) -> list[Section]:
    """Sections of a report without names that are made for programs.

    Args:
        sections: of the report.
        kept: names that somebody gave, as of trials: they stay as they are.
    """
    return [_in_words(section, frozenset(kept)) for section in sections]


def name_text(name: str) -> str:
    """`viscous_asymmetry` as viscous asymmetry, `load_kg` as load."""
    unit = unit_of(name)
    ending = max((one for one, of in UNITS.items() if of == unit and name.endswith(one)), key=len, default="")
    return name.removesuffix(ending).replace("_", " ") if unit else name.replace("_", " ")


def condition_text(name: str, value: object) -> str:
    """`load_kg`, 0.2 as load 200 g; a yes or no as the name alone, or with not."""
    if isinstance(value, bool):
        return name_text(name) if value else f"not {name_text(name)}"
    unit, factor = _FACTORS.get(unit_of(name), (unit_of(name), 1.0))
    text = f"{factor * value:.6g}" if isinstance(value, int | float) else str(value)
    return " ".join(filter(None, [name_text(name), text, unit]))


def _in_words(section: Section, kept: frozenset[str]) -> Section:
    def words(text: str) -> str:
        return _NAME.sub(lambda one: one[0] if one[0] in kept else name_text(one[0]), text)

    def row(values: Sequence[object]) -> list[object]:
        return [words(value) if isinstance(value, str) else value for value in values]

    def table(one: Table) -> Table:
        return one if one.title == KEYS else replace(one, rows=[row(values) for values in one.rows])

    return replace(
        section,
        sentences=[words(sentence) for sentence in section.sentences],
        tables=[table(one) for one in section.tables],
        figures=[replace(one, title=words(one.title), x_title=words(one.x_title)) for one in section.figures],
    )
