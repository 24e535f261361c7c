"""A store in a temporary folder."""

from tests.store.conftest import empty_database, store, url

__all__ = ["empty_database", "store", "url"]
