"""What swings at one frequency in most trials is told from noise, and from what follows the motion."""

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.left_over import lines, swinging
from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.left_over import gather_in_motion, left_over
from compensator.lab.left_over.lines import MOST_GAIN, chance_of_sum, chance_over_noise
from compensator.lab.left_over.swinging import REACH_HZ, Swing, motions_of, ripple_of, swing_of
from compensator.lab.model.fit import fit_model, widened
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.gathering import gather_curves, with_noise
from tests.lab.left_over.judged import leaving
from tests.lab.synthetic import FACTS, Bench, Joint, Truth, plans, recordings

BENCH = Bench(duration_s=9.0, noise_memory=0.0)
SUPPLY_V, RIPPLE_HZ = 24.0, 1.7
SMALL_RIPPLE = 0.002
NEAR_SHARE, NEAR_SEED = 0.0025, 6


def recorded(extra=None, seed=0, noise=BENCH.noise) -> list[Recording]:
    return recordings(Joint(extra=extra), replace(BENCH, noise=noise), plans(), seed)


def rippling(
    made: list[Recording], share: float, seed: int = 7, at_hz: Sequence[float] = (RIPPLE_HZ,)
) -> list[Recording]:
    """The same, the motor driven by a voltage that goes with the torque, and a supply that ripples by a share of it."""
    random, found = np.random.default_rng(seed), []
    for one in made:
        channels = one.channels
        duty = channels["torque_n_m"] / 2.0
        phases = random.uniform(-np.pi, np.pi, len(at_hz))
        turns = 2.0 * np.pi * np.outer(channels["time_s"], at_hz)
        swings = share * np.sin(turns + phases).sum(axis=1)
        supply = np.full_like(duty, SUPPLY_V)
        more = {"duty": duty, "supply_v": supply, "torque_n_m": channels["torque_n_m"] * (1.0 + swings)}
        found.append(replace(one, channels={**channels, **more}))
    return found


def fitted(made: list[Recording]) -> Fit:
    return fit_model(make_dataset(made, FACTS, Processing(cutoff_hz=6.0)), default_effects(FACTS))


def swing(fit: Fit) -> Swing | None:
    return swing_of(gather_curves(fit))


@pytest.mark.parametrize("seed", range(4))
def test_noise_does_not_swing(seed):
    assert swing(fitted(rippling(recorded(seed=seed), 0.0))) is None


def slow_noise(times_s: Sequence[np.ndarray], random: np.random.Generator, fastest_hz: float) -> np.ndarray:
    """Noise of all frequencies up to one, beside white noise, of trials' rows one after the other."""
    tones_hz, found = np.linspace(0.02, fastest_hz, 25), []
    for time_s in times_s:
        phase, size = 2.0 * np.pi * np.outer(time_s, tones_hz), random.standard_normal((2, len(tones_hz)))
        found.append(0.6 * (np.cos(phase) @ size[0] + np.sin(phase) @ size[1]) + random.standard_normal(len(time_s)))
    return np.concatenate(found)


@pytest.mark.parametrize("fastest_hz", [0.3, 0.4])
def test_noise_that_is_the_denser_the_slower_it_is_has_no_line_at_the_slow_end(fastest_hz):
    fit = fitted(recorded())
    dataset, rows = fit.dataset, fit.training
    numbers = dataset.trial_index[rows]
    time_s = dataset.rows_of([trial.signals.time_s - trial.signals.time_s[0] for trial in dataset.trials])[rows]
    times_s = [time_s[numbers == one] for one in np.unique(numbers)]
    random = np.random.default_rng(3)
    found = [swing_of(leaving(fit, slow_noise(times_s, random, fastest_hz))) for _ in range(20)]
    assert sum(one is not None for one in found) <= 2


def test_a_line_in_the_torque_is_told_with_its_frequency():
    fit = fitted(recorded(lambda x: 0.005 * np.sin(2.0 * np.pi * 3.1 * x.time_s)))
    found = swing(fit)
    assert found is not None
    assert not found.of_voltage
    assert found.frequency_hz == pytest.approx(3.1, rel=0.05)
    answer = diagnose(fit)
    assert answer.remains
    assert answer.sentence.startswith("No effect of the catalogue is confirmed, yet what is left")
    assert "p = " not in answer.sentence, "the chance of the effects is not that of what told"
    assert re.search(r"it swings at about 3(\.[0-2])? Hz in most trials", answer.sentence)


def test_a_ripple_of_the_supply_is_told_where_it_follows_the_voltage():
    found = rippled(fitted(rippling(recorded(noise=0.004), 0.02)))
    assert found is not None
    assert found.of_voltage
    assert found.frequency_hz == pytest.approx(RIPPLE_HZ, rel=0.05)


def rippled(fit: Fit) -> Swing | None:
    return ripple_of(gather_in_motion(fit))


def test_a_ripple_that_is_too_small_for_its_power_alone_is_told_by_a_matched_filter():
    fit = fitted(rippling(recorded(seed=1, noise=0.004), SMALL_RIPPLE))
    assert swing(fit) is None
    found = rippled(fit)
    assert found is not None
    assert found.of_voltage
    assert found.frequency_hz == pytest.approx(RIPPLE_HZ, rel=0.05)


def test_a_ripple_does_not_hide_itself_as_noise_of_its_own_frequency():
    """In few trials: noise that is learnt from all that is left has it in a band, over which it is spread."""
    found = rippled(fitted(rippling(recorded(seed=2, noise=0.004)[:6], 0.005, at_hz=(0.6,))))
    assert found is not None
    assert found.frequency_hz == pytest.approx(0.6, rel=0.05)


@pytest.mark.parametrize("seed", range(3))
def test_what_does_not_ripple_is_not_said_to(seed):
    assert rippled(fitted(rippling(recorded(seed=seed, noise=0.004), 0.0))) is None


def test_a_band_of_frequencies_is_no_line():
    band_hz = np.arange(1.0, 2.6, 0.15)
    assert rippled(fitted(rippling(recorded(seed=1, noise=0.004), SMALL_RIPPLE, at_hz=band_hz))) is None


def test_what_few_trials_have_at_another_frequency_does_not_hide_the_line_of_all():
    made = rippling(recorded(seed=1, noise=0.004), 0.003)
    few = rippling(recorded(seed=1, noise=0.004)[:3], 6.0 * 0.003, at_hz=(3.1,))
    found = rippled(fitted([*few, *made[3:]]))
    assert found is not None
    assert found.frequency_hz == pytest.approx(RIPPLE_HZ, rel=0.05)


def test_a_line_is_paid_for_by_all_frequencies_that_were_tried(monkeypatch):
    fit = fitted(rippling(recorded(seed=1, noise=0.004), SMALL_RIPPLE))
    monkeypatch.setattr(lines, "chance_of_sum", lambda *_: 0.1 * PLAIN.ripple)
    assert rippled(fit) is None


def test_a_ripple_shows_near_reversals_too():
    fit = fitted(rippling(recorded(seed=NEAR_SEED, noise=0.004), NEAR_SHARE))
    assert ripple_of(gather_curves(fit)) is None
    swings = left_over(with_noise(gather_curves(fit))).swing
    assert swings is not None
    assert swings.of_voltage
    assert swings.frequency_hz == pytest.approx(RIPPLE_HZ, rel=0.05)


def test_what_the_model_misses_of_a_motion_is_no_ripple_though_every_load_has_it(monkeypatch):
    few = plans()[:6]
    loads = (0.02, 0.05, 0.1, 0.15, 0.2)
    trials = [*few, *(replace(one, load_kg=load) for one in few[:2] for load in loads)]
    made = recordings(Joint(), replace(BENCH, noise=0.004), trials, seed=2)
    theirs = [0, 1, *range(len(few), len(made))]
    missed = dict(zip(theirs, rippling([made[one] for one in theirs], 2.0 * SMALL_RIPPLE), strict=True))
    fit = fitted([missed.get(index, one) for index, one in enumerate(rippling(made, 0.0))])
    assert rippled(fit) is None
    monkeypatch.setattr(swinging, "motions_of", lambda trials: np.arange(len(trials)))
    assert rippled(fit) is not None


def test_what_swings_where_there_is_hardly_any_voltage_is_not_the_supplys(monkeypatch):
    made = rippling(recorded(seed=1, noise=0.004), 3.0 * SMALL_RIPPLE)
    hardly = [replace(one, channels={**one.channels, "duty": 0.1 * one.channels["duty"]}) for one in made[:7]]
    fit = fitted([*hardly, *rippling(recorded(seed=1, noise=0.004)[7:], 0.0)])
    assert rippled(fit) is None
    even = swinging._by_motion
    monkeypatch.setattr(swinging, "_by_motion", lambda known, motions: even(np.ones_like(known), motions))
    assert rippled(fit) is not None


def test_a_motion_counts_as_its_trials_do_on_average():
    gains, information = np.array([[4.0], [0.0], [2.0]]), np.array([1.0, 3.0, 1.0])
    within, shares = swinging._by_motion(information, np.array([0, 0, 1]))
    assert (within @ gains).tolist() == [[1.0], [2.0]]
    assert shares.tolist() == [1.0, 0.5]


def test_the_noise_is_that_of_the_trials_that_count():
    """Twelve trials count, whose noise grows with the frequency; that of forty others does not."""
    random, at_hz = np.random.default_rng(4), np.arange(0.5, 20.0, 0.05)
    gains = random.exponential(size=(52, len(at_hz)))
    gains[:12] *= 1.0 + at_hz / 10.0
    counts = np.array([1.0, 0.8] * 6 + [0.001] * 40)
    over, _ = lines.over_noise(at_hz, gains, counts, REACH_HZ)
    told = counts @ np.minimum(over, MOST_GAIN) / counts.sum()
    assert told[at_hz > 15.0].mean() == pytest.approx(1.0, abs=0.06)
    assert told[at_hz < 5.0].mean() == pytest.approx(1.0, abs=0.06)


def test_trials_that_hardly_count_tell_hardly_anything_of_the_noise():
    assert swinging.independent_s(np.ones(2), np.array([5.0, 5.0])) == pytest.approx(10.0)
    assert swinging.independent_s(np.array([1.0, *[1e-4] * 40]), np.full(41, 5.0)) == pytest.approx(5.0, rel=0.01)


def test_where_no_voltage_is_known_nothing_ripples_with_it():
    assert rippled(fitted(recorded())) is None


@pytest.mark.parametrize("shares", [np.ones(12), np.array([1.0, 0.9, 0.4, 0.2, *[0.01] * 20])], ids=["even", "uneven"])
def test_the_chance_of_a_sum_is_that_of_as_many_exponential_variables(shares):
    random = np.random.default_rng(3)
    sums = np.minimum(random.exponential(size=(20000, len(shares))), MOST_GAIN) @ shares
    for share in (0.5, 0.1, 0.01):
        at = float(np.quantile(sums, 1.0 - share)) / shares.sum()
        assert chance_of_sum(np.full(len(shares), at), shares) == pytest.approx(share, rel=0.15)


def test_the_noise_around_a_line_is_known_no_better_than_from_so_many_powers():
    random, powers, trials = np.random.default_rng(5), 40, 10
    found = []
    for _ in range(1000):
        gains = random.exponential(size=trials) / random.exponential(size=powers).mean()
        found.append((chance_over_noise(gains, np.ones(trials), powers), chance_of_sum(gains, np.ones(trials))))
    by_what_is_known, as_if_sure = (np.array(found) <= 0.02).mean(axis=0)
    assert by_what_is_known <= 0.03
    assert as_if_sure > 0.03


@pytest.mark.parametrize(("duration_s", "tells"), [(5.0, False), (20.0, True)])
def test_what_turns_less_than_twice_in_a_usual_trial_is_no_line(duration_s, tells):
    slow = recordings(Joint(), replace(BENCH, noise=0.004, duration_s=duration_s), plans(), seed=1)
    found = rippled(fitted(rippling(slow, 0.02, at_hz=(0.17,))))
    assert (found is not None) == tells
    assert found is None or found.frequency_hz == pytest.approx(0.17, abs=0.02)


def test_a_voltage_that_wanders_does_not_ripple():
    """All that is slower than a frequency, at once: its power rises towards the slow end, where a peak is rare."""
    slow_hz, found = np.arange(0.03, 0.4, 0.03), []
    for seed in range(1, 9):
        made = rippling(recorded(seed=seed, noise=0.004), 4.0 * SMALL_RIPPLE, seed=20 + seed, at_hz=slow_hz)
        found.append(rippled(fitted(made)))
    assert sum(one is not None for one in found) <= 1


def test_a_line_in_a_few_trials_is_theirs_alone():
    made = recorded()
    few = [
        replace(one, channels={**one.channels, "torque_n_m": one.channels["torque_n_m"] + 0.02 * np.sin(12.0 * time_s)})
        for one in made[: len(made) // 3]
        for time_s in [one.channels["time_s"]]
    ]
    assert swing(fitted([*few, *made[len(few) :]])) is None


def test_trials_of_one_motion_tell_once():
    """What the model misses of a motion comes back with it, whatever the load: here in two motions of three."""
    few = plans()[:6]
    loads = (0.02, 0.05, 0.1, 0.15, 0.2)
    many = [*few, *(replace(one, load_kg=load) for one in few[:2] for load in loads)]
    made = recordings(Joint(), BENCH, many, seed=2)
    swung = [
        replace(
            one, channels={**one.channels, "torque_n_m": one.channels["torque_n_m"] + 0.004 * np.sin(12.0 * time_s)}
        )
        if index in (0, 1) or index >= len(few)
        else one
        for index, one in enumerate(made)
        for time_s in [one.channels["time_s"]]
    ]
    fit = fitted(swung)
    assert motions_of(fit.dataset.trials).tolist() == [0, 1, 2, 0, 1, 2, *[0] * len(loads), *[1] * len(loads)]
    assert swing(fit) is None


def test_a_motion_that_begins_later_is_the_same_one():
    """A harmonic of it that is missed is in both, in another phase."""
    few = plans()[:3]
    later = [
        replace(one, load_kg=0.1, sines=[(size, hz, phase + 2.0 * np.pi * hz * 1.7) for size, hz, phase in one.sines])
        for one in few
    ]
    trials = fitted(recordings(Joint(), BENCH, [*few, *later])).dataset.trials
    assert motions_of(trials).tolist() == [0, 1, 2, 0, 1, 2]


def ringing(x: Truth) -> np.ndarray:
    """A line near reversals alone, as a shaft makes that swings there."""
    reversals_s = x.time_s[np.flatnonzero(np.diff(np.sign(x.v)) != 0.0)]
    apart_s = np.min(np.abs(x.time_s[:, None] - reversals_s), axis=1)
    return 20.0 * line(x) * (apart_s < 0.03)


def line(x: Truth) -> np.ndarray:
    return 0.01 * np.sin(2.0 * np.pi * 3.1 * x.time_s)


@pytest.mark.parametrize(("law", "swings"), [(ringing, False), (line, True)])
def test_what_rings_after_reversals_is_what_a_formula_of_memory_leaves(law, swings):
    gathered = gather_curves(widened(fitted(recorded(law)), "moving"), "moving")
    assert (left_over(gathered).swing is not None) == swings


@pytest.mark.parametrize(("first", "step", "reach"), [(0.25, 1.0 / 48.0, (0.25, 1.0)), (0.37, 0.0925, (0.74, 14.8))])
def test_the_noise_around_is_of_all_within_reach_and_of_no_other(first, step, reach):
    # reaches of whole steps: the last place lies just at the end, where rounding decides
    at = first + step * np.arange(300)
    at[200:] += 2.0 * reach[1]
    gains = np.random.default_rng(5).exponential(size=(2, 300))
    gains[:, 100:180], gains[:, 200] = 0.0, 9.0  # what is beyond the gap is no noise before it
    over, around = lines.over_noise(at, gains, np.array([1.0, 0.4]), reach)
    evened = gains / gains.mean(axis=1, keepdims=True)
    summed = np.array([1.0, 0.4]) @ np.minimum(evened, MOST_GAIN) / (1.4 * (1.0 - np.exp(-MOST_GAIN)))
    for place in (0, 7, 90, 140, 199, 240, 299):
        sides = [(way * (at - at[place]) > reach[0]) & (way * (at - at[place]) <= reach[1]) for way in (-1.0, 1.0)]
        assert around[place] == sum(side.sum() for side in sides)
        floor = max(summed[side].mean() if side.any() else 0.0 for side in sides)
        assert over[:, place] == pytest.approx(evened[:, place] / max(floor, lines.TINY))
