"""Errors of the store. Each message names the database, what was found, and what to do next."""

from bench.errors import BenchError


class StoreError(BenchError):
    """Base of all errors of the store. Raised only through a subclass."""


class NotFoundError(StoreError, LookupError):
    """Raised when an experiment, trial, channel, study or model is asked for that is not in the store."""


class StoreStateError(StoreError, RuntimeError):
    """Raised when a call does not fit the state of a record.

    - rows or events for a trial that is finished
    - a second finish
    - removal of a model that other models were made from
    """


class StoreValueError(StoreError, ValueError):
    """Raised before anything is written when a value cannot be kept.

    - an outcome or source that does not exist
    - a condition that is not finite, or is neither number, text nor bool
    - a second trial of the same name in an experiment
    - rows of the wrong shape, a channel that does not exist
    - a text with a NUL character in it
    """


class StoreLockedError(StoreError, TimeoutError):
    """Raised when another process or thread keeps the database locked for longer than the time-out."""


class StoreFullError(StoreError, OSError):
    """Raised when the disk, or the quota of the database, is full. What was committed before is kept."""


class StoreReadOnlyError(StoreError, PermissionError):
    """Raised when the database or its folder may not be written."""


class StoreFileError(StoreError, OSError):
    """Raised when the database cannot be opened.

    - the folder does not exist, or the URL names no file
    - the file is no database, is damaged, or belongs to another program
    - the disk reports an error
    """


class StoreUnreachableError(StoreError, ConnectionError):
    """Raised when the database server does not answer, does not know the database, or refuses the user."""


class StoreVersionError(StoreError, RuntimeError):
    """Raised when the database was made by a newer version of the software."""
