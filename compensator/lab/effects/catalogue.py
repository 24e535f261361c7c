"""The catalogue of effects: ours, and those that other packages offer as entry points."""

import difflib
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache

from compensator.lab.effects import free_curve
from compensator.lab.effects.effect import Effect
from compensator.lab.effects.electrical import (
    back_emf_error,
    cogging,
    cogging_orders,
    current_gain_asymmetry,
    dead_time,
    effort_filter,
    encoder_eccentricity,
    measurement_delay,
    motor_warm_up,
    supply_sag,
    torque_constant_saturation,
    winding_temperature,
)
from compensator.lab.effects.friction.load import (
    back_driving_friction,
    coulomb_quadrant,
    load_friction,
    load_friction_quadratic,
    weight_friction,
    weight_stribeck,
)
from compensator.lab.effects.friction.memory import (
    dwell_strengthening,
    frictional_lag,
    pre_sliding,
    rate_dependent_breakaway,
)
from compensator.lab.effects.friction.position import position_periodic_friction
from compensator.lab.effects.friction.speed import (
    coulomb,
    coulomb_asymmetry,
    stribeck,
    viscous,
    viscous_asymmetry,
    viscous_power,
    viscous_quadratic,
)
from compensator.lab.effects.friction.temperature import coulomb_temperature, viscous_temperature, warm_up
from compensator.lab.effects.mechanics import (
    backlash,
    centre_of_mass_angle,
    elasticity,
    gravity,
    hardening_spring,
    inertia,
    measured_load,
    offset,
    spring,
)
from compensator.lab.effects.offered import LeftOut, offered_beside
from compensator.lab.errors import UnknownEffectError
from compensator.lab.recordings.facts import Facts

_OURS = (
    inertia,
    gravity,
    measured_load,
    offset,
    coulomb,
    viscous,
    stribeck,
    coulomb_asymmetry,
    viscous_asymmetry,
    viscous_quadratic,
    viscous_power,
    load_friction,
    load_friction_quadratic,
    weight_friction,
    weight_stribeck,
    back_driving_friction,
    coulomb_quadrant,
    coulomb_temperature,
    viscous_temperature,
    warm_up,
    position_periodic_friction,
    cogging,
    cogging_orders,
    spring,
    hardening_spring,
    centre_of_mass_angle,
    torque_constant_saturation,
    winding_temperature,
    motor_warm_up,
    pre_sliding,
    backlash,
    frictional_lag,
    dwell_strengthening,
    rate_dependent_breakaway,
    elasticity,
    measurement_delay,
    effort_filter,
    encoder_eccentricity,
    current_gain_asymmetry,
    dead_time,
    supply_sag,
    back_emf_error,
)


@cache
def catalogue() -> dict[str, Effect]:
    """Every known effect by name; ours first, then those of installed packages."""
    ours = {module.EFFECT.name: module.EFFECT for module in _OURS}
    return ours | offered_beside(frozenset(ours)).effects


def left_out() -> tuple[LeftOut, ...]:
    """What installed packages offer and is not in the catalogue."""
    return offered_beside(frozenset(module.EFFECT.name for module in _OURS)).left_out


@cache
def chain_effects() -> frozenset[str]:
    """Names of the effects of the measuring chain."""
    return frozenset(name for name, effect in catalogue().items() if effect.pipeline)


def effect_named(name: str) -> Effect:
    """The effect of this name: of the catalogue, or a provisional curve over a variable (`free_curve`).

    Raises:
        UnknownEffectError: there is none; the message lists near names.
    """
    known = catalogue()
    if name in known:
        return known[name]
    if (curve := free_curve.free_curve(name)) is not None:
        return curve
    near = difflib.get_close_matches(name, [*known, *free_curve.known()], n=3)
    hint = f"known are for instance: {', '.join(near)}" if near else "install the package that offers it"
    raise UnknownEffectError(f"effect '{name}' is not in the catalogue; {hint}; `friction-bench effects` lists all")


def default_effects(facts: Facts, load_is_measured: bool = False) -> tuple[str, ...]:
    """The model a study starts from: rigid joint with the General Kinetic Friction of eq. (2).

    Args:
        facts: of the joint.
        load_is_measured: a torque sensor tells the load in every trial, weight and all.
    """
    weightless = facts.horizontal or facts.joint == "linear"
    load = ("measured_load",) if load_is_measured else () if weightless else ("gravity",)
    return ("inertia", *load, "offset", "coulomb", "viscous", "stribeck")


_WITHHELD: ContextVar[frozenset[str]] = ContextVar("withheld", default=frozenset())


@contextmanager
def withheld(names: Iterable[str]) -> Iterator[None]:
    """Within this, effects of these names are no candidates: what would the lab say if nobody had written them yet?"""
    token = _WITHHELD.set(_WITHHELD.get() | frozenset(names))
    try:
        yield
    finally:
        _WITHHELD.reset(token)


def candidates(present: Sequence[str], facts: Facts) -> list[Effect]:
    """Effects of the catalogue that a model does not have yet and that this joint can have."""
    impossible = {"measured_load"} if "gravity" in present else set()  # it holds the weight
    unknown = {*present, *impossible, *_WITHHELD.get()}
    weightless = facts.horizontal or facts.joint == "linear"
    possible = [e for name, e in catalogue().items() if name not in unknown and not (e.by_angle and weightless)]
    return [effect for effect in possible if set(effect.after) <= set(present)]
