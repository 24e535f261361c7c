"""What follows a variable is told by the noise of all rows; what is of one moment, or noise, is not."""

import numpy as np
import pytest

from compensator.lab.effects.catalogue import withheld
from compensator.lab.left_over import following, white_rows
from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.following import Following, following_of
from compensator.lab.left_over.left_over import left_over, unexplained_in_words
from compensator.lab.left_over.white_rows import WhiteRows
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.gathering import gather, with_noise
from tests.lab.left_over.judged import fitted, white_rows_of
from tests.lab.synthetic import FACTS

DRAG_N_M_S_RAD = 0.003  # more one way than the other: a tenth of viscous friction


def found(fit: Fit, most: float = PLAIN.following) -> Following | None:
    gathered = with_noise(gather(fit))
    return following_of(gathered, white_rows_of(gathered), most)


@pytest.mark.parametrize("seed", range(4))
def test_noise_follows_nothing(seed):
    assert found(fitted(seed=seed)) is None


def test_what_differs_by_direction_of_speed_follows_the_velocity():
    with withheld(["viscous_asymmetry"]):
        gathered = with_noise(gather(fitted(lambda x: DRAG_N_M_S_RAD * np.abs(x.v))))
    left = left_over(gathered)
    assert left.is_more_than_noise
    assert left.following is not None
    assert left.following.driver.startswith("velocity")
    assert f"it varies with {left.following.driver}, most" in unexplained_in_words(left, None, 0.1, 40, FACTS)


def test_less_sure_curves_are_told_where_more_of_chance_is_allowed():
    fit = fitted(lambda x: DRAG_N_M_S_RAD * np.abs(x.v))
    gathered = with_noise(gather(fit))
    white = white_rows_of(gathered)
    told = following_of(gathered, white)
    assert told is not None
    assert following_of(gathered, white, 0.5 * told.chance, 0.0) is None
    assert following_of(gathered, white, 2.0 * told.chance) == told


MOST_IF_LARGE = 1e-3  # chance


def asymmetric(n_m_s_rad: float, seed: int) -> tuple[Candidates, WhiteRows]:
    """Drag that is more one way than the other, as if the catalogue had no name for it."""
    with withheld(["viscous_asymmetry"]):
        gathered = with_noise(gather(fitted(lambda x: n_m_s_rad * np.abs(x.v), seed)))
    return gathered, white_rows_of(gathered)


def test_less_sure_curves_are_told_where_they_are_more_than_the_joints_own(monkeypatch):
    given = asymmetric(0.0015, seed=2)
    told = following_of(*given, most_if_large=MOST_IF_LARGE)
    assert told is not None
    assert PLAIN.following < told.chance <= MOST_IF_LARGE
    monkeypatch.setattr(white_rows, "LEAST_OF_FRICTION", 1.0)
    assert following_of(*given, most_if_large=MOST_IF_LARGE) is None


def test_a_curve_does_not_hide_itself_in_noise_that_is_learnt_with_it(monkeypatch):
    given = asymmetric(0.0015, seed=0)
    assert following_of(*given, most_if_large=MOST_IF_LARGE, look_again=0.0) is None
    told = following_of(*given, most_if_large=MOST_IF_LARGE)
    assert told is not None
    assert told.driver.startswith("velocity")
    monkeypatch.setattr(white_rows, "LEAST_OF_FRICTION", 1.0)
    assert following_of(*given, most_if_large=MOST_IF_LARGE) is None


def test_what_comes_in_one_stretch_alone_follows_nothing(monkeypatch):
    hit = iter([True])

    def extra(x):
        here = (x.time_s > 2.0) & (x.time_s < 4.0) & next(hit, False)
        return 0.01 * here * np.cos(3.0 * x.q)

    fit = fitted(extra)
    assert found(fit, 1.0) is None
    monkeypatch.setattr(following, "FORETOLD", -np.inf)
    assert found(fit, 1.0) is not None


def test_without_known_noise_nothing_of_the_kind_is_asked():
    left = left_over(gather(fitted(lambda x: DRAG_N_M_S_RAD * np.abs(x.v))))
    assert left.line is None
    assert left.following is None


def test_a_model_with_more_than_every_joint_has_is_not_asked():
    """What a named formula leaves, since it is nearly right, is not said to remain."""
    fit = fitted(lambda x: DRAG_N_M_S_RAD * np.abs(x.v))
    asked, not_asked = (
        left_over(with_noise(gather(one))) for one in (fit, fit_model(fit.dataset, [*fit.names, "spring"]))
    )
    assert asked.following is not None
    assert not_asked.following is None


def test_what_only_the_measuring_chain_has_makes_no_difference():
    fit = fitted(lambda x: DRAG_N_M_S_RAD * np.abs(x.v))
    left = left_over(with_noise(gather(fit_model(fit.dataset, [*fit.names, "measurement_delay"]))))
    assert left.following is not None
