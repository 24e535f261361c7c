"""How far a long computation has come: it names its stages, and whoever follows it is told of each.

A computation that nobody follows tells nobody. Who follows is known to the thread that computes alone.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from typing import TypeVar

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Stage:
    """Where a computation is.

    Attributes:
        names: of all its stages, in order.
        done: how many of them have ended.
        part: of the stage that is under way, 0..1.
    """

    names: tuple[str, ...]
    done: int
    part: float = 0.0

    @property
    def name(self) -> str:
        """What is done now, in words; empty once all is done."""
        return self.names[self.done] if self.done < self.of else ""

    @property
    def of(self) -> int:
        """Stages in all."""
        return len(self.names)


class _Course:
    """The stages of one computation, and who is told of them."""

    def __init__(self, tell: Callable[[Stage], None]) -> None:
        self.tell, self.now = tell, Stage((), 0)

    def move(self, stage: Stage) -> None:
        self.now = stage
        self.tell(stage)


_COURSE: ContextVar[_Course | None] = ContextVar("course of a computation", default=None)


@contextmanager
def followed(tell: Callable[[Stage], None]) -> Iterator[None]:
    """While it is computed within, `tell` is called at each stage, by the thread that computes."""
    token = _COURSE.set(_Course(tell))
    try:
        yield
    finally:
        _COURSE.reset(token)


@contextmanager
def stages(names: Sequence[str]) -> Iterator[None]:
    """What is computed within has these stages, in this order; `enter` begins each."""
    course = _COURSE.get()
    if course is not None:
        course.move(Stage(tuple(names), 0))
    yield
    if course is not None:
        course.move(Stage(tuple(names), len(names)))


def enter(name: str) -> None:
    """Begin a stage; those before it have ended, done or not needed."""
    course = _COURSE.get()
    if course is not None and name in course.now.names:
        course.move(replace(course.now, done=course.now.names.index(name), part=0.0))


def each(items: Sequence[T]) -> Iterable[T]:
    """The items, one after the other: of the stage that is under way, as much is done as of them."""
    for index, item in enumerate(items):
        course = _COURSE.get()
        if course is not None and index > 0:
            course.move(replace(course.now, part=index / len(items)))
        yield item
