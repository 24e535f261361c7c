"""What is told to be left must hold without rows that a reversal reaches through the filter."""

from types import SimpleNamespace

import numpy as np
import pytest

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.left_over import left_over as module
from compensator.lab.left_over.left_over import left_for_sure
from compensator.lab.model.fit import fit_model
from compensator.lab.recordings.regimes import within_spread
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.gathering import gather_curves, with_noise
from tests.lab.synthetic import FACTS, Bench, Joint, plans, recordings


def fitted(cutoff_hz, extra=None):
    made = recordings(Joint(extra=extra), Bench(duration_s=6.0), plans())
    return fit_model(make_dataset(made, FACTS, Processing(cutoff_hz=cutoff_hz)), default_effects(FACTS))


def reached(dataset):
    """Rows that are said to be reached, of each trial."""
    slow, cutoff_hz = dataset.scales.slow, dataset.cutoff_hz
    signals = [(trial.signals, trial.picked) for trial in dataset.trials]
    return np.concatenate([within_spread(s.velocity, slow, s.rate_hz, cutoff_hz)[picked] for s, picked in signals])


@pytest.fixture
def told_near_reversals(monkeypatch):
    """Something is left wherever rows near reversals are looked at; the rows of each look are kept."""
    looks = []

    def left_over(gathered):
        looks.append(gathered.rows)
        return SimpleNamespace(is_more_than_noise=bool((gathered.rows & reached(gathered.fit.dataset)).any()))

    monkeypatch.setattr(module, "left_over", left_over)
    return looks


def test_what_is_left_of_reversals_alone_is_not_told(told_near_reversals):
    fit = fitted(14.0)
    assert left_for_sure(fit, with_noise(gather_curves(fit))) is None
    first, second = told_near_reversals
    assert (second == (first & ~reached(fit.dataset))).all()
    assert second.sum() > 0.8 * first.sum()


def test_where_the_filter_spreads_a_reversal_over_most_of_a_stroke_the_first_look_counts(told_near_reversals):
    fit = fitted(4.0)
    assert left_for_sure(fit, with_noise(gather_curves(fit))) is not None
    assert len(told_near_reversals) == 1


def test_what_holds_without_these_rows_is_told():
    fit = fitted(14.0, lambda x: 0.02 * np.sign(x.time_s - 3.0) * np.sign(x.v))
    left = left_for_sure(fit, with_noise(gather_curves(fit)))
    assert left is not None
    assert left.change is not None
    nothing = fitted(14.0)
    assert left_for_sure(nothing, with_noise(gather_curves(nothing))) is None
