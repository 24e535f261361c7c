"""The catalogue of effects, and a small simulated example of each."""

from bench.json_types import known
from bench.store.errors import NotFoundError
from bench.study.models.effects import Effect, EffectParameter, Example, ExampleTrial, LeftOutEffect
from compensator.lab.effects import effect as lab
from compensator.lab.effects.catalogue import catalogue, left_out
from compensator.lab.errors import UnknownEffectError
from compensator.lab.example import example_of


def effects_catalogue() -> list[Effect]:
    """Every effect with its physics, equation, parameters, what excites it and what it is confused with."""
    return [_effect(effect) for effect in catalogue().values()]


def effects_left_out() -> list[LeftOutEffect]:
    """What installed packages offer and is broken, each with the reason."""
    return list(map(LeftOutEffect.model_validate, left_out()))


def effect_example(name: str) -> Example:
    """What an effect adds to the effort of a simulated joint, for the page.

    Raises:
        NotFoundError: there is no such effect.
    """
    try:
        found = example_of(name)
    except UnknownEffectError as error:
        raise NotFoundError(str(error)) from error
    return Example(
        effect=name,
        motion=found.motion,
        effort_unit=found.effort_unit,
        driver=found.driver_title,
        driver_unit=found.driver_unit,
        trials=list(map(ExampleTrial.model_validate, found.trials)),
    )


def _effect(effect: lab.Effect) -> Effect:
    parameters = [
        EffectParameter(name=one.name, unit=one.unit_in("effort", "position"), low=known(one.low), high=known(one.high))
        for one in effect.parameters
    ]
    return Effect.model_validate(
        {name: getattr(effect, name) for name in Effect.model_fields} | {"parameters": parameters}
    )
