"""Noise that is learnt from what is left: its covariance, and chances that hold what they say."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lfilter

from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.evidence import screen, screen_against_noise
from compensator.lab.screening.noise import Noise, spectral_density
from compensator.lab.screening.stops import StopToStop

TRIALS, ROWS, PERIOD_S = 12, 120, 0.05  # 6 s each
EFFORT = 8.0
STROKE = 30  # rows between two stops


def dataset(velocity: list[np.ndarray] | None = None) -> SimpleNamespace:
    """As much of a dataset as noise looks at; velocity of each trial."""
    time_s = PERIOD_S * np.arange(ROWS)
    velocity = [speed()] * TRIALS if velocity is None else velocity
    return SimpleNamespace(
        trials=tuple(SimpleNamespace(motion=SimpleNamespace(velocity=one)) for one in velocity),
        rows_of=np.concatenate,
        effort=np.full(TRIALS * ROWS, EFFORT),
        steadiness=np.ones(TRIALS * ROWS),
        time_of=lambda _trial: time_s,
        trial_index=np.repeat(np.arange(TRIALS), ROWS),
        trial_rows=[slice(trial * ROWS, (trial + 1) * ROWS) for trial in range(TRIALS)],
        block_index=np.concatenate([3 * trial + (time_s // 2.0).astype(int) for trial in range(TRIALS)]),
    )


def speed() -> np.ndarray:
    """Of one trial: strokes to and fro, the first two as slow as static friction lasts."""
    way = np.sin(np.pi * (np.arange(ROWS) % STROKE + 0.5) / STROKE)
    return np.repeat([0.1, -0.1, 3.0, -3.0], STROKE) * way


def coloured(random: np.random.Generator, memory: float = 0.8) -> np.ndarray:
    noise = random.standard_normal((TRIALS, ROWS + 100))
    return lfilter([np.sqrt(1.0 - memory**2)], [1.0, -memory], noise)[:, 100:].ravel()


ALL = np.ones(TRIALS * ROWS, dtype=bool)


NOTHING = np.zeros((TRIALS * ROWS, 0))


STEADY = [np.full(ROWS, 0.1 + trial) for trial in range(TRIALS)]  # each trial of one speed


def learnt(residual: np.ndarray) -> Noise:
    return Noise.learnt(dataset(STEADY), ALL, (NOTHING, residual), before=float(residual @ residual))


def from_stop_to_stop() -> StopToStop:
    velocity = np.tile(speed(), TRIALS)
    return StopToStop(np.sign(velocity) * np.exp(-np.abs(velocity)), np.arange(len(velocity)) // STROKE)


def scattering(random: np.random.Generator, deviation: float) -> np.ndarray:
    """Coloured noise, and static friction that is another one after every stop."""
    strokes = from_stop_to_stop()
    factor = deviation * random.standard_normal(TRIALS * ROWS // STROKE)
    return 0.2 * coloured(random, 0.3) + strokes.share * factor[strokes.index]


def test_the_covariance_of_a_direction_is_what_noise_puts_into_it():
    random = np.random.default_rng(1)
    slow = np.tile(np.sin(np.linspace(0.0, np.pi, ROWS)), TRIALS)
    quick = np.tile((-1.0) ** np.arange(ROWS), TRIALS)
    directions = np.column_stack([one / np.linalg.norm(one) for one in (slow, quick)])
    shares = np.array([directions.T @ coloured(random) for _ in range(400)])
    found = np.mean([np.diag(learnt(coloured(random)).covariance(directions)) for _ in range(20)], axis=0)
    assert found == pytest.approx(shares.var(axis=0), rel=0.25)
    assert found[0] > 20.0 * found[1]


def test_rows_left_out_count_for_nothing():
    random = np.random.default_rng(2)
    rows = random.random(len(ALL)) < 0.6
    residual = coloured(random)[rows]
    left = (np.zeros((len(residual), 0)), residual)
    noise = Noise.learnt(dataset(STEADY), rows, left, before=float(residual @ residual))
    whole = learnt(coloured(random))
    share = np.ones((int(rows.sum()), 1)) / np.sqrt(rows.sum())
    assert float(noise.covariance(share)[0, 0]) == pytest.approx(
        0.6 * float(whole.covariance(np.ones((len(ALL), 1)) / np.sqrt(len(ALL)))[0, 0]), rel=0.4
    )


def test_what_a_wide_fit_takes_from_slow_noise_is_given_back():
    """A fit of every other slow direction takes half of the slow noise, and none of the quick."""
    random = np.random.default_rng(11)
    at = (np.arange(ROWS) + 0.5) / ROWS
    slow = np.kron(np.eye(TRIALS), np.column_stack([np.cos(np.pi * order * at) for order in range(4)]))
    slow /= np.linalg.norm(slow, axis=0)
    fitted, new = slow[:, ::2], slow[:, 1::2]
    bare, found, true = [], [], []
    for _ in range(12):
        noise = coloured(random, 0.85)
        left = noise - fitted @ (fitted.T @ noise)
        known = Noise.learnt(dataset(STEADY), ALL, (fitted, left), before=float(left @ left))
        found.append(np.trace(known.covariance(new)))
        bare.append(np.trace(learnt(left).covariance(new)))
        true.append(np.sum((new.T @ noise) ** 2))
    assert np.mean(found) == pytest.approx(np.mean(true), rel=0.25)
    assert np.mean(bare) < 0.7 * np.mean(true)


def test_noise_alone_is_as_strong_as_its_chance_says():
    random = np.random.default_rng(3)
    blocks = [Block(str(index), coloured(random)[:, None], 0, 1) for index in range(12)]
    p_values = []
    for _ in range(150):
        base = Base.of(np.ones((len(ALL), 1)), coloured(random))
        p_values.append(screen_against_noise([base], blocks, learnt(base.residual)).p_value)
    assert np.mean(np.array(p_values) <= 0.05) <= 0.10
    assert np.mean(np.array(p_values) <= 0.5) == pytest.approx(0.5, abs=0.15)


def test_the_chance_of_a_name_is_its_own_not_that_of_what_is_surest():
    random = np.random.default_rng(3)
    blocks = [Block(f"c{index}", coloured(random)[:, None], 0, 1) for index in range(10)]
    noise = coloured(random)
    effort = noise + 0.5 * blocks[2].columns[:, 0] + 0.12 * blocks[7].columns[:, 0]
    found = screen_against_noise([Base.of(NOTHING, effort)], blocks, learnt(noise))
    own = {item.block.name: item.p_value for item in found.evidence}
    assert found.chance is not None
    assert found.chance(own["c2"]) == found.p_value <= 0.001
    assert own["c7"] < found.chance(own["c7"])  # one of ten: any of them might have reached it
    assert found.p_value < found.chance(own["c7"]) < 10.5 * own["c7"]


def test_slow_rows_have_noise_of_a_colour_of_their_own():
    random = np.random.default_rng(8)
    slow = np.tile(np.abs(speed()) <= np.quantile(np.abs(speed()), 1.0 / 3.0), TRIALS)
    ramps = np.tile(np.linspace(-1.0, 1.0, STROKE), TRIALS * ROWS // STROKE)
    directions = np.column_stack([one / np.linalg.norm(one) for one in (ramps * slow, ramps * ~slow, ramps)])

    def noise() -> np.ndarray:
        return np.where(slow, coloured(random, 0.9), random.standard_normal(len(ALL)))

    shares = np.array([directions.T @ noise() for _ in range(400)])
    found = []
    for _ in range(20):
        residual = noise()
        one = Noise.learnt(dataset(), ALL, (NOTHING, residual), before=float(residual @ residual))
        found.append(np.diag(one.covariance(directions)))
    assert np.mean(found, axis=0) == pytest.approx(shares.var(axis=0), rel=0.25)
    assert np.mean(found, axis=0)[0] > 3.0 * np.mean(found, axis=0)[1]


def test_how_much_static_friction_differs_from_stop_to_stop_is_learnt():
    random = np.random.default_rng(6)
    for deviation in (0.0, 0.1, 0.3):
        residuals = [scattering(random, deviation) for _ in range(8)]
        left = [(NOTHING, residual) for residual in residuals]
        noises = [Noise.learnt(dataset(), ALL, one, before=1.0, strokes=from_stop_to_stop()) for one in left]
        found = np.sqrt(np.mean([noise.from_stop_to_stop for noise in noises]))
        assert found == pytest.approx(deviation, abs=0.03, rel=0.25)


def test_half_of_the_noise_at_any_frequency_is_left_to_what_does_not_last_a_stroke():
    """Noise as slow as strokes looks the same: were all of it static friction's, a slow effect would seem sure."""
    residual = scattering(np.random.default_rng(12), 1.0)
    noises = [
        Noise.learnt(dataset(), ALL, (NOTHING, residual), before=1.0, strokes=strokes)
        for strokes in (None, from_stop_to_stop())
    ]
    whole, own = ([spectral_density(one, 2 * len(one)) for one in noise.autocovariances] for noise in noises)
    shares = np.sum(own, axis=1) / np.sum(whole, axis=1)
    assert shares[0] == pytest.approx(0.5, abs=0.05)  # slow rows: static friction has nearly all


def test_what_differs_between_slow_strokes_is_no_evidence_for_what_differs_between_trials():
    random = np.random.default_rng(7)
    strokes = from_stop_to_stop()
    warmth = np.repeat(np.linspace(-1.0, 1.0, TRIALS), ROWS)
    blocks = [Block("warmth", (strokes.share * warmth)[:, None], 0, 1)]
    p_values: dict[bool, list[float]] = {True: [], False: []}
    for _ in range(60):
        base = Base.of(strokes.share[:, None], scattering(random, 0.3))
        left = (base.basis, base.residual)
        for known, found in p_values.items():
            noise = Noise.learnt(dataset(), ALL, left, before=1.0, strokes=strokes if known else None)
            even = Base.of(noise.evened(base.basis), noise.evened(base.residual[:, None])[:, 0])
            evened = [replace(block, columns=noise.evened(block.columns)) for block in blocks]
            found.append(screen_against_noise([even], evened, noise).p_value)
    assert np.mean(np.array(p_values[True]) <= 0.05) <= 0.10
    assert np.mean(np.array(p_values[True]) <= 0.5) == pytest.approx(0.5, abs=0.15)
    assert np.mean(np.array(p_values[False]) <= 0.05) > 0.15  # else this test shows nothing


def test_what_fast_rows_tell_of_friction_stands_beside_static_friction_that_scatters():
    random = np.random.default_rng(9)
    strokes = from_stop_to_stop()
    warmth = np.repeat(np.linspace(-1.0, 1.0, TRIALS), ROWS)
    way = np.sign(np.tile(speed(), TRIALS))  # all of dry friction: static friction in slow strokes, Coulomb's in fast
    block = Block("warmth", (way * warmth)[:, None], 0, 1)
    noise = Noise.learnt(dataset(), ALL, (NOTHING, scattering(random, 0.3)), before=1.0, strokes=strokes)
    deviations = []
    for evened in (lambda values: values, noise.evened):
        direction = evened(block.columns)
        share = np.linalg.solve(direction.T @ direction, direction.T)
        scatter = [share @ evened(scattering(random, 0.3)[:, None]) for _ in range(40)]
        deviations.append(float(np.std(scatter)))
    assert deviations[1] < 0.6 * deviations[0]
    assert noise.as_measured(noise.evened(block.columns)) == pytest.approx(block.columns)


def test_what_three_stretches_hold_is_found_where_flips_cannot():
    random = np.random.default_rng(4)
    held = np.zeros(len(ALL))
    for start in (200, 720, 1080):  # a stretch of 2 s each
        held[start : start + 20], held[start + 20 : start + 40] = 1.0, -1.0
    noise = coloured(random, 0.3)
    base = Base.of(np.ones((len(ALL), 1)), noise + 1.5 * held)
    block = Block("held", held[:, None], 0, 1)
    cleared = base.extended(held[:, None]).residual
    assert screen([base], [block], dataset().block_index).p_value > 0.01
    assert screen_against_noise([base], [block], learnt(cleared)).p_value <= 0.001
