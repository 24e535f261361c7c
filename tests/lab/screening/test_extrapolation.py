"""A filter of the effort keeps its evidence where the position is noisy, and noise that looks like one loses it."""

import numpy as np
import pytest
from scipy.signal import lfilter

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.extrapolation import kept_without_noise
from compensator.lab.screening.gathering import gather, with_noise
from tests.lab.synthetic import FACTS, Bench, Plan, plans, recordings

TIME_S = 0.03
SLOW = [Plan(f"slow-{at}", [(1.0, 0.05 + 0.01 * at, at)], load_kg=0.1 * (at % 2)) for at in range(4)]


def filtered(made):
    """The same, the torque through a low-pass of first order."""
    for one in made:
        torque, step_s = one.channels["torque_n_m"], np.diff(one.channels["time_s"][:2])[0]
        kept = np.exp(-step_s / TIME_S)
        torque[:] = torque[0] + lfilter([1.0 - kept], [1.0, -kept], torque - torque[0])
    return made


def of_uneven_age(made, oldest_s):
    """The same, each position up to so old."""
    random = np.random.default_rng(5)
    for one in made:
        time_s, position = one.channels["time_s"], one.channels["position_rad"]
        position[:] = np.interp(time_s - random.uniform(0.0, oldest_s, len(time_s)), time_s, position.copy())
    return made


def kept(made, *more):
    """Share of the evidence for a filter that is left without noise of the position, beside more effects."""
    fit = fit_model(make_dataset(made, FACTS, Processing()), [*default_effects(FACTS), *more])
    gathered = with_noise(gather(fit))
    evidence = gathered.screened([block for block in gathered.named if block.name == "effort_filter"]).evidence
    return kept_without_noise(gathered, evidence[0])


def test_a_true_filter_keeps_its_evidence_behind_a_coarse_encoder():
    """Rows weigh by acceleration and jerk, too: those of slow trials are of counts alone, and count as before."""
    bench = Bench(rate_hz=500.0, quantum=2.0 * np.pi / 4096.0, noise=0.002)
    assert kept(filtered(recordings(bench=bench, trials=[*plans()[:6], *SLOW]))) > 0.9


@pytest.mark.parametrize("oldest_s", [1e-3, 2e-3])
def test_what_smooths_noise_loses_half_of_its_evidence(oldest_s):
    bench = Bench(rate_hz=125.0, quantum=0.0, noise=0.001)
    assert kept(of_uneven_age(recordings(bench=bench, trials=plans()), oldest_s), "measurement_delay") < 0.55
