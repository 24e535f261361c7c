"""What happens on the bench, one JSON object a line, for a machine to read: `--log FILE`, or `-` for stderr.

The store keeps what was recorded, and the audit log who changed what. This is for what gathers the logs of a machine:
runs and trials with their ends, requests that change something, starts and ends of processes, errors with traceback.
"""

import atexit
import logging
import os
import queue
import sys
from datetime import UTC, datetime
from logging.handlers import QueueHandler, QueueListener, WatchedFileHandler
from pathlib import Path
from typing import Any

import orjson

from bench.errors import ConfigurationError

VARIABLE = "FRICTION_BENCH_LOG"
STDERR = "-"
SERVERS = ("uvicorn",)  # loggers that pass nothing on
_log = logging.getLogger("bench.events")
# where no log is written, nothing is: logging would print the bare name of a warning to the terminal
_log.addHandler(logging.NullHandler())


class JsonLine(logging.Formatter):
    """A record as JSON: at_utc, level, logger, process, event, what it says more, and `error`, a traceback."""

    def format(self, record: logging.LogRecord) -> str:
        """One line."""
        at = datetime.fromtimestamp(record.created, UTC)
        line: dict[str, object] = {"at_utc": at.isoformat(timespec="milliseconds"), "level": record.levelname.lower()}
        line |= {"logger": record.name, "process": record.process, "event": record.getMessage()}
        line |= getattr(record, "facts", {})
        if record.exc_info:
            line["error"] = self.formatException(record.exc_info)
        return orjson.dumps(line, default=str, option=orjson.OPT_SERIALIZE_NUMPY | orjson.OPT_NON_STR_KEYS).decode()


def begin(target: str) -> None:
    """Write the log from now on; processes that are started from here do, too.

    Args:
        target: a file, which lines are added to (it may be moved away meanwhile, as log rotation does); "-": stderr.

    Raises:
        ConfigurationError: the file cannot be written.
    """
    lines: queue.SimpleQueue[logging.LogRecord] = queue.SimpleQueue()
    writer = QueueListener(lines, _handler(target))  # STOP and the control loop wait for no disk and no pipe
    writer.start()
    atexit.register(writer.stop)
    handler = QueueHandler(lines)
    handler.setFormatter(JsonLine())
    os.environ[VARIABLE] = target if target == STDERR else str(Path(target).absolute())
    for name in ("", *SERVERS):
        logging.getLogger(name).addHandler(handler)
    logging.getLogger("bench").setLevel(logging.INFO)


def begin_as_chosen() -> None:
    """In a process that another one has started: as that one does. A file that cannot be opened here is left out."""
    if target := os.environ.get(VARIABLE):
        try:
            begin(target)
        except ConfigurationError as error:
            logging.getLogger(__name__).warning("%s", error)


def note(event: str, level: int = logging.INFO, **facts: Any) -> None:
    """Something has happened; costs next to nothing where no log is written.

    Args:
        event: what, in few words that stay the same: "run ended".
        level: of logging.
        facts: which, why, how much; the unit in the name.
    """
    _log.log(level, event, extra={"facts": facts})


class _OwnersFileHandler(WatchedFileHandler):
    """A log that only its owner reads: it names people, addresses and what they did."""

    def _open(self) -> Any:
        return open(self.baseFilename, self.mode, encoding=self.encoding, opener=_new_for_owner)


def _new_for_owner(path: str, flags: int) -> int:
    return os.open(path, flags, 0o600)


def _handler(target: str) -> logging.Handler:
    if target == STDERR:
        return logging.StreamHandler(sys.stderr)
    try:
        return _OwnersFileHandler(target, encoding="utf-8")
    except OSError as error:
        raise ConfigurationError(
            f"the log {target} cannot be written: {error.strerror or error}; "
            "choose another file with --log, or '-' for stderr"
        ) from error
