"""What was predicted of a round of trials, and what came of it: d' of each rival, from one suggestion to the next."""

from collections.abc import Sequence

from bench.study.suggestion.suggested import Came, Suggested
from compensator.lab.effects.catalogue import effect_named


def what_came(suggested: Suggested, next_suggested: Suggested) -> list[Came]:
    """Of each rival of a suggestion, the smallest d' that was predicted, and that the next suggestion begins with.

    Args:
        suggested: before the trials were recorded.
        next_suggested: the same after.
    """
    predicted = _smallest([(pair.true, pair.after) for pair in suggested.pairs])
    came = _smallest([(pair.true, pair.before) for pair in next_suggested.pairs])
    return [Came(effect=name, predicted=value, came=came.get(name)) for name, value in predicted.items()]


def in_words(came: Sequence[Came]) -> str:
    """One sentence."""
    parts = []
    for one in came:
        what = "it is no rival any more" if one.came is None else f"{one.came:.1f} came"
        parts.append(f"{effect_named(one.effect).title}: {one.predicted:.1f} was predicted, {what}")
    return f"Smallest d' with these trials. {'; '.join(parts)}."


def _smallest(values: Sequence[tuple[str, float]]) -> dict[str, float]:
    found: dict[str, float] = {}
    for name, value in values:
        found[name] = min(found.get(name, value), value)
    return found
