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
        within: what of that stage is done now, where it has stages of its own; else empty.
    """

    names: tuple[str, ...]
    done: int
    part: float = 0.0
    within: str = ""

    @property
    def name(self) -> str:
        """What is done now, in words; empty once all is done."""
        return self.names[self.done] if self.done < self.of else ""

    @property
    def of(self) -> int:
        """Stages in all."""
        return len(self.names)


class _Course:
    """The stages of one computation, those within each other last, and who is told of the outer ones."""

    def __init__(self, tell: Callable[[Stage], None]) -> None:
        self.tell = tell
        self.levels: list[Stage] = []
        self.is_counting = False

    def begin(self, names: Sequence[str]) -> None:
        self.levels.append(Stage(tuple(names), 0))
        self._told()

    def move(self, stage: Stage) -> None:
        if self.levels:
            self.levels[-1] = stage
            self._told()

    def end(self) -> None:
        stage = self.levels[-1]
        self.move(Stage(stage.names, stage.of))
        self.levels.pop()

    def _told(self) -> None:
        outer, *inner = self.levels
        if inner:
            here = inner[0]  # a third level would be too much to be told of
            # what has stages more than once within one of the outer ones does not fall back
            part = max(outer.part, (here.done + here.part) / max(here.of, 1))
            outer = self.levels[0] = replace(outer, part=part, within=here.name)
        self.tell(outer)


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
    """What is computed within has these stages, in this order; `enter` begins each. Also as a decorator.

    Within a stage of something larger they are the parts of that stage.
    """
    course = _COURSE.get()
    if course is None:
        yield
        return
    depth = len(course.levels)
    course.begin(names)
    try:
        yield
        course.end()
    finally:
        del course.levels[depth:]


def enter(name: str) -> None:
    """Begin a stage; those before it have ended, done or not needed. What has ended does not begin again."""
    course = _COURSE.get()
    if course is None or not course.levels:
        return
    now = course.levels[-1]
    if name in now.names[now.done + 1 :]:
        course.move(Stage(now.names, now.names.index(name)))


def each(items: Sequence[T]) -> Iterable[T]:
    """The items, one after the other: of the stage that is under way, as much is done as of them."""
    course = _COURSE.get()
    if course is None or course.is_counting:
        yield from items
        return
    course.is_counting = True
    try:
        for index, item in enumerate(items):
            if index > 0 and course.levels:
                course.move(replace(course.levels[-1], part=index / len(items)))
            yield item
    finally:
        course.is_counting = False
