"""What the store keeps for the service: tokens, the audit log, answers to repeated starts."""

from bench.store.access_tokens import AccessTokens
from bench.store.audit import Audit
from bench.store.database import Database
from bench.store.start_keys import StartKeys


class AccessRecords:
    """`Store.access`."""

    def __init__(self, database: Database) -> None:
        self.tokens = AccessTokens(database)
        self.audit = Audit(database)
        self.start_keys = StartKeys(database)
