"""How chances are told: alike in words, in tables and on the page, and never smaller than can be known."""

import re

import pytest

from compensator.lab.chance import LEAST_STATED, chance_cell, chance_in_words, stated
from tests.paths import ROOT


@pytest.mark.parametrize(
    ("p_value", "words", "cell"),
    [(0.31, "p = 0.31", "0.31"), (0.0123, "p = 0.0123", "0.0123"), (1e-9, "p <= 0.001", "<= 0.001")],
)
def test_chances_in_words_and_tables(p_value, words, cell):
    assert (chance_in_words(p_value), chance_cell(p_value)) == (words, cell)


def test_programs_get_no_smaller_chance_than_people():
    assert stated(1e-9) == LEAST_STATED
    assert stated(0.02) == 0.02
    assert stated(float("nan")) != stated(float("nan"))  # where nothing was judged


def test_nothing_judged_is_no_chance():
    assert chance_cell(None) == chance_cell(float("nan")) == "-"


def test_the_page_has_the_same_bound():
    (bound,) = re.findall(r"const LEAST_P = ([\d.]+)", (ROOT / "web/modules/ui/format.js").read_text(encoding="utf-8"))
    assert float(bound) == LEAST_STATED
