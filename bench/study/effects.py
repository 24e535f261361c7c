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
    return [LeftOutEffect(package=x.package, entry_point=x.entry_point, reason=x.reason) for x in left_out()]


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
        trials=[
            ExampleTrial(
                load_kg=trial.load_kg,
                time_s=trial.time_s.tolist(),
                driver=trial.driver.tolist(),
                without=trial.without.tolist(),
                effect=trial.effect.tolist(),
            )
            for trial in found.trials
        ],
    )


def _effect(effect: lab.Effect) -> Effect:
    return Effect(
        name=effect.name,
        title=effect.title,
        physics=effect.physics,
        equation=effect.equation,
        parameters=[
            EffectParameter(
                name=parameter.name,
                unit=parameter.unit_in("effort", "position"),
                low=known(parameter.low),
                high=known(parameter.high),
            )
            for parameter in effect.parameters
        ],
        driver=effect.driver,
        channels=list(effect.channels),
        excited_by=effect.excited_by,
        confused_with=list(effect.confused_with),
        source=effect.source,
    )
