"""A coefficient of friction that varies is told, beside a name that imitates it, too; a load weighed wrongly is not."""

import numpy as np
import pytest

from compensator.lab.effects.catalogue import withheld
from compensator.lab.left_over import varying, white_rows
from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.left_over import left_over, unexplained_in_words
from compensator.lab.left_over.varying import Varying, varying_of
from compensator.lab.model.fit import fit_effects
from compensator.lab.model.fitted import Fit
from compensator.lab.screening.gathering import gather, with_noise
from tests.lab.left_over.judged import fitted, white_rows_of
from tests.lab.synthetic import FACTS

THINNING_N_M_S_RAD_K = -0.0005  # a sixtieth of viscous friction a kelvin
IMITATION = "coulomb_temperature"


def thinning(n_m_s_rad_k: float = THINNING_N_M_S_RAD_K, seed: int = 0) -> Fit:
    """A lubricant whose drag falls as it warms; no dry friction does."""
    return fitted(lambda x: n_m_s_rad_k * (x.temperature_c - 32.0) * x.v, seed)


def found(fit: Fit, most: float = PLAIN.varying) -> Varying | None:
    with withheld(["viscous_temperature"]):
        gathered = with_noise(gather(fit))
    return varying_of(gathered, white_rows_of(gathered), most)


@pytest.mark.parametrize("seed", range(4))
def test_noise_varies_with_nothing(seed):
    fit = fitted(seed=seed)
    assert found(fit) is None


def test_a_lubricant_that_thins_is_told_as_friction_that_varies_with_temperature():
    with withheld(["viscous_temperature"]):
        left = left_over(with_noise(gather(thinning())))
    assert left.is_more_than_noise
    assert left.varying is not None
    assert (left.varying.effect, left.varying.condition) == ("Viscous friction", "temperature")
    assert left.varying.chance <= PLAIN.varying


def test_it_is_said_where_no_curve_is():
    with withheld(["viscous_temperature"]):
        left = left_over(with_noise(gather(thinning(0.4 * THINNING_N_M_S_RAD_K))))
    assert left.following is None
    sentence = unexplained_in_words(left, "velocity", 0.1, 40, FACTS)
    assert "it has the form of viscous friction that varies with temperature. Repeat" in sentence


def test_the_effect_itself_leaves_no_such_thing():
    fit = thinning()
    assert found(fit_effects(fit.dataset, [*fit.names, "viscous_temperature"], fit.training)) is None


def test_a_load_that_was_weighed_wrongly_is_none(monkeypatch):
    fit = fitted(lambda x: 0.05 * x.weight_n_m * np.sin(x.q) * (x.load_kg > 0.2))
    assert found(fit) is None
    monkeypatch.setattr(varying, "FRICTION", ("gravity",))
    assert found(fit) is not None


def test_what_is_next_to_nothing_beside_dry_friction_is_none(monkeypatch):
    fit = thinning()
    assert found(fit) is not None
    monkeypatch.setattr(white_rows, "LEAST_OF_FRICTION", 1.0)
    assert found(fit) is None
