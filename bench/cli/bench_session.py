"""What the global options choose: the configuration, and the store that is open while a command runs."""

import re
import shlex
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, cast

import typer

from bench.errors import ConfigurationError

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.config.configuration import BenchConfiguration
    from bench.store import Store

# commands that are about one bench, or about its store, in a message
_OF_A_BENCH = re.compile(r"friction-bench (?=(?:calibrate|doctor|drive|import|run|store|study|token)\b)")


@dataclass(frozen=True)
class BenchSession:
    """The global options.

    Attributes:
        config: `bench.toml`; None: the simulated bench of the paper.
        store: database URL or the path of an SQLite file; None: as configured.
    """

    config: Path | None = None
    store: str | None = None

    def configuration(self) -> "BenchConfiguration":
        """The configuration, with the store that the options choose."""
        from bench.config.configuration import default_configuration, read_configuration

        return self.with_store(default_configuration() if self.config is None else read_configuration(self.config))

    def with_store(self, found: "BenchConfiguration") -> "BenchConfiguration":
        """A configuration with the store that the options choose."""
        url = self._store_url(found.store.url)
        return found.model_copy(update={"store": found.store.model_copy(update={"url": url})})

    def in_full(self, message: str) -> str:
        """A message whose commands choose this bench: without its options they would go to the simulated one."""
        chosen = [("--config", self.config), ("--store", self.store)]
        options = "".join(f"{name} {shlex.quote(str(value))} " for name, value in chosen if value is not None)
        return _OF_A_BENCH.sub(lambda found: found[0] + options, message)

    def store_url(self) -> str:
        """Where the trials are kept."""
        return self.configuration().store.url

    @contextmanager
    def open_store(self) -> Iterator["Store"]:
        """The store, closed afterwards."""
        from bench.store import Store

        with Store.open(self.store_url()) as store:
            yield store

    def _store_url(self, configured: str) -> str:
        if self.store is None:
            return configured
        if "://" in self.store:
            return self.store
        if not self.store:
            raise ConfigurationError("--store is empty; wanted a file such as friction-bench.sqlite, or a database URL")
        return f"sqlite:///{self.store}"


def session_of(context: typer.Context) -> BenchSession:
    """The session that the global options made."""
    return cast(BenchSession, context.find_root().obj)
