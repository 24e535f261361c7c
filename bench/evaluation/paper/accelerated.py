"""Accelerated motion, which the paper leaves for later: a sinusoid under one load, inertia and reversals included."""

from math import pi

import numpy as np

from bench.config.reflected_load import load_current_a
from bench.config.rig import Rig
from bench.evaluation.paper.row import Row, ids_of
from bench.report import Figure, Line, Section
from bench.store import Experiment, Store

SHOWN_PERIODS = 2.0
CHANNELS = ("time_s", "position_rad", "current_a", "current_estimate_a", "current_load_a")


def accelerated(store: Store, experiment: Experiment) -> Row:
    """The row: what is reflected over time, and the errors of the whole."""
    trials, results = store.trials(experiment.id), experiment.results
    parameters = experiment.parameters
    ours = {
        "rms_error_g": 1e3 * results["rms_error_kg"],
        "uncompensated_rms_error_g": 1e3 * results["uncompensated_rms_error_kg"],
        "rms_ratio": results["rms_ratio"],
        "share_within_interval": results["in_band"],
    }
    section = Section(
        title="Beyond the paper: accelerated motion and reversals",
        sentences=[
            f"{1e3 * parameters['load_kg']:g} g in a sinusoid of {parameters['frequency_hz']:g} Hz and "
            f"{180.0 / pi * parameters['amplitude_rad']:.0f} degrees either way; the paper calls this future work. The "
            f"rms error is {ours['rms_error_g']:.2f} g at 90 degrees, uncompensated "
            f"{ours['uncompensated_rms_error_g']:.1f} g. The stated 95 % interval holds the load in "
            f"{100.0 * ours['share_within_interval']:.0f} % of the cycles."
        ],
        figures=[_figure(store, trials[0].id, experiment)],
    )
    return Row("accelerated", section, dict(ours), {}, (experiment.id,), ids_of(trials))


def _figure(store: Store, trial_id: int, experiment: Experiment) -> Figure:
    """The last periods of a trial."""
    samples, rig, load_kg = (
        store.samples(trial_id, CHANNELS),
        Rig.model_validate(experiment.rig),
        experiment.parameters["load_kg"],
    )
    time_s = samples["time_s"]
    told = np.flatnonzero(np.isfinite(samples["current_load_a"]))
    end = int(told[-1]) + 1
    shown = slice(
        int(np.searchsorted(time_s, time_s[end - 1] - SHOWN_PERIODS / experiment.parameters["frequency_hz"])), end
    )
    measured = samples["current_a"]
    plain_a = np.where(np.isfinite(measured), measured, samples["current_estimate_a"])
    truth_a = np.array([load_current_a(load_kg, angle_rad, rig) for angle_rad in samples["position_rad"][shown]])
    at_s = (time_s[shown] - time_s[shown][0]).tolist()

    def ma(current_a: np.ndarray[tuple[int], np.dtype[np.float64]]) -> list[float]:
        return [1e3 * value for value in current_a.tolist()]

    return Figure(
        "Current of the load in a sinusoid",
        "time [s]",
        "current [mA]",
        [
            Line("uncompensated", at_s, ma(plain_a[shown])),
            Line("compensated", at_s, ma(samples["current_load_a"][shown])),
            Line("of the weight that hangs there", at_s, ma(truth_a), dashed=True),
        ],
    )
