"""What was predicted of a round of trials, and what came of it: d' of each rival, from one suggestion to the next."""

from typing import Any

from compensator.lab.effects.catalogue import effect_named


def what_came(suggested: dict[str, Any], next_suggested: dict[str, Any]) -> list[dict[str, Any]]:
    """Of each rival of a suggestion, the smallest d' that was predicted, and that the next suggestion begins with.

    Args:
        suggested: as of `suggest`, before the trials were recorded.
        next_suggested: the same after.

    Returns:
        `effect`, `predicted`, and `came`, None where it is no rival any more.
    """
    predicted, came = _smallest(suggested, "after"), _smallest(next_suggested, "before")
    return [{"effect": name, "predicted": value, "came": came.get(name)} for name, value in predicted.items()]


def in_words(came: list[dict[str, Any]]) -> str:
    """One sentence."""
    parts = []
    for one in came:
        what = "it is no rival any more" if one["came"] is None else f"{one['came']:.1f} came"
        parts.append(f"{effect_named(one['effect']).title}: {one['predicted']:.1f} was predicted, {what}")
    return f"Smallest d' with these trials. {'; '.join(parts)}."


def _smallest(suggested: dict[str, Any], end: str) -> dict[str, float]:
    found: dict[str, float] = {}
    for pair in suggested["pairs"]:
        found[pair["true"]] = min(found.get(pair["true"], pair[end]), pair[end])
    return found
