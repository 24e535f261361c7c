"""What the commands print: tables for people, JSON for programs, errors on stderr."""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from bench.errors import BenchError

if TYPE_CHECKING:  # rich is imported when something is printed: `--help` starts at once
    from rich.console import Console

    from bench.report import Section


class FileError(BenchError, OSError):
    """Raised when a file that a command writes cannot be written."""


Json = Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")]
_MOST_COLUMNS = 200
COMMAND = "friction-bench "

NO_SHARE = 1e-7  # less is rounding
SMALL_SHARE = 5e-4  # two digits after the point would say next to nothing of it


def shown(sentence: str) -> str:
    """Text from outside, as a terminal may see it: control signs, which can move its cursor, are replaced."""
    from rich.markup import escape

    return escape("".join(sign if sign.isprintable() or sign in "\n\t" else "\ufffd" for sign in sentence))


def console() -> "Console":
    """The terminal. Made at each call, because stdout may have been exchanged since the last."""
    from rich.console import Console

    plain = Console()
    # a pipe has no width of its own; do not cut lines that a program will read
    return plain if plain.is_terminal else Console(width=_MOST_COLUMNS)


def say(sentence: str) -> None:
    """One sentence. One with a command is left to the terminal to wrap: with a line end in it, half of it would run."""
    console().print(shown(sentence), highlight=False, soft_wrap=COMMAND in sentence)


def complain(sentence: str) -> None:
    """One error, on stderr."""
    from rich.console import Console

    Console(stderr=True, soft_wrap=True).print(f"[bold red]error:[/] {shown(sentence)}", highlight=False)


def remark(sentence: str) -> None:
    """One sentence beside an answer that a program reads, on stderr."""
    from rich.console import Console

    Console(stderr=True, soft_wrap=True).print(shown(sentence), highlight=False)


def table(title: str, columns: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """A table; columns whose name ends in '#' hold numbers and stand to the right."""
    from rich.table import Table

    made = Table(title=shown(title), title_justify="left", header_style="bold")
    for name in columns:
        made.add_column(shown(name.removesuffix("#")), justify="right" if name.endswith("#") else "left")
    for row in rows:
        made.add_row(*(shown(text(cell)) for cell in row))
    console().print(made)


def print_json(value: Any) -> None:
    """JSON on stdout; NaN becomes null."""
    typer.echo(json.dumps(_finite(value), indent=2, default=_encode, allow_nan=False))


def text(value: object) -> str:
    """A cell: short numbers, local times, '-' for nothing."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "-"
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, datetime):
        return value.astimezone().strftime("%Y-%m-%d %H:%M:%S")
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(text, value))}]"
    return str(value)


def percent(share: float | None) -> str:
    """A share of 1 as per cent; a small one by its first two digits."""
    if share is None or math.isnan(share):
        return "-"
    return f"{100 * share:.2g} %" if NO_SHARE < abs(share) < SMALL_SHARE else f"{100 * share:.2f} %"


def share_interval(value: float | None, low: float | None, high: float | None) -> str:
    """A share with its interval."""
    if low is None or high is None:
        return percent(value)
    return f"{percent(value)} ({percent(low)} to {percent(high)})"


def conditions(values: Mapping[str, object]) -> str:
    """Conditions of a trial on one line."""
    return ", ".join(f"{key}={text(value)}" for key, value in values.items())


def refuse_taken(path: Path, mend: str = "name another file") -> None:
    """Check a place before anything is written.

    Raises:
        FileError: it is taken; the message says how to mend that.
    """
    if path.exists():
        raise FileError(f"{path}: is there already; {mend}, or remove it")


def free_page(stem: str) -> Path:
    """A place for a report: the first of STEM.html, STEM-2.html, STEM-3.html, .. that is free."""
    places = (Path(f"{stem}{'' if number == 1 else f'-{number}'}.html") for number in count(1))
    return next(place for place in places if not place.exists())


def write_whole(path: Path, chunks: Iterable[bytes]) -> None:
    """Write a file: all of it appears, or nothing.

    Raises:
        FileError: the place is taken or cannot be written.
    """
    refuse_taken(path)
    unfinished = path.with_name(f".{path.name}.part")
    try:
        with unfinished.open("wb") as file:
            file.writelines(chunks)
        unfinished.rename(path)
    except OSError as error:
        raise FileError(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        unfinished.unlink(missing_ok=True)


def _finite(value: Any) -> Any:
    if hasattr(value, "model_dump"):  # an answer of the lab
        value = value.model_dump()
    if isinstance(value, dict):
        return {str(key): _finite(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _encode(value: Any) -> Any:
    if isinstance(value, datetime):
        return value.isoformat()
    if hasattr(value, "tolist"):
        return _finite(value.tolist())
    return str(value)


def print_section(section: "Section") -> None:
    """A section of a report: its title, its sentences, its tables."""
    say("")
    say(section.title)
    for sentence in section.sentences:
        say(sentence)
    for one in section.tables:
        table(one.title, one.columns, one.rows)
