"""What candidates are judged on: the model, tangents of its shapes, and what the measuring chain produces."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.effects.catalogue import candidates, catalogue, default_effects, effect_named
from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening import gathering
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.gathering import gather, with_noise
from compensator.lab.screening.nuisance import nuisance_columns
from tests.lab.synthetic import FACTS, recordings

DEFAULT = default_effects(FACTS)


@pytest.fixture(scope="module")
def gathered() -> Candidates:
    return gather(fit_model(make_dataset(recordings(seed=3), FACTS, Processing()), DEFAULT))


def left_share(gathered: Candidates, columns: np.ndarray, base: int = 0) -> float:
    """Share of columns (N,) that a base does not hold."""
    weighted = columns[gathered.rows] * gathered.weights
    basis = gathered.bases[base].basis
    return float(np.linalg.norm(weighted - basis @ (basis.T @ weighted)) / np.linalg.norm(weighted))


def test_a_small_error_of_a_fitted_shape_is_no_evidence(gathered):
    dataset, stribeck = gathered.fit.dataset, effect_named("stribeck")
    speed, exponent = gathered.fit.shapes["stribeck"]
    here = dataset.columns(stribeck, (speed, exponent))[:, 0]
    for moved in ((1.03 * speed, exponent), (speed, 1.03 * exponent)):
        assert left_share(gathered, dataset.columns(stribeck, moved)[:, 0] - here) < 0.03


def test_the_model_itself_is_in_every_base(gathered):
    for base in range(len(gathered.bases)):
        for column in gathered.fit.columns.T:
            assert left_share(gathered, column, base) < 1e-3


def test_each_effect_is_judged_without_what_would_absorb_it(gathered):
    nuisances = nuisance_columns(gathered.fit.dataset)
    assert tuple(nuisances) == ("jerk",)
    for column in nuisances.values():
        assert left_share(gathered, column) < 1e-3
    delay = next(block for block in gathered.named if block.name == "measurement_delay")
    for name, column in nuisances.items():
        inside = left_share(gathered, column, delay.base) < 1e-3
        assert inside == (name not in effect_named("measurement_delay").standing_in)


def test_every_effect_that_is_not_in_the_model_is_a_candidate_in_all_its_shapes(gathered):
    names = {block.name for block in gathered.named}
    looked_for = {effect.name for effect in candidates(DEFAULT, FACTS)}
    steady = {name for name in looked_for if catalogue()[name].rows == "sliding"}
    assert names == steady - set(DEFAULT) - set(gathered.left_out)
    of_voltages = {name for name, effect in catalogue().items() if effect.efforts and "torque" not in effect.efforts}
    hidden = {"back_driving_friction", "coulomb_asymmetry"}  # in the free scale of gravity, and in the offset
    assert set(gathered.left_out) == {*of_voltages, *hidden, "warm_up", "motor_warm_up", "encoder_eccentricity"}
    for name in of_voltages:
        assert "but in current_estimate_a or duty x supply_v" in gathered.left_out[name], "the channels are told"
        assert gathered.left_out[name].endswith(
            'put quantity = "current_estimate" or "terminal_voltage" under [effort] into rig.toml'
        )
    memory = gather(gathered.fit, "moving")
    assert {block.name for block in memory.named} == {n for n, e in catalogue().items() if e.rows == "moving"}
    orders = [block.shape for block in gathered.named if block.name == "position_periodic_friction"]
    assert orders == [(float(order),) for order in range(2, 31)]
    assert {block.scanned for block in gathered.named if block.name == "position_periodic_friction"} == {29}


def test_only_sliding_training_rows_are_tested(gathered):
    fit = gathered.fit
    some = fit_model(fit.dataset, DEFAULT, fit.dataset.counted & (fit.dataset.trial_index < 6))
    rows = gather(some).rows
    assert rows.any()
    assert not rows[fit.dataset.trial_index >= 6].any()
    assert (fit.dataset.regime[rows] == 0).all()


def test_columns_are_weighted_like_the_effort(gathered):
    spring = next(block for block in gathered.named if block.name == "spring")
    column = gathered.fit.dataset.columns(effect_named("spring"), ())[gathered.rows, 0]
    assert spring.columns[:, 0] == pytest.approx(column * gathered.weights)
    effort = gathered.fit.dataset.effort[gathered.rows] * gathered.weights
    base = gathered.bases[0]
    assert base.residual == pytest.approx(effort - base.basis @ (base.basis.T @ effort))
    wider = gathered.with_block(spring)
    assert left_share(wider, gathered.fit.dataset.columns(effect_named("spring"), ())[:, 0]) < 1e-6


def test_a_force_that_differs_from_trial_to_trial_shows_less_beside_stops(gathered):
    *_, constant, _ = gathering._random_effects(gathered)
    share = constant.share / gathered.weights
    assert share == pytest.approx(gathered.fit.dry_friction * gathered.fit.dataset.constant[gathered.rows])
    assert share.min() < 0.7 * share.max()


def test_friction_that_differs_from_trial_to_trial_is_noise(monkeypatch):
    """Else whatever goes with some of the trials, as their load or their warmth, would explain it."""
    made = []
    for one, more in zip(recordings(seed=3), np.random.default_rng(5).standard_normal(99), strict=False):
        position, torque = one.channels["position_rad"], one.channels["torque_n_m"]
        differs = torque + 0.02 * more * np.sign(np.gradient(position))
        made.append(replace(one, channels={**one.channels, "torque_n_m": differs}))
    plain = gather(fit_model(make_dataset(made, FACTS, Processing()), DEFAULT))
    dataset, rows = plain.fit.dataset, plain.rows
    direction = dataset.stack(trial.motion.direction[None] for trial in dataset.trials)[rows, 0]
    trial = dataset.trial_index[rows]
    columns = np.where(trial[:, None] == np.unique(trial), (plain.weights * direction)[:, None], 0.0)

    def power() -> float:
        """Of what is left, in the friction of each trial; 1 where it is noise as it is known."""
        white = with_noise(plain)
        assert white.noise is not None
        own = white.bases[0].beyond(white.noise.whitened(columns))
        return float(np.mean((own.T @ white.bases[0].residual) ** 2 / np.sum(own**2, axis=0)))

    assert power() < 5.0
    monkeypatch.setattr(gathering, "_random_effects", lambda _: [])
    assert power() > 50.0
