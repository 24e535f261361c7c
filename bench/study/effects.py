"""The catalogue of effects as JSON."""

from typing import Any

import numpy as np

from bench.store.errors import NotFoundError
from compensator.lab.effects.catalogue import catalogue
from compensator.lab.effects.effect import Effect
from compensator.lab.errors import UnknownEffectError
from compensator.lab.example import example_of


def effects_catalogue() -> list[dict[str, Any]]:
    """Every effect with its physics, equation, parameters, what excites it and what it is confused with."""
    return [_effect(effect) for effect in catalogue().values()]


def effect_example(name: str) -> dict[str, Any]:
    """What an effect adds to the effort of a simulated joint, for the page.

    Raises:
        NotFoundError: there is no such effect.
    """
    try:
        found = example_of(name)
    except UnknownEffectError as error:
        raise NotFoundError(str(error)) from error
    return {
        "effect": name,
        "motion": found.motion,
        "effort_unit": found.effort_unit,
        "driver": found.driver_title,
        "driver_unit": found.driver_unit,
        "trials": [
            {
                "load_kg": trial.load_kg,
                "time_s": trial.time_s.tolist(),
                "driver": trial.driver.tolist(),
                "without": trial.without.tolist(),
                "effect": trial.effect.tolist(),
            }
            for trial in found.trials
        ],
    }


def _effect(effect: Effect) -> dict[str, Any]:
    return {
        "name": effect.name,
        "title": effect.title,
        "physics": effect.physics,
        "equation": effect.equation,
        "parameters": [
            {
                "name": parameter.name,
                "unit": parameter.unit_in("effort", "position"),
                "low": parameter.low if np.isfinite(parameter.low) else None,
                "high": parameter.high if np.isfinite(parameter.high) else None,
            }
            for parameter in effect.parameters
        ],
        "driver": effect.driver,
        "channels": list(effect.channels),
        "excited_by": effect.excited_by,
        "confused_with": list(effect.confused_with),
        "source": effect.source,
    }
