"""What the store keeps for the service: tokens, the audit log, answers to repeated starts."""

from bench.store.database import Database
from bench.store.tables.access_tokens import AccessTokens
from bench.store.tables.audit import Audit
from bench.store.tables.start_keys import StartKeys


class AccessRecords:
    """`Store.access`."""

    def __init__(self, database: Database) -> None:
        self.tokens = AccessTokens(database)
        self.audit = Audit(database)
        self.start_keys = StartKeys(database)
