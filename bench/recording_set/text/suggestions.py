"""What a column that is not known could be meant to be."""

import difflib

from bench.recording_set.units import ENDINGS, UNITS
from compensator.lab.recordings.recording import CHANNELS

MASTER = "master_"
# what names of columns end in that are not SI
_SUFFIXES = (
    "deg_s", "mrad_s", "rpm", "mm_s", "n_mm", "mn_m", "kn", "mn", "deg", "mrad", "turn", "rev", "mm", "um", "ma", "mv",
    "ms", "us", "ns", "percent", "pct",
)  # fmt: skip
_UNITS = {suffix: UNITS[suffix.replace("_s", "/s").replace("_", "")] for suffix in _SUFFIXES}


def suggestion(name: str) -> str:
    """A sentence for a column that is no channel: a conversion, or the nearest names; "" where nothing is near."""
    lower = name.lower()
    for suffix, unit in _UNITS.items():
        channel = lower.removesuffix(f"_{suffix}") + ENDINGS[unit.si]
        if lower.endswith(f"_{suffix}") and channel in CHANNELS:
            entry = f'columns.{channel} = {{ from = "{name}", scale = {unit.factor:.10g} }}'
            return f"{channel} is known; convert with a mapping: {entry}"
    # the other joint of a pair is meant only where its name is in it
    known = [channel for channel in CHANNELS if channel.startswith(MASTER) == lower.startswith(MASTER)]
    near = [channel for channel in known if channel in lower or channel.startswith(f"{lower}_")]
    near += difflib.get_close_matches(lower, known, n=2, cutoff=0.7)
    if not near:
        return ""
    names = " or ".join(dict.fromkeys(near))
    return f'is {names} meant? Then rename it, or use a mapping: columns.{near[0]} = {{ from = "{name}" }}'
