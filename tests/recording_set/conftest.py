"""A store in either database."""

from tests.store.conftest import backend, empty_database, empty_template, server, sqlite_url, store, store_url

__all__ = ["backend", "empty_database", "empty_template", "server", "sqlite_url", "store", "store_url"]
