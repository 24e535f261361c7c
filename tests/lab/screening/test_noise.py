"""Noise that is learnt from what is left: its covariance, and chances that hold what they say."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lfilter

import compensator.lab.screening.noise as noise_module
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.evidence import screen
from compensator.lab.screening.noise import LONGEST, Noise
from compensator.lab.screening.random_effects import RandomEffect

TRIALS, ROWS, PERIOD_S = 12, 120, 0.05  # 6 s each
EFFORT = 8.0
STROKE = 30  # rows between two stops


def dataset(velocity: list[np.ndarray] | None = None, seen: float | np.ndarray = 1.0) -> SimpleNamespace:
    """As much of a dataset as noise looks at; velocity of each trial, and how much of noise each row of one sees."""
    time_s = PERIOD_S * np.arange(ROWS)
    velocity = [speed()] * TRIALS if velocity is None else velocity
    block = np.concatenate([3 * trial + (time_s // 2.0).astype(int) for trial in range(TRIALS)])
    return SimpleNamespace(
        trials=tuple(SimpleNamespace(motion=SimpleNamespace(velocity=one)) for one in velocity),
        rows_of=np.concatenate,
        effort=np.full(TRIALS * ROWS, EFFORT),
        steadiness=np.ones(TRIALS * ROWS),
        noise_seen=np.tile(seen * np.ones(ROWS), TRIALS),
        time_of=lambda _trial: time_s,
        trial_index=np.repeat(np.arange(TRIALS), ROWS),
        trial_rows=[slice(trial * ROWS, (trial + 1) * ROWS) for trial in range(TRIALS)],
        stretches=lambda rows: len(np.unique(block[rows])),
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


def learnt(residual: np.ndarray, basis: np.ndarray = NOTHING) -> Noise:
    return Noise.learnt(dataset(STEADY), ALL, Base(basis, residual))


def covariance(noise: Noise, directions: np.ndarray) -> np.ndarray:
    """Of what noise puts into each of the directions (n, k), shape (k, k)."""
    spread = np.concatenate([root.T @ directions[rows] for rows, root in noise.roots])
    return spread.T @ spread


def screened(noise: Noise, base: Base, blocks: list[Block]):
    """Blocks screened on whitened rows."""
    white = Base.of(noise.whitened(base.basis), noise.whitened(base.residual[:, None])[:, 0])
    own = [Block(one.name, noise.whitened(one.columns), 0, 1) for one in blocks]
    return screen([white], own, noise)


def from_stop_to_stop() -> RandomEffect:
    velocity = np.tile(speed(), TRIALS)
    return RandomEffect(np.sign(velocity) * np.exp(-np.abs(velocity)), np.arange(len(velocity)) // STROKE)


def scattering(random: np.random.Generator, deviation: float) -> np.ndarray:
    """Coloured noise, and static friction that is another one after every stop."""
    strokes = from_stop_to_stop()
    factor = deviation * random.standard_normal(TRIALS * ROWS // STROKE)
    return 0.2 * coloured(random, 0.3) + strokes.share * factor[strokes.group]


def test_the_covariance_of_a_direction_is_what_noise_puts_into_it():
    random = np.random.default_rng(1)
    slow = np.tile(np.sin(np.linspace(0.0, np.pi, ROWS)), TRIALS)
    quick = np.tile((-1.0) ** np.arange(ROWS), TRIALS)
    directions = np.column_stack([one / np.linalg.norm(one) for one in (slow, quick)])
    shares = np.array([directions.T @ coloured(random) for _ in range(400)])
    found = np.mean([np.diag(covariance(learnt(coloured(random)), directions)) for _ in range(20)], axis=0)
    assert found == pytest.approx(shares.var(axis=0), rel=0.3)
    assert found[0] > 20.0 * found[1]


def test_whitened_noise_is_white_and_comes_back():
    random = np.random.default_rng(10)
    noise, other = learnt(coloured(random)), coloured(random)[:, None]
    white = noise.whitened(other)[:, 0].reshape(TRIALS, ROWS)
    assert np.mean(white**2) == pytest.approx(1.0, abs=0.15)
    assert abs(np.mean(white[:, 1:] * white[:, :-1])) < 0.12
    assert noise.as_measured(noise.whitened(other)) == pytest.approx(other)


def test_rows_that_see_less_of_the_noise_are_white_as_all_others_are():
    """Near the ends of a stroke: taken for as noisy as the others, they would seem to be too quiet, these too noisy."""
    random = np.random.default_rng(11)
    beside_stop = np.arange(ROWS) % STROKE >= STROKE // 2
    seen = np.where(beside_stop, 0.5, 1.0)
    residual = np.tile(seen, TRIALS) * coloured(random, 0.3)
    there = np.tile(beside_stop, TRIALS)
    powers = []
    for told in (seen, 1.0):
        noise = Noise.learnt(dataset(STEADY, told), ALL, Base(NOTHING, residual))
        white = noise.whitened(residual[:, None])[:, 0]
        powers.append([float(np.mean(white[rows] ** 2)) for rows in (there, ~there)])
    assert powers[0] == pytest.approx([1.0, 1.0], abs=0.2)
    assert powers[1][0] < 0.6


def test_where_nothing_is_left_but_rounding_rows_are_whitened_all_the_same():
    """As of two logs of one run without noise: a random effect is there as far as nobody can know."""
    residual = 1e-16 * coloured(np.random.default_rng(12))
    noise = Noise.learnt(dataset(STEADY), ALL, Base(NOTHING, residual), [from_stop_to_stop()])
    assert np.isfinite(noise.whitened(residual[:, None])).all()


def test_rows_left_out_count_for_nothing():
    random = np.random.default_rng(2)
    rows = random.random(len(ALL)) < 0.6
    residual = coloured(random)[rows]
    noise = Noise.learnt(dataset(STEADY), rows, Base(np.zeros((len(residual), 0)), residual))
    share = np.ones((int(rows.sum()), 1)) / np.sqrt(rows.sum())
    every = np.ones((len(ALL), 1)) / np.sqrt(len(ALL))
    whole = float(covariance(learnt(coloured(random)), every)[0, 0])
    assert float(covariance(noise, share)[0, 0]) == pytest.approx(0.6 * whole, rel=0.4)


def test_a_long_trial_is_cut_where_its_noise_has_been_forgotten():
    rows = 2 * LONGEST + 300
    time_s = PERIOD_S * np.arange(rows)
    one = SimpleNamespace(
        trials=(SimpleNamespace(motion=SimpleNamespace(velocity=np.ones(rows))),),
        rows_of=np.concatenate,
        noise_seen=np.ones(rows),
        time_of=lambda _trial: time_s,
        trial_rows=[slice(0, rows)],
        stretches=lambda chosen: len(np.unique(time_s[chosen] // 2.0)),
    )
    residual = lfilter([0.6], [1.0, -0.8], np.random.default_rng(3).standard_normal(rows))
    noise = Noise.learnt(one, np.ones(rows, dtype=bool), Base(np.zeros((rows, 0)), residual))
    assert [where.stop - where.start for where, _ in noise.roots] == [LONGEST, LONGEST, 300]
    assert np.mean(noise.whitened(residual[:, None]) ** 2) == pytest.approx(1.0, abs=0.2)


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
        found.append(np.trace(covariance(learnt(left, fitted), new)))
        bare.append(np.trace(covariance(learnt(left), new)))
        true.append(np.sum((new.T @ noise) ** 2))
    assert np.mean(found) == pytest.approx(np.mean(true), rel=0.25)
    assert np.mean(bare) < 0.7 * np.mean(true)


def test_noise_alone_is_as_strong_as_its_chance_says():
    random = np.random.default_rng(3)
    blocks = [Block(str(index), coloured(random)[:, None], 0, 1) for index in range(12)]
    p_values = []
    for _ in range(150):
        base = Base.of(np.ones((len(ALL), 1)), coloured(random))
        p_values.append(screened(learnt(base.residual), base, blocks).p_value)
    assert np.mean(np.array(p_values) <= 0.05) <= 0.10
    assert np.mean(np.array(p_values) <= 0.5) == pytest.approx(0.5, abs=0.15)


def test_the_chance_of_a_name_is_its_own_not_that_of_what_is_surest():
    random = np.random.default_rng(3)
    blocks = [Block(f"c{index}", coloured(random)[:, None], 0, 1) for index in range(10)]
    noise = coloured(random)
    effort = noise + 0.5 * blocks[2].columns[:, 0] + 0.12 * blocks[7].columns[:, 0]
    found = screened(learnt(noise), Base.of(NOTHING, effort), blocks)
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
    found = [np.diag(covariance(Noise.learnt(dataset(), ALL, Base(NOTHING, noise())), directions)) for _ in range(20)]
    assert np.mean(found, axis=0) == pytest.approx(shares.var(axis=0), rel=0.25)
    assert np.mean(found, axis=0)[0] > 3.0 * np.mean(found, axis=0)[1]


def test_rows_of_any_speed_share_one_source_of_noise():
    """Slow noise goes on where the speed changes: a slow direction over rows of all speeds has all of it."""
    random = np.random.default_rng(12)
    speeds = [random.choice([0.1, 1.0, 3.0], ROWS) for _ in range(TRIALS)]
    slow = np.tile(np.sin(np.linspace(0.0, np.pi, ROWS)), TRIALS)[:, None]
    slow /= np.linalg.norm(slow)
    shares = [float((slow.T @ coloured(random, 0.9))[0]) for _ in range(400)]
    found = [
        covariance(Noise.learnt(dataset(speeds), ALL, Base(NOTHING, coloured(random, 0.9))), slow)[0, 0]
        for _ in range(8)
    ]
    assert np.mean(found) == pytest.approx(np.var(shares), rel=0.35)


@pytest.mark.parametrize("deviation", [0.0, 0.3])
def test_what_static_friction_scatters_from_stop_to_stop_is_in_the_noise(deviation):
    random = np.random.default_rng(6)
    strokes = from_stop_to_stop()
    own = strokes.columns() / np.sqrt(np.bincount(strokes.group, strokes.share**2)[strokes.group][:, None])
    true = np.mean([np.sum((own.T @ scattering(random, deviation)) ** 2) for _ in range(60)])
    noises = [Noise.learnt(dataset(), ALL, Base(NOTHING, scattering(random, deviation)), [strokes]) for _ in range(8)]
    assert np.mean([np.trace(covariance(noise, own)) for noise in noises]) == pytest.approx(true, rel=0.3)


def test_what_differs_from_trial_to_trial_is_no_evidence_for_what_goes_with_a_few_of_them():
    random = np.random.default_rng(7)
    direction = np.sign(np.tile(speed(), TRIALS))
    trial = np.repeat(np.arange(TRIALS), ROWS)
    block = Block("warmth", (direction * np.linspace(-1.0, 1.0, TRIALS)[trial])[:, None], 0, 1)
    p_values: dict[bool, list[float]] = {True: [], False: []}
    for _ in range(60):
        factor = 0.5 * random.standard_normal(TRIALS)
        base = Base.of(direction[:, None], coloured(random, 0.3) + direction * factor[trial])
        for known, found in p_values.items():
            effects = [RandomEffect(direction, trial)] if known else []
            found.append(screened(Noise.learnt(dataset(), ALL, base, effects), base, [block]).p_value)
    assert np.mean(np.array(p_values[True]) <= 0.05) <= 0.12
    assert np.mean(np.array(p_values[True]) <= 0.5) == pytest.approx(0.5, abs=0.2)
    assert np.mean(np.array(p_values[False]) <= 0.05) > 0.25  # else this test shows nothing


def test_what_fast_rows_tell_of_friction_stands_beside_static_friction_that_scatters():
    """Generalised least squares of the same rows scatter less than plain ones."""
    random = np.random.default_rng(9)
    warmth = np.repeat(np.linspace(-1.0, 1.0, TRIALS), ROWS)
    way = np.sign(np.tile(speed(), TRIALS))  # all of dry friction: static friction in slow strokes, Coulomb's in fast
    column = (way * warmth)[:, None]
    noise = Noise.learnt(dataset(), ALL, Base(NOTHING, scattering(random, 0.3)), [from_stop_to_stop()])
    deviations = []
    for seen in (lambda values: values, noise.whitened):
        direction = seen(column)
        share = np.linalg.solve(direction.T @ direction, direction.T)
        deviations.append(float(np.std([share @ seen(scattering(random, 0.3)[:, None]) for _ in range(40)])))
    assert deviations[1] < 0.7 * deviations[0]


def test_what_three_stretches_hold_is_found():
    random = np.random.default_rng(4)
    held = np.zeros(len(ALL))
    for start in (200, 720, 1080):  # a stretch of 2 s each: their flips could never say how sure it is
        held[start : start + 20], held[start + 20 : start + 40] = 1.0, -1.0
    noise = coloured(random, 0.3)
    base = Base.of(np.ones((len(ALL), 1)), noise + 1.5 * held)
    known = learnt(base.extended(held[:, None]).residual)
    assert screened(known, base, [Block("held", held[:, None], 0, 1)]).p_value <= 0.001


def test_few_trials_tell_little_of_what_differs_between_them():
    """A contrast of trials is known as from few squares, one within trials as from all stretches."""
    random = np.random.default_rng(12)
    trial = np.repeat(np.arange(TRIALS), ROWS)
    residual = coloured(random, 0.3) + random.standard_normal(TRIALS)[trial]
    noise = Noise.learnt(dataset(), ALL, Base(NOTHING, residual), [RandomEffect(np.ones(len(ALL)), trial)])
    within = np.tile(np.sin(2.0 * np.pi * np.arange(ROWS) / ROWS), TRIALS)
    directions = noise.whitened(np.column_stack([np.where(trial < 6, 1.0, -1.0), within]))
    shares = noise.shares(directions / np.linalg.norm(directions, axis=0))
    assert np.sum(shares, axis=0) == pytest.approx(1.0)
    assert shares[1, 0] > 0.6
    assert shares[1, 1] < 0.1
    few, all_of_them = 1.0 / (shares.T**2 @ (1.0 / noise.freedoms))
    assert few < TRIALS + 5 < 0.8 * noise.stretches < all_of_them


def test_scatter_of_a_trial_that_is_cut_is_as_large_as_its_covariance_says(monkeypatch):
    monkeypatch.setattr(noise_module, "LONGEST", 50)
    random = np.random.default_rng(13)
    trial = np.repeat(np.arange(TRIALS), ROWS)
    residual = coloured(random, 0.3) + random.standard_normal(TRIALS)[trial]
    noise = Noise.learnt(dataset(), ALL, Base(NOTHING, residual), [RandomEffect(np.ones(len(ALL)), trial)])
    assert len(noise.roots) == 3 * TRIALS
    directions = noise.whitened(np.eye(len(ALL))[:, ::40])
    shares = noise.shares(directions / np.linalg.norm(directions, axis=0))
    assert shares.min() >= 0.0


def test_what_the_model_holds_of_a_single_trial_tells_no_scatter():
    """Of one trial alone the model has fitted all that differs there: rounding of it is nothing to learn from."""
    share = speed()
    one = RandomEffect(share, np.zeros(ROWS, dtype=int))
    left = Base.of(share[:, None], np.random.default_rng(14).standard_normal(ROWS))
    found = one.learnt(left, lambda directions: np.ones(directions.shape[1]))
    assert (found.variance, found.freedom) == (0.0, 0.0)
