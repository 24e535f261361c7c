"""What a command changed, in the audit log of the store: beside what came over the service."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bench.store import Store


def note(store: "Store", command: str, detail: str) -> None:
    """Write down who changed what.

    Args:
        store: that was changed.
        command: as it was typed, without `friction-bench`.
        detail: what was changed, in words without secrets.
    """
    import getpass

    from bench.store.tables.audit import AuditEntry
    from bench.store.tables.experiments import now

    try:
        user = getpass.getuser()
    except (OSError, KeyError):  # a user without a name
        user = "?"
    entry = AuditEntry(now(), "command-line", "admin", "", "CLI", command, 0, f"{detail}, by user {user}")
    store.access.audit.add([entry])
