"""Cells to numbers, the fast way and the careful way."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench.recording_set.text.numbers import NoNumber, column, matrix

FLOATS = st.floats(allow_nan=False)


@given(st.lists(st.tuples(FLOATS, FLOATS, FLOATS), min_size=1, max_size=20))
def test_both_ways_read_the_same_bits(rows: list[tuple[float, ...]]) -> None:
    text = "".join(f"{a!r},{b!r},{c!r}\n" for a, b, c in rows)
    fast = matrix(text, 3, ",", ".")
    assert fast is not None
    assert fast.tobytes() == np.array(rows).tobytes()
    for index in range(3):
        assert column([repr(row[index]) for row in rows], ".").tobytes() == fast[:, index].tobytes()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1,2\n3,4", [[1, 2], [3, 4]]),
        ("1,2\r\n3,4\r\n", [[1, 2], [3, 4]]),
        ("1,2\n\n3,4\n", [[1, 2], [3, 4]]),
        (",2\n3,\n", [[np.nan, 2], [3, np.nan]]),
        (",\n,\n", [[np.nan, np.nan], [np.nan, np.nan]]),
        ("1,nan\n", [[1, np.nan]]),
    ],
)
def test_the_fast_way_reads_empty_cells_and_all_line_ends(text: str, expected: list[list[float]]) -> None:
    found = matrix(text, 2, ",", ".")
    assert found is not None
    assert np.array_equal(found, np.array(expected), equal_nan=True)


@pytest.mark.parametrize(
    "text",
    ["1,x\n", '1,"2"\n', "1,2,3\n", "1\n", "1,2\n3\n", "1,2\n3,4,5\n", "1,1_0\n", "\n", "1,2\r3,4\r", "1,0x10\n"],
)
def test_the_fast_way_leaves_the_rest_to_the_careful_one(text: str) -> None:
    assert matrix(text, 2, ",", ".") is None


def test_a_decimal_comma_is_read_where_it_is_announced() -> None:
    found = matrix("0,5;1,25\n2;-3,5e2\n", 2, ";", ",")
    assert found is not None
    assert found.tolist() == [[0.5, 1.25], [2.0, -350.0]]
    assert column(["0,5", "", " "], ",").tolist()[0] == 0.5
    assert matrix("0.5;1\n", 2, ";", ",") is None


@pytest.mark.parametrize(
    ("cells", "decimal", "index"),
    [(["1", "x"], ".", 1), (["1_0"], ".", 0), (["1", "1.000,5"], ",", 1), (["", "?"], ".", 1)],
)
def test_the_careful_way_says_which_cell(cells: list[str], decimal: str, index: int) -> None:
    with pytest.raises(NoNumber) as caught:
        column(cells, decimal)
    assert (caught.value.index, caught.value.text) == (index, cells[index])
