"""What a column that is not known could be meant to be."""

import difflib

from compensator.lab.recordings.recording import CHANNELS

MASTER = "master_"
# suffix of a name -> (suffix of the SI unit, factor)
_UNITS: dict[str, tuple[str, float]] = {
    "deg_s": ("rad_s", 0.017453292519943295),
    "mrad_s": ("rad_s", 1e-3),
    "rpm": ("rad_s", 0.10471975511965977),
    "mm_s": ("m_s", 1e-3),
    "n_mm": ("n_m", 1e-3),
    "mn_m": ("n_m", 1e-3),
    "kn": ("n", 1e3),
    "mn": ("n", 1e-3),
    "deg": ("rad", 0.017453292519943295),
    "mrad": ("rad", 1e-3),
    "turn": ("rad", 6.283185307179586),
    "rev": ("rad", 6.283185307179586),
    "mm": ("m", 1e-3),
    "um": ("m", 1e-6),
    "ma": ("a", 1e-3),
    "mv": ("v", 1e-3),
    "ms": ("s", 1e-3),
    "us": ("s", 1e-6),
    "ns": ("s", 1e-9),
    "percent": ("", 1e-2),
    "pct": ("", 1e-2),
}


def suggestion(name: str) -> str:
    """A sentence for a column that is no channel: a conversion, or the nearest names; "" where nothing is near."""
    lower = name.lower()
    for unit, (si_unit, factor) in _UNITS.items():
        channel = lower.removesuffix(f"_{unit}") + (f"_{si_unit}" if si_unit else "")
        if lower.endswith(f"_{unit}") and channel in CHANNELS:
            entry = f'columns.{channel} = {{ from = "{name}", scale = {factor:.10g} }}'
            return f"{channel} is known; convert with a mapping: {entry}"
    # the other joint of a pair is meant only where its name is in it
    known = [channel for channel in CHANNELS if channel.startswith(MASTER) == lower.startswith(MASTER)]
    near = [channel for channel in known if channel in lower or channel.startswith(f"{lower}_")]
    near += difflib.get_close_matches(lower, known, n=2, cutoff=0.7)
    if not near:
        return ""
    names = " or ".join(dict.fromkeys(near))
    return f'is {names} meant? Then rename it, or use a mapping: columns.{near[0]} = {{ from = "{name}" }}'
