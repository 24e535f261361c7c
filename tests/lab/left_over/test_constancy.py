"""What is another one in each stretch is told from noise, and from what comes again in every trial."""

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.left_over.constancy import _change, change_of, inflation_of
from compensator.lab.left_over.constants import DRY_FRICTION, OFFSET
from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.base import Base
from tests.lab.left_over.judged import constants_of
from tests.lab.synthetic import FACTS, Bench, Joint, plans, recordings

JUMP_N_M = 0.02


def fitted(extra=None, seed=0, **bench):
    made = recordings(Joint(extra=extra), Bench(**{"duration_s": 9.0, **bench}), plans(), seed)
    return fit_model(make_dataset(made, FACTS, Processing(cutoff_hz=6.0)), default_effects(FACTS))


def change(fit):
    return change_of(constants_of(fit))


def jumping(of):
    """Jumps to one of two values at a moment that differs from trial to trial."""
    random = np.random.default_rng(5)

    def extra(x):
        at_s, size = random.uniform(2.0, 7.0), random.choice([-JUMP_N_M, JUMP_N_M])
        return size * np.where(x.time_s > at_s, 1.0, -1.0) * of(x)

    return extra


def test_the_base_is_fitted_anew_beside_the_stretches_as_least_squares_would():
    random = np.random.default_rng(3)
    rows, of = 600, 6
    stretch, time = np.arange(rows) * of // rows, np.linspace(-1.0, 1.0, rows)
    column = np.sign(np.sin(40.0 * time))
    base_columns = np.column_stack([column, time * column, time])  # the first is the sum of the stretches' own
    effort = 0.5 * time * column + random.choice([-0.3, 0.3], of)[stretch] * column + 0.1 * random.normal(size=rows)
    cut = column[:, None] * (stretch[:, None] == np.arange(of))
    dense = np.column_stack([base_columns, cut])
    after = effort - dense @ np.linalg.lstsq(dense, effort, rcond=None)[0]
    base, power = Base.of(base_columns, effort), float(effort @ effort)
    noise = inflation_of(after) * float(after @ after) / (rows - of + 1 - 3)
    explained = float(base.residual @ base.residual - after @ after)
    moments = (np.arange(rows) // 10, np.repeat(np.arange(of), rows // of // 10), 0.5 * np.tile(np.arange(10.0), of))
    found = _change(OFFSET, base, column, stretch, of, power, moments)
    assert found is not None
    assert found.share == pytest.approx(np.sqrt((explained - (of - 1) * noise) / power), rel=1e-9)


@pytest.mark.parametrize("noise_memory", [0.0, 0.8])
@pytest.mark.parametrize("seed", range(3))
def test_noise_of_any_colour_changes_nothing(seed, noise_memory):
    assert change(fitted(seed=seed, noise_memory=noise_memory)) is None


@pytest.mark.parametrize(
    ("what", "of"),
    [(DRY_FRICTION, lambda x: np.sign(x.v)), (OFFSET, lambda x: np.ones_like(x.v))],
    ids=["dry", "offset"],
)
def test_what_jumps_is_told_by_its_name_and_size(what, of):
    fit = fitted(jumping(of))
    found = change(fit)
    assert found is not None
    assert found.what == what
    effort = fit.dataset.effort[fit.training]
    assert found.share == pytest.approx(JUMP_N_M / float(np.sqrt(np.mean(effort**2))), rel=0.4)
    answer = diagnose(fit)
    assert answer.remains
    assert f"{what} changes from one stretch of 2 s to the next" in answer.sentence


def test_what_follows_the_motion_is_no_change():
    assert change(fitted(lambda x: 0.01 * np.sin(5.0 * x.q))) is None


def test_less_than_is_worth_saying_is_not_told():
    def jumps(share):
        return change(fitted(lambda x: share * jumping(lambda y: np.sign(y.v))(x), noise=1e-4))

    assert jumps(0.005) is None  # 0.1 % of dry friction, in next to no noise
    assert jumps(0.05) is None  # 1.25 % of it, and little of all that the motor gives
    assert jumps(0.3) is not None


def stroke_by_stroke(of):
    """Static friction that is another one after each stop, by 5 %, or all of dry friction that is."""
    random = np.random.default_rng(11)

    def extra(x):
        stroke = np.cumsum(np.diff(np.sign(x.v), prepend=0.0) != 0.0)
        scatter = 0.05 * random.standard_normal(stroke.max() + 1)
        return scatter[stroke] * of(x) * np.sign(x.v)

    return extra


def test_static_friction_that_differs_from_stop_to_stop_is_no_change():
    def falling(x):
        return 0.12 * np.exp(-np.abs(x.v) / 0.25)

    assert change(fitted(stroke_by_stroke(falling), noise=1e-3)) is None
    assert change(fitted(stroke_by_stroke(lambda x: 0.12), noise=1e-3)) is not None
