"""Effects that other packages offer, each taken by itself: one that is broken is left out, and nothing with it."""

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, wraps
from importlib.metadata import EntryPoint, entry_points
from typing import ParamSpec, TypeVar, get_args

from compensator.lab.effects.effect import Effect, MotionRows
from compensator.lab.errors import EffectFailedError

P = ParamSpec("P")
T = TypeVar("T")
ENTRY_POINT_GROUP = "friction_bench.effects"
LONGEST = 300  # characters of what another package says
FAULTS = (Exception, SystemExit)
_TEXTS = ("name", "title", "physics", "equation", "driver", "excited_by", "source")
_log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class LeftOut:
    """An effect that is offered, and not taken.

    Attributes:
        package: that offers it, with its version.
        entry_point: as the package names it.
        reason: in words.
    """

    package: str
    entry_point: str
    reason: str


@dataclass(frozen=True, slots=True)
class Offered:
    """What other packages offer.

    Attributes:
        effects: by name.
        left_out: what is broken.
    """

    effects: dict[str, Effect]
    left_out: tuple[LeftOut, ...]


@cache
def offered_beside(taken: frozenset[str]) -> Offered:
    """The effects of installed packages whose names are not taken yet; why others are left out is logged."""
    effects: dict[str, Effect] = {}
    left_out = []
    for point in entry_points(group=ENTRY_POINT_GROUP):
        try:
            effect = _loaded(point)
            if effect.name in taken or effect.name in effects:
                raise EffectFailedError(f"there is an effect '{effect.name}' already; give it another name")
            effects[effect.name] = effect
        except FAULTS as fault:
            found = LeftOut(_package(point), f"{point.name} = {point.value}", _in_words(fault))
            left_out.append(found)
            _log.warning("effect %s of %s is left out: %s", found.entry_point, found.package, found.reason)
    return Offered(effects, tuple(left_out))


def _loaded(point: EntryPoint) -> Effect:
    effect = point.load()
    if not isinstance(effect, Effect):
        raise EffectFailedError(f"it is of type {type(effect).__name__}; wanted is an Effect")
    empty = [name for name in _TEXTS if not isinstance(getattr(effect, name), str) or not getattr(effect, name)]
    if empty:
        raise EffectFailedError(f"its {empty[0]} is {getattr(effect, empty[0])!r}; wanted is a text")
    if effect.rows not in get_args(MotionRows):
        wanted = " or ".join(get_args(MotionRows))
        raise EffectFailedError(
            f"its rows are '{effect.rows}'; wanted is {wanted}, and `breakaway` for starts from rest"
        )
    for parameter in effect.parameters:
        parameter.unit_in("N m", "rad")
    return _guarded(replace(effect, offered_by=_package(point)))


def _guarded(effect: Effect) -> Effect:
    """The same; what goes wrong in it is told in its name."""

    def guarded(function: Callable[P, T]) -> Callable[P, T]:
        @wraps(function)
        def called(*args: P.args, **kwargs: P.kwargs) -> T:
            try:
                return function(*args, **kwargs)
            except EffectFailedError:
                raise
            except FAULTS as fault:
                raise EffectFailedError(f"{effect.in_full} failed: {_in_words(fault)}") from fault

        return called

    share = effect.breakaway
    return replace(
        effect,
        columns=guarded(effect.columns),
        shapes=guarded(effect.shapes),
        shape_over=effect.shape_over and guarded(effect.shape_over),
        slope=effect.slope and guarded(effect.slope),
        discrepancy=effect.discrepancy and guarded(effect.discrepancy),
        misreads=effect.misreads and guarded(effect.misreads),
        breakaway=share and replace(share, columns=guarded(share.columns), shapes=guarded(share.shapes)),
    )


def _package(point: EntryPoint) -> str:
    return f"{point.dist.name} {point.dist.version}" if point.dist is not None else point.module


def _in_words(fault: BaseException) -> str:
    """One line, which shows no control signs: it comes from outside."""
    if isinstance(fault, EffectFailedError):
        return str(fault)
    said = f"it ends the program ({fault})" if isinstance(fault, SystemExit) else f"{type(fault).__name__}: {fault}"
    return "".join(sign if sign.isprintable() else " " for sign in said)[:LONGEST]
