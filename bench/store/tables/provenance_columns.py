"""What of the provenance of an experiment is kept in columns of its own, so that it can be asked for."""

from collections.abc import Mapping
from typing import Any

PATHS = {
    "bench": ("configuration", "name"),
    "software_version": ("software", "version"),
    "software_commit": ("software", "commit"),
    "drive": ("drive", "product"),
    "firmware": ("drive", "firmware"),
}
LARGEST_SEED = 2**63 - 1


def facts_of(provenance: Mapping[str, Any]) -> dict[str, str | int | None]:
    """Column -> value; None where the provenance does not say."""
    seed = provenance.get("seed")
    fits = isinstance(seed, int) and not isinstance(seed, bool) and abs(seed) <= LARGEST_SEED
    return {**{name: _text(provenance, path) for name, path in PATHS.items()}, "seed": seed if fits else None}


def _text(provenance: Mapping[str, Any], path: tuple[str, str]) -> str | None:
    section = provenance.get(path[0])
    value = section.get(path[1]) if isinstance(section, Mapping) else None
    return None if value is None else str(value)
