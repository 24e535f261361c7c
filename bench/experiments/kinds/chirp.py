"""A sine whose frequency rises through a band, followed as a position or given as a current."""

from functools import partial
from typing import Literal

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.experiments.kind import ExperimentKind
from bench.experiments.parts.injection import (
    RESTS_S,
    InjectionParameters,
    plan_injection,
    refuse_injection,
    summarise_injection,
)
from bench.experiments.parts.signal_play import PLAYED_RESULTS
from bench.experiments.parts.waveforms import fade
from compensator.lab.recordings.recording import FloatArray


class ChirpParameters(InjectionParameters):
    """Parameters of a chirp."""

    duration_s: float = quantity(20.0, "s", "Length of the chirp", ge=2, le=3600)
    spacing: Literal["logarithmic", "linear"] = quantity("logarithmic", "", "How the frequency rises")


def chirp(parameters: ChirpParameters, period_s: float) -> FloatArray:
    """The wave within -1 .. 1, one value per control period, shape (n,); it begins and ends at rest."""
    duration_s, low_hz, high_hz = parameters.duration_s, parameters.low_hz, parameters.high_hz
    time_s = np.arange(1, round(duration_s / period_s) + 1, dtype=np.float64) * period_s
    if parameters.spacing == "linear":
        cycles = low_hz * time_s + (high_hz - low_hz) * time_s**2 / (2.0 * duration_s)
    else:
        growth = np.log(high_hz / low_hz)
        cycles = low_hz * duration_s / growth * np.expm1(growth * time_s / duration_s)
    return np.asarray(np.sin(2.0 * np.pi * cycles) * fade(time_s, duration_s))


def _duration_s(parameters: ChirpParameters, _configuration: BenchConfiguration) -> float:
    return parameters.repeats * (parameters.duration_s + RESTS_S)


KIND = ExperimentKind(
    name="chirp",
    title="Chirp",
    summary="A sine that rises through a band of frequencies, followed as a position or given as a current. It shows "
    "inertia, elasticity and delay, frequency by frequency.",
    parameters=ChirpParameters,
    plan=partial(plan_injection, "chirp", chirp),
    refuse=partial(refuse_injection, "chirp", chirp),
    duration_s=_duration_s,
    summarise=summarise_injection,
    results=PLAYED_RESULTS,
    modes=ChirpParameters.modes,
)
