"""What a benchmark puts down to the host: only what it took."""

import numpy as np
import pytest

from tests.service.host_watch import covered_s, lost_cycles, own_lateness_s, watched
from tests.service.lateness import Measured, Stretch, ratios, report
from tests.service.timed_process import Cycles

PERIOD_S = 0.001


def stretch(late_s: list[float], gaps: list[tuple[float, float]]) -> Stretch:
    return Stretch(Cycles(PERIOD_S * np.arange(len(late_s)), np.array(late_s)), gaps)


def test_a_stretch_that_two_processors_were_away_counts_once():
    assert covered_s([(1.0, 3.0), (2.0, 4.0), (9.0, 9.5)], 2.5, 9.2) == pytest.approx(1.7)


def test_cycles_lost_while_a_processor_was_away_are_the_hosts():
    found = stretch([0.0, 0.01, 0.0], [(0.0012, 0.0115)])
    assert found.lost(PERIOD_S) == 10
    assert found.own_lost(PERIOD_S) == 0


@pytest.mark.parametrize("gaps", [[], [(0.02, 0.04)], [(0.001, 0.003)]])
def test_those_lost_while_it_was_there_are_our_own(gaps):
    found = stretch([0.0, 0.0105, 0.0], gaps)
    assert found.own_lost(PERIOD_S) == 10 - 2 * (gaps[:1] == [(0.001, 0.003)])


def test_lateness_within_a_period_is_nobodys_loss():
    late_s = np.array([0.0009, 0.0])
    assert lost_cycles(own_lateness_s(np.zeros(2), late_s, []), PERIOD_S) == 0


def test_a_machine_that_grows_slower_cancels():
    alone, beside = ([stretch([one] * 5, []) for one in some] for some in ([1.0, 3.0, 5.0], [2.0, 4.0]))
    assert ratios(alone, beside, own=False) == ratios(alone, beside, own=True) == [1.0, 1.0]


def test_what_the_host_was_late_is_left_out_of_the_quantile_that_is_our_own():
    found = stretch([0.0005] * 100, [(0.0001 + PERIOD_S * number, 0.0004 + PERIOD_S * number) for number in range(100)])
    assert found.p99_s(own=False) == pytest.approx(0.0005)
    assert found.p99_s(own=True) == pytest.approx(0.0002)


def test_a_loss_of_our_own_is_not_met():
    fine, bad = stretch([1e-5] * 9, []), stretch([1e-5] * 8 + [0.002], [])
    found = {what: [fine, fine] if what in (Measured.WAITING, Measured.ALONE) else [fine] for what in Measured}
    assert "NOT MET" not in list(report(found, PERIOD_S))[-1]
    assert "NOT MET" in list(report(found | {Measured.BESIDE: [bad]}, PERIOD_S))[-1]


def test_the_watch_ends_when_it_is_told():
    with watched() as gaps:
        pass
    assert all(end > begin for begin, end in gaps)
