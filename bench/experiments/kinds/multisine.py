"""Many sines of one period at once, their phases after Schroeder, followed as a position or given as a current."""

from functools import partial

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.errors import LimitError
from bench.experiments.kind import ExperimentKind, FinishedTrial
from bench.experiments.parts.injection import (
    RESTS_S,
    InjectionParameters,
    plan_injection,
    refuse_band,
    refuse_injection,
    summarise_injection,
)
from bench.experiments.parts.refusal import refuse_long_play
from bench.experiments.parts.signal_play import PLAYED_RESULTS
from bench.experiments.parts.waveforms import FADE_S, fade
from bench.json_types import Value
from compensator.lab.recordings.recording import FloatArray


class MultisineParameters(InjectionParameters):
    """Parameters of a multisine. Its frequencies are multiples of 1 / wave_s, spread evenly on a logarithmic scale."""

    tones: int = quantity(20, "", "Most frequencies in the band", ge=1, le=1000)
    wave_s: float = quantity(10.0, "s", "Period of the whole", gt=0, le=600)
    waves: int = quantity(3, "", "Periods that are played; fading in and out comes on top", ge=1, le=1000)

    @property
    def duration_s(self) -> float:
        """Of one trial, without the way there and back."""
        return self.waves * self.wave_s + 2.0 * FADE_S


def frequencies_hz(parameters: MultisineParameters) -> FloatArray:
    """The tones, rising, each once, shape (up to `tones`,); none where no multiple lies within the band."""
    low, high = parameters.low_hz * parameters.wave_s, parameters.high_hz * parameters.wave_s
    wanted = np.unique(np.rint(np.geomspace(low, high, parameters.tones)))
    return np.asarray(wanted[(wanted >= np.ceil(low)) & (wanted <= np.floor(high))] / parameters.wave_s)


def multisine(parameters: MultisineParameters, period_s: float) -> FloatArray:
    """The wave within -1 .. 1, one value per control period, shape (n,); faded in and out.

    Phases after Schroeder (1970): each tone has its group delay at its own share of the period, so that no peak stands
    much above the others. For multiples in a row they are his -pi k (k - 1) / N.
    """
    tones_hz = frequencies_hz(parameters)
    delays_s = parameters.wave_s * np.arange(1, len(tones_hz)) / len(tones_hz)
    phases = np.concatenate([[0.0], -2.0 * np.pi * np.cumsum(delays_s * np.diff(tones_hz))])
    time_s = np.arange(1, round(parameters.duration_s / period_s) + 1, dtype=np.float64) * period_s
    wave: FloatArray = np.zeros(len(time_s))
    for tone_hz, phase in zip(tones_hz, phases, strict=True):
        wave = wave + np.cos(2.0 * np.pi * tone_hz * (time_s - FADE_S) + phase)
    wave = wave * fade(time_s, parameters.duration_s)
    return np.asarray(wave / np.max(np.abs(wave)))


def _refuse(parameters: MultisineParameters, configuration: BenchConfiguration) -> None:
    refuse_long_play("waves x wave_s", parameters.duration_s)
    refuse_band(parameters, configuration)
    if not len(frequencies_hz(parameters)):
        raise LimitError(
            f"no multiple of 1 / wave_s, {1.0 / parameters.wave_s:g} Hz, lies within low_hz .. high_hz, "
            f"{parameters.low_hz:g} .. {parameters.high_hz:g} Hz; choose a longer wave_s or a wider band"
        )
    refuse_injection("multisine", multisine, parameters, configuration)


def _duration_s(parameters: MultisineParameters, _configuration: BenchConfiguration) -> float:
    return parameters.repeats * (parameters.duration_s + RESTS_S)


def _summarise(parameters: MultisineParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    return summarise_injection(parameters, trials) | {"tones_hz": frequencies_hz(parameters).tolist()}


KIND = ExperimentKind(
    name="multisine",
    title="Multisine",
    summary="Many sines at once, with phases that keep the peak low, followed as a position or given as a current; "
    "repeated, so that noise and what is not linear can be told apart.",
    parameters=MultisineParameters,
    plan=partial(plan_injection, "multisine", multisine),
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results=PLAYED_RESULTS,
    modes=MultisineParameters.modes,
)
