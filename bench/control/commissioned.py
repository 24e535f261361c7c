"""Whether this drive, with this configuration, has passed the commissioning move: the store remembers."""

import hashlib
import json

from bench.errors import NotCommissionedError
from bench.provenance import Provenance
from bench.store import Store
from drivers.contract import Watchdog

KIND = "commissioning"
WATCHDOG_FACT = "watchdog_proof"  # in the provenance of a pass that began with the proof
_IDENTITY = ("device", "vendor", "product", "firmware", "serial")
_RIG = ("gear", "sensor", "motor")
_REMEMBERED = 100  # newest passes that are looked through


def fingerprint(provenance: Provenance) -> str:
    """What a pass holds for: the drive's identity, its section of bench.toml, and gear, sensor and motor of the rig.

    Args:
        provenance: as `bench.provenance.provenance` makes it, with configuration and drive.
    """
    drive, configuration = provenance["drive"], provenance["configuration"]
    rig = configuration["rig"]
    held = {
        "identity": {name: drive.get(name) for name in _IDENTITY},
        "drive": configuration.get("drive"),
        "rig": {name: rig.get(name) for name in _RIG},
    }
    return hashlib.sha256(json.dumps(held, sort_keys=True).encode()).hexdigest()[:16]


def is_commissioned(store: Store, provenance: Provenance) -> bool:
    """Whether the store holds a pass for it."""
    wanted = fingerprint(provenance)
    passes = store.experiments(kind=KIND, outcome="completed", limit=_REMEMBERED)
    return any(
        fingerprint(found.provenance) == wanted
        for found in passes
        if {"drive", "configuration"} <= found.provenance.keys()
    )


def watchdog_of(store: Store, provenance: Provenance) -> Watchdog | None:
    """How sure the drive's watchdog was at its newest pass; None where there is none, or nobody tried it then."""
    wanted = fingerprint(provenance)
    for found in store.experiments(kind=KIND, outcome="completed", limit=_REMEMBERED):
        kept = found.provenance
        if {"drive", "configuration", WATCHDOG_FACT} <= kept.keys() and fingerprint(kept) == wanted:
            return Watchdog(kept[WATCHDOG_FACT]["watchdog"])
    return None


def require_commissioned(store: Store, provenance: Provenance) -> None:
    """Refuse a drive that has not passed.

    Raises:
        NotCommissionedError: with what to do.
    """
    if is_commissioned(store, provenance):
        return
    raise NotCommissionedError(
        f"drive '{provenance['drive']['device']}' has not passed the commissioning move with this configuration "
        "(drive, gear, sensor, motor); take the load off and run 'friction-bench doctor --move' (or the experiment "
        f"'{KIND}'): the joint moves a few degrees. Then start again"
    )
