"""The cut-off follows the motion and stops where noise begins."""

import numpy as np
import pytest

from compensator.lab.errors import UnusableDataError
from compensator.lab.recordings.bandwidth import LOWEST_HZ, choose_cutoff_hz, motion_bandwidth_hz, noise_corner_hz
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.processing import even_samples, make_signals
from compensator.lab.recordings.recording import Recording
from tests.lab.synthetic import FACTS, Bench, Plan, recordings


def swing(frequency_hz: float, bench: Bench):
    plan = Plan("swing", [(0.5, frequency_hz, 0.3)])
    made = recordings(bench=bench, trials=[plan])
    return made, choose_effort(made, FACTS)


def evenly(made, effort):
    return [even_samples(one, effort, FACTS) for one in made]


@pytest.mark.parametrize("frequency_hz", [1.0, 3.0])
def test_the_bandwidth_of_a_sine_is_its_frequency(frequency_hz):
    made, effort = swing(frequency_hz, Bench())
    found = motion_bandwidth_hz(evenly(made, effort), 40.0)
    assert found == pytest.approx(frequency_hz, abs=0.5)  # two bins of the spectrum, of 0.25 Hz each


def test_noise_of_the_position_is_no_motion_however_fast_it_was_sampled():
    made, effort = swing(1.0, Bench(rate_hz=1000.0, quantum=0.0))
    position = made[0].channels["position_rad"]
    position[:] += 1e-3 * np.random.default_rng(2).standard_normal(len(position))
    assert motion_bandwidth_hz(evenly(made, effort), 200.0) < 5.0


def test_quick_and_clean_motion_gets_a_wide_filter():
    made, effort = swing(3.0, Bench(noise=0.001))
    assert choose_cutoff_hz(made, effort, FACTS) > 8.0


def test_noise_narrows_the_filter_and_never_below_the_lowest():
    cutoffs = []
    for noise in (0.001, 0.05, 5.0):
        made, effort = swing(3.0, Bench(noise=noise))
        cutoffs.append(choose_cutoff_hz(made, effort, FACTS))
    assert cutoffs == sorted(cutoffs, reverse=True)
    assert cutoffs[0] > cutoffs[-1] == LOWEST_HZ


def test_never_above_a_fifth_of_the_rate():
    made, effort = swing(4.0, Bench(noise=0.0, rate_hz=50.0))
    assert choose_cutoff_hz(made, effort, FACTS) <= 10.0 + 1e-9


def test_an_effort_of_mere_noise_has_its_corner_at_the_bottom():
    random = np.random.default_rng(1)
    made, effort = swing(1.0, Bench())
    made[0].channels["torque_n_m"][:] = random.standard_normal(len(made[0]))
    assert noise_corner_hz(evenly(made, effort), 30.0) == LOWEST_HZ


@pytest.mark.parametrize("share", [0.7, 1.2])
def test_what_no_column_explains_does_not_move_the_corner_of_the_noise(share):
    made = recordings(bench=Bench(noise=0.05))
    effort = choose_effort(made, FACTS)
    alone = noise_corner_hz(evenly(made, effort), 40.0)
    own = [one.channels["torque_n_m"].copy() for one in made]
    # of the same spectrum as the effort, and of another motion: as of an axis that nobody records
    for one, other in zip(made, [*own[1:], own[0]], strict=True):
        one.channels["torque_n_m"][:] += share * other[::-1]
    assert noise_corner_hz(evenly(made, effort), 40.0) == alone > 2.0 * LOWEST_HZ


def test_a_start_from_rest_of_two_seconds_has_no_say_in_what_is_noise():
    made, effort = swing(3.0, Bench(noise=0.001))
    short = {name: values[:400] for name, values in made[0].channels.items()}  # too short to be filtered at 2.8 Hz
    both = [*made, Recording("start", "ramps", {}, short)]
    assert noise_corner_hz(evenly(both, effort), 12.0) == noise_corner_hz(evenly(made, effort), 12.0)


def test_half_of_the_longest_recording_is_left_between_the_edges_of_the_filter():
    made, effort = swing(3.0, Bench(noise=5.0))  # as low as it may be, where the recordings are long
    short = [Recording("short", "swing", {}, {name: values[:300] for name, values in made[0].channels.items()})]
    cutoff_hz = choose_cutoff_hz(short, effort, FACTS)
    assert cutoff_hz > LOWEST_HZ == choose_cutoff_hz(made, effort, FACTS)
    usable = make_signals(short[0], effort, FACTS, cutoff_hz).usable
    assert 0.4 < usable.mean() < 0.6
    assert choose_cutoff_hz([*made, *short], effort, FACTS) == LOWEST_HZ


def test_what_no_cut_off_leaves_anything_of_is_refused():
    made, effort = swing(3.0, Bench())
    nothing = [Recording("nothing", "swing", {}, {name: values[:20] for name, values in made[0].channels.items()})]
    with pytest.raises(UnusableDataError, match="'nothing' has 20 samples; at least"):
        choose_cutoff_hz(nothing, effort, FACTS)
