"""The line of a key in a TOML file."""

import pytest

from bench.recording_set.text.toml_file import line_of

TEXT = """# rig
name = "x"

[motor]  # at the shaft
"resistance_ohm" = 1
[ columns.duty ]
scale=0

[[trials]]
file = "a"
[[trials]]
file = "b"
conditions = { load_kg = nan }
gear.ratio = 3
"""


@pytest.mark.parametrize(
    ("location", "line"),
    [
        (("name",), 2),
        (("motor",), 4),
        (("motor", "resistance_ohm"), 5),
        (("motor", "inductance_h"), 4),
        (("columns", "duty", "scale"), 7),
        (("trials", 0, "file"), 10),
        (("trials", 1, "file"), 12),
        (("trials", 1, "conditions", "load_kg"), 13),
        (("trials", 1, "gear", "ratio"), 14),
        (("supply",), 1),
        ((), 1),
    ],
)
def test_the_line_of_a_key_or_of_what_holds_it(location: tuple[int | str, ...], line: int) -> None:
    assert line_of(TEXT, location) == line
