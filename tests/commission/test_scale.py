"""What counts are worth, from an angle seen: signs, zero, and which of ratio and counts is corrected."""

from dataclasses import replace
from math import nan, pi

import pytest

from bench.commission.questions import COUNTS, GEAR_RATIO, LOAD, CommissionError, Known
from bench.commission.scale import scale_of

KNOWN = Known(0.5, 2.0, 0.1, gear_ratio=20.0, counts_per_turn=4096.0)
QUARTER = 20.0 * 4096.0 / 4.0  # counts of a right angle


def _scale(known: Known, down: float = 0.0, turned: float = QUARTER, told: float = nan):
    return scale_of(down, turned, pi / 2.0, known, told)


def test_right_answers_are_kept_to_the_last_digit_though_the_eye_errs():
    scale = _scale(KNOWN, turned=1.03 * QUARTER)
    assert (scale.gear_ratio, scale.counts_per_turn, scale.sentence) == (20.0, 4096.0, "")
    assert scale.low < 20.0 * 4096.0 < scale.high


def test_a_wrong_gear_ratio_is_found_and_said():
    scale = _scale(replace(KNOWN, gear_ratio=50.0))
    assert scale.gear_ratio == pytest.approx(20.0)
    assert "gear.ratio is 20" in scale.sentence
    assert "not 50" in scale.sentence


def test_lines_that_were_taken_for_counts_are_found():
    scale = _scale(replace(KNOWN, counts_per_turn=1024.0))
    assert (scale.gear_ratio, scale.counts_per_turn) == (20.0, 4096.0)
    assert "four per line" in scale.sentence


def test_what_the_drive_says_of_its_encoder_counts_more_than_what_a_person_does():
    scale = _scale(replace(KNOWN, counts_per_turn=1000.0, gear_ratio=50.0), told=4096.0)
    assert scale.counts_per_turn == 4096.0
    assert scale.gear_ratio == pytest.approx(20.0)


@pytest.mark.parametrize(("ratio", "counts"), [(None, 4096.0), (20.0, None), (None, None)])
def test_what_is_not_known_is_measured(ratio, counts):
    scale = _scale(replace(KNOWN, gear_ratio=ratio, counts_per_turn=counts))
    assert scale.gear_ratio * scale.counts_per_turn == pytest.approx(4.0 * QUARTER)


def test_a_count_that_falls_gives_the_sign_and_the_zero():
    scale = _scale(KNOWN, down=1000.0, turned=1000.0 - QUARTER)
    assert scale.encoder_sign == -1
    # as `JointScale` has it: sign * counts * count_rad - zero_rad
    assert scale.encoder_sign * 1000.0 * scale.count_rad - scale.zero_rad == pytest.approx(0.0)


def test_a_count_that_stands_is_refused_with_what_may_be_wrong():
    with pytest.raises(CommissionError, match=r"moved by 3 only.*encoder plugged in"):
        _scale(KNOWN, turned=3.0)


def test_an_arm_that_only_swung_is_not_taken_for_one_that_was_turned():
    with pytest.raises(
        CommissionError, match=r"gear\.ratio is 0\.39 .*moved by 400 .*1\.57 rad; allowed is at least 1"
    ):
        _scale(KNOWN, turned=400.0)
    assert _scale(replace(KNOWN, gear_ratio=100.0), turned=0.98 * 1024.0).gear_ratio == pytest.approx(0.98)


def test_answers_are_checked_with_their_unit():
    with pytest.raises(CommissionError, match=r"load_kg is 0\.001 kg; allowed is 0\.005 \.\. 50 kg"):
        LOAD.check(0.001)
    with pytest.raises(CommissionError, match="an answer is needed"):
        LOAD.check(None)
    assert COUNTS.check(None) is None
    assert GEAR_RATIO.check(12.5) == 12.5
