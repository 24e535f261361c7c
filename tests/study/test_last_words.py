"""The last words begin with what was found, and tell what the model may hide, whatever the verdict."""

from types import SimpleNamespace
from typing import Any

import pytest

from bench.study.diagnosis.last_words import NONE_CONFIRMED, SMALL, last_words, share_left
from bench.study.models.diagnosis import Finding
from compensator.lab.diagnosis.run_to_run import WEIGHT
from compensator.lab.diagnosis.wording import nothing_in_words

LEFT = f"{NONE_CONFIRMED}, yet what is left, 0.5% of the effort, is more than noise; it comes back. Repeat a trial."
ADDED = ["load friction", "cogging"]
ABSORBED = Finding(code="absorbed", values={"effect": "coulomb_asymmetry"}, text="The offset may be friction.")


def found(sentence: str, *findings: Finding, advice: str = "") -> Any:
    return SimpleNamespace(sentence=sentence, slight=bool(advice), advice=advice, findings=findings)


@pytest.mark.parametrize(
    ("sentence", "added", "share", "told"),
    [
        (LEFT, [], 1.0, LEFT),
        (
            LEFT,
            ADDED,
            0.9 * SMALL,
            "Beside load friction and cogging no effect of the catalogue is confirmed; what is left, 0.5% of the "
            "effort, is small, but more than noise; it comes back. Repeat a trial.",
        ),
        (
            LEFT,
            ADDED,
            1.1 * SMALL,
            "Beside load friction and cogging no effect of the catalogue is confirmed, yet what is left, 0.5% of the "
            "effort, is more than noise; it comes back. Repeat a trial.",
        ),
        (
            "Something is missing, and it is none of the catalogue: it varies with speed.",
            ADDED[:1],
            0.1,
            "Beside load friction something is missing, and it is none of the catalogue: it varies with speed.",
        ),
        ("Cogging is missing.", ADDED[:1], 0.1, "Cogging is missing."),
    ],
)
def test_what_was_found_comes_first(sentence, added, share, told):
    assert last_words(found(sentence), added, share) == told


def test_what_is_confirmed_by_nothing_begins_as_the_lab_says_it():
    assert nothing_in_words(1e-3).startswith(NONE_CONFIRMED)
    assert last_words(found(nothing_in_words(1e-3)), ADDED).startswith("Beside load friction and cogging no effect")


@pytest.mark.parametrize("verdict", ["Something is missing.", "Cogging is missing.", "Nothing is missing."])
def test_what_the_offset_may_be_is_told_beside_any_answer_once(verdict):
    assert last_words(found(verdict, ABSORBED)) == f"{verdict} {ABSORBED.text}"
    assert last_words(found(f"{verdict} {ABSORBED.text}", ABSORBED)) == f"{verdict} {ABSORBED.text}"
    assert last_words(found(verdict, ABSORBED, advice="Slight.")) == f"Slight. {ABSORBED.text}"


def test_loads_that_were_told_wrong_are_told_and_other_findings_are_not():
    loads = Finding(code="differs-by-run", values={"what": WEIGHT}, text="Loads differ.")
    other = Finding(code="rings", values={}, text="It rings.")
    assert last_words(found("Nothing.", loads, other)) == "Nothing. Loads differ."


def test_of_no_error_nothing_can_be_left_over():
    assert share_left(0.0, 0.0) == 1.0
    assert share_left(0.04, 0.01) == pytest.approx(0.25)
