"""Whether this drive, with this configuration, has passed the commissioning move: the store remembers."""

import hashlib
import json

from bench.errors import NotCommissionedError
from bench.provenance import Provenance
from bench.store import Experiment, Store
from drivers.contract import Watchdog

KIND = "commissioning"
BEFORE_IT = frozenset({KIND, "identification"})  # kinds that move a drive which has not passed
WATCHDOG_RESULT, WATCHDOG_SEEN = "watchdog", "watchdog_seen"  # results of a commissioning: how sure, and by what
IDENTITY = ("device", "vendor", "product", "firmware", "serial")
_RIG = ("gear", "sensor", "motor")
_REMEMBERED = 200  # newest commissionings that are looked through


def fingerprint(provenance: Provenance) -> str:
    """What a pass holds for: the drive's identity, its section of bench.toml, and gear, sensor and motor of the rig.

    Where the arm hangs straight down, and how that is found, is no part of it: an incremental encoder begins anew with
    each power cycle, and signs and scales stay what they are.

    Args:
        provenance: as `bench.provenance.provenance` makes it, with configuration and drive.
    """
    drive, configuration = provenance["drive"], provenance["configuration"]
    rig = configuration["rig"]
    held = {
        "identity": {name: drive.get(name) for name in IDENTITY},
        "drive": {name: value for name, value in configuration.get("drive", {}).items() if _matters(name, value)},
        "rig": {name: rig.get(name) for name in _RIG},
    }
    return hashlib.sha256(json.dumps(held, sort_keys=True).encode()).hexdigest()[:16]


def _matters(name: str, value: object) -> bool:
    """Whether a key of [drive] can change signs and scales, or what holds the joint; no brake is nothing."""
    is_no_brake = name == "brake" and isinstance(value, dict) and value.get("by") == "none"
    return name not in ("zero_rad", "homing") and not is_no_brake


def is_commissioned(store: Store, provenance: Provenance) -> bool:
    """Whether the store holds a pass for it, and nobody has seen since that its watchdog does not stop it."""
    newest = _newest(store, provenance)
    return newest is not None and newest.outcome == "completed"


def watchdog_of(store: Store, provenance: Provenance) -> Watchdog | None:
    """How sure the drive's watchdog was at its newest pass; None where there is none, or nobody tried it then."""
    newest = _newest(store, provenance)
    told = None if newest is None else newest.results.get(WATCHDOG_RESULT)
    return None if told is None else Watchdog(told)


def _newest(store: Store, provenance: Provenance) -> Experiment | None:
    """The newest commissioning of it that has passed, or has found that its watchdog does not stop it."""
    wanted = fingerprint(provenance)
    for found in store.experiments(kind=KIND, limit=_REMEMBERED):
        kept = found.provenance
        told = found.outcome == "completed" or found.results.get(WATCHDOG_RESULT) == Watchdog.NONE
        if told and {"drive", "configuration"} <= kept.keys() and fingerprint(kept) == wanted:
            return found
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
        "(drive, gear, sensor, motor) in this store; take the load off and run 'friction-bench doctor --move' (or the "
        f"experiment '{KIND}'): the joint moves a few degrees. Then start again"
    )
