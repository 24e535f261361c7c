"""The benches of a laboratory, as each last told of itself."""

from dataclasses import asdict, dataclass
from datetime import datetime

from sqlalchemy import func, insert, select, update

from bench.store.database import Database
from bench.store.schema import BENCH

LOST_S = 20.0  # a bench tells of itself every few seconds; one that has not for so long is not reached


@dataclass(frozen=True, slots=True)
class BenchWord:
    """What a bench tells of itself.

    Attributes:
        name: of the bench.
        host: machine that it runs on.
        state: "idle" or "running".
        doing: the experiment that runs.
        lease: who has it, "" where nobody has.
        queue: how many wait, and why it is held.
        waiting: experiments that are recorded and not handed in yet.
    """

    name: str
    host: str
    state: str
    doing: str = ""
    lease: str = ""
    queue: str = ""
    waiting: int = 0


@dataclass(frozen=True, slots=True)
class SeenBench:
    """A bench, and when it was heard of last, by the clock of the database.

    Attributes:
        word: what it told; its state is "lost" where it has not been heard of for `LOST_S`.
        silent_s: since then [s].
    """

    word: BenchWord
    seen_utc: datetime
    silent_s: float

    @property
    def state(self) -> str:
        """As told, or "lost"."""
        return "lost" if self.silent_s > LOST_S else self.word.state


class Benches:
    """The benches that share a database. Every method may be called from any thread."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def tell(self, word: BenchWord) -> None:
        """Put down what a bench tells of itself now."""
        values = asdict(word) | {"seen_utc": func.now()}
        with self._database.writing() as connection:
            mine = update(BENCH).where(BENCH.c.name == word.name)
            if not connection.execute(mine.values(**values)).rowcount:
                connection.execute(insert(BENCH).values(**values))

    def all(self) -> list[SeenBench]:
        """By name."""
        with self._database.reading() as connection:
            rows = connection.execute(
                select(BENCH, func.now(type_=BENCH.c.seen_utc.type).label("now_utc")).order_by(BENCH.c.name)
            )
            found = [row._asdict() for row in rows]
        seen = [(one.pop("seen_utc"), one.pop("now_utc"), BenchWord(**one)) for one in found]
        return [SeenBench(word, at, (now - at).total_seconds()) for at, now, word in seen]
