"""When a candidate counts as confirmed."""

from dataclasses import replace

import pytest

from compensator.lab.diagnosis.answer import Answer
from compensator.lab.diagnosis.confirmation import doubts, is_confirmed, nearest_one
from compensator.lab.diagnosis.diagnose import with_nearest
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.diagnosis.wording import nearest_in_words
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.gain import Gain


@pytest.mark.parametrize(
    ("score", "p_value", "gain", "low", "confirmed"),
    [
        (5.0, 0.001, 0.2, 0.1, True),
        (-1.0, 0.001, 0.2, 0.1, False),  # does not pay for its parameters
        (5.0, 0.02, 0.2, 0.1, False),  # may be luck
        (5.0, 0.001, 0.2, -0.01, False),  # held-out trials may not gain
        (50.0, 0.001, 0.2, -0.01, False),  # however strong the evidence
        (50.0, 0.001, -0.01, -0.2, False),  # held-out trials lose
        (50.0, 0.001, 0.0005, 0.0001, False),  # a gain of no use
    ],
)
def test_score_luck_and_gain_must_all_speak_for_it(score, p_value, gain, low, confirmed):
    gained = Gain(gain, low, 2.0 * gain)
    candidate = Candidate(effect_named("spring"), (), score, p_value, 7.0, (), 0.1, 0.08, gained, None)
    assert is_confirmed(candidate) == confirmed


@pytest.mark.parametrize(
    ("changed", "doubt"),
    [
        ({}, []),
        ({"score": -1.0}, ["score not above 0"]),
        ({"p_value": 0.02}, ["may be luck"]),
        ({"before": 0.0006}, ["explains under 0.05% of the effort"]),
        ({"gain": Gain(0.004, 0.001, 0.01)}, ["gain under 0.5%"]),
        ({"gain": Gain(0.019, 0.01, 0.03), "effect": effect_named("backlash")}, ["gain under 2.0%"]),
        ({"gain": Gain(0.021, 0.01, 0.03), "effect": effect_named("backlash")}, []),
        ({"gain": Gain(0.049, 0.01, 0.06), "effect": effect_named("measurement_delay")}, ["gain under 5.0%"]),
        ({"gain": Gain(0.2, -0.01, 0.4)}, ["gain not sure"]),
        (
            {"impossible": "it would be -2, allowed 0 to 1", "p_value": 0.02},
            ["may be luck", "it would be -2, allowed 0 to 1"],
        ),
    ],
)
def test_what_a_candidate_lacks_is_told(changed, doubt):
    gained = Gain(0.2, 0.1, 0.4)
    one = Candidate(effect_named("spring"), (), 5.0, 0.001, 7.0, (), 0.1, 0.08, gained, None)
    found = replace(one, **changed)
    assert doubts(found) == doubt
    assert is_confirmed(found) == (not doubt)


SURE = Gain(0.0166, 0.0027, 0.0406)
NOT_SURE = Gain(0.0166, -0.01, 0.0406)


@pytest.mark.parametrize(
    ("changed", "near"),
    [
        ({}, False),  # confirmed
        ({"gain": NOT_SURE}, True),
        ({"gain": NOT_SURE, "p_value": 0.02}, False),  # may be luck
        ({"gain": NOT_SURE, "score": 9.0}, False),
        ({"gain": NOT_SURE, "impossible": "known from the rig"}, False),  # no more data would confirm it
        ({"gain": Gain(0.001, -0.01, 0.01)}, False),
        ({"gain": NOT_SURE, "refused": "explains much less than spring, which cannot be it"}, False),
    ],
)
def test_the_nearest_is_what_more_data_may_confirm(changed, near):
    candidate = replace(
        Candidate(effect_named("viscous_asymmetry"), (), 14.9, 0.001, 4.1, (), 0.009, 0.0088, SURE, None), **changed
    )
    weaker = replace(candidate, effect=effect_named("spring"), score=0.9 * candidate.score)
    found = nearest_one([weaker, candidate])
    assert (found is candidate) == near
    if found is not None:
        words = nearest_in_words(found)
        assert words.startswith("Direction-asymmetric viscous friction is likely (gain 1.7%, 90 % interval")
        assert words.endswith("to decide, record more of: several speeds in both directions.")


def test_nothing_is_missing_is_not_said_beside_what_is_likely():
    near = replace(
        Candidate(effect_named("viscous_asymmetry"), (), 14.9, 0.001, 4.1, (), 0.009, 0.0088, SURE, None), gain=NOT_SURE
    )
    answer = Answer("nothing", "Nothing is missing.", 0.5, [], None, [])
    assert with_nearest(answer, []) == "Nothing is missing."
    assert with_nearest(answer, [near]).startswith("No effect is confirmed. Direction-asymmetric viscous friction is")
    assert with_nearest(replace(answer, remains=True), [near]).startswith("Nothing is missing. Direction-asymmetric")


@pytest.mark.parametrize(
    ("before", "after", "confirmed"),
    [
        (0.003, 0.00295, True),  # of the effort it explains 0.055 %
        (0.003, 0.00297, False),  # 0.042 %
        (0.0009, 0.0008, False),  # as large a share of a smaller error is less of the effort: 0.041 %
        (0.00295, 0.003, False),  # more is left than before
    ],
)
def test_what_explains_less_of_the_effort_than_sensors_are_linear_is_not_confirmed(before, after, confirmed):
    gained = Gain(1.0 - after / before, 0.005, 0.1)
    candidate = Candidate(effect_named("spring"), (), 50.0, 0.001, 7.0, (), before, after, gained, None)
    assert is_confirmed(candidate) == confirmed


@pytest.mark.parametrize("rows", ["sliding", "moving"])
def test_a_sign_or_size_that_cannot_be_is_the_shadow_of_something_else(rows):
    gained = Gain(0.2, 0.1, 0.3)
    candidate = Candidate(effect_named("spring"), (), 50.0, 0.001, 7.0, (), 0.1, 0.08, gained, None, rows)
    assert is_confirmed(candidate)
    assert not is_confirmed(replace(candidate, impossible="it would be -2, allowed 0 to 1"))
