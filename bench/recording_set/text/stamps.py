"""Dates and times of day as seconds since the first: ISO 8601, and as spreadsheets of several countries write them."""

import re
from collections.abc import Callable, Sequence
from datetime import datetime, timedelta

import numpy as np

from compensator.lab.recordings.recording import FloatArray

_FORMATS = ("%d.%m.%Y %H:%M:%S.%f", "%d/%m/%Y %H:%M:%S.%f", "%m/%d/%Y %H:%M:%S.%f", "%Y/%m/%d %H:%M:%S.%f")
_CLOCK = re.compile(r"(?:(?P<hours>\d{1,3}):)?(?P<minutes>\d{1,2}):(?P<seconds>\d{1,2}(?:\.\d+)?)")
_FRACTION = re.compile(r"(?<=:\d\d),(?=\d)")
_LONG_FRACTION = re.compile(r"(\.\d{6})\d+")
_AFTERNOON = re.compile(r"\s*(?P<half>[AaPp])\.?[Mm]\.?$")
_EPOCH = datetime(1970, 1, 1)
_DAY_S = 86400.0
LONGEST = 64  # characters: more is no date or time, and would be looked at for long


class BadCell(ValueError):
    """A cell that is not what its column is read as."""

    def __init__(self, index: int, text: str) -> None:
        super().__init__(text)
        self.index = index
        self.text = text


class NoStamp(BadCell):
    """A cell that is no date or time."""


def seconds_of(cells: Sequence[str]) -> FloatArray:
    """Seconds since the first, shape (n,). Of times of day without a date, midnight is passed at most once.

    Where the order of day and month is not told, that is taken in which the recording is over the sooner.

    Raises:
        NoStamp: a cell that is none.
    """
    if too_long := [index for index, cell in enumerate(cells) if len(cell) > LONGEST]:
        raise NoStamp(too_long[0], cells[too_long[0]])
    texts = [_LONG_FRACTION.sub(r"\1", _FRACTION.sub(".", cell.strip())) for cell in cells]
    if not texts:
        return np.empty(0)
    readers = [read for read in _READERS if read(texts[0]) is not None]
    if not readers:
        raise NoStamp(0, cells[0])
    found: list[FloatArray] = []
    for read in readers:
        seconds = list(map(read, texts))
        if None not in seconds:
            values = np.array(seconds, dtype=float)
            found.append(
                values + _DAY_S * np.cumsum(np.diff(values, prepend=values[0]) < -0.5 * _DAY_S) * (read is _of_day)
            )
        else:
            fault = seconds.index(None)
    if not found:
        raise NoStamp(fault, cells[fault])
    best: FloatArray = min(found, key=np.ptp)
    since: FloatArray = best - best[0]
    return since


def _iso(text: str) -> float | None:
    try:
        return _since_epoch(datetime.fromisoformat(text))
    except ValueError:
        return None


def _as_written(form: str) -> Callable[[str], float | None]:
    def read(text: str) -> float | None:
        half = _AFTERNOON.search(text)
        bare = _AFTERNOON.sub("", text)
        try:
            moment = datetime.strptime(bare if "." in bare[10:] else f"{bare}.0", form)
        except ValueError:
            return None
        return _since_epoch(moment) + 3600.0 * (0 if half is None else _shift(moment.hour, half["half"]))

    return read


def _since_epoch(moment: datetime) -> float:
    if moment.tzinfo is not None:
        moment = moment.replace(tzinfo=None) - (moment.utcoffset() or timedelta())
    return (moment - _EPOCH).total_seconds()


def _of_day(text: str) -> float | None:
    match = _CLOCK.fullmatch(text)
    if match is None:
        return None
    return 3600.0 * float(match["hours"] or 0.0) + 60.0 * float(match["minutes"]) + float(match["seconds"])


def _shift(hour: int, half: str) -> int:
    late = half.lower() == "p"
    return 12 if late and hour < 12 else (-12 if not late and hour == 12 else 0)


_READERS: tuple[Callable[[str], float | None], ...] = (_iso, *map(_as_written, _FORMATS), _of_day)
