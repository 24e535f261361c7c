"""The catalogue of effects as JSON."""

from typing import Any

import numpy as np

from compensator.lab.catalogue import catalogue
from compensator.lab.effects.effect import Effect


def effects_catalogue() -> list[dict[str, Any]]:
    """Every effect with its physics, equation, parameters, what excites it and what it is confused with."""
    return [_effect(effect) for effect in catalogue().values()]


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
