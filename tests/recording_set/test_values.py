"""Conditions as text."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench.recording_set.text.values import parse, shield, unshield, write
from compensator.lab.recordings.recording import Condition

CONDITIONS = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False),
    st.booleans(),
    st.text(st.characters(codec="utf-8", exclude_characters="\0")),
    st.text("'0123456789.+-eE trufals_", max_size=8),
)


@given(CONDITIONS)
def test_every_condition_reads_back_as_itself(value: Condition) -> None:
    found = parse(write(value))
    assert found == value
    assert type(found) is type(value)


@pytest.mark.parametrize(
    ("cell", "expected"),
    [
        ("0.49", 0.49),
        (" 4 ", 4.0),
        ("-1e-3", -0.001),
        ("TRUE", True),
        ("false", False),
        ("", None),
        ("  ", None),
        ("sin_sin", "sin_sin"),
        ("1_000", "1_000"),
        ("nan", "nan"),
        ("inf", "inf"),
        ("1e999", "1e999"),
        ("'12", "12"),
        ("'tis", "'tis"),
        ("12 V", "12 V"),
    ],
)
def test_cells_are_read_as_a_person_would(cell: str, expected: Condition | None) -> None:
    found = parse(cell)
    assert found == expected
    assert type(found) is type(expected)


@pytest.mark.parametrize(("cell", "expected"), [("0,49", 0.49), ("1.5", "1.5"), ("1.000,5", "1.000,5")])
def test_a_decimal_comma_is_read_where_it_is_announced(cell: str, expected: Condition) -> None:
    assert parse(cell, ",") == expected


FORMULAS = st.builds(
    "{}{}{}{}".format, st.sampled_from(["", "'", "''"]), st.sampled_from(["", " "]), st.sampled_from("=+-@"), st.text()
)


@given(FORMULAS)
def test_no_text_is_written_as_a_formula(text: str) -> None:
    assert write(text).startswith("'")
    assert shield(text).startswith("'")
    assert parse(write(text)) == text
    assert unshield(shield(text)) == text


@given(st.text())
def test_names_read_back_as_themselves(text: str) -> None:
    assert unshield(shield(text)) == text
