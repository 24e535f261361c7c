"""One number of a file is changed, and nothing else."""

import pytest

from bench.config.toml_text import set_number
from bench.errors import ConfigurationError

TEXT = """# mine
[rig]
zero_rad = 7.0 # not this one

[drive] # the drive
kind = "roboclaw"
zero_rad = -0.25   # by hand

[limits]
zero_rad = 8.0
"""


def test_the_number_changes_and_comments_and_order_stay(tmp_path):
    file = tmp_path / "bench.toml"
    file.write_text(TEXT)
    set_number(file, "drive", "zero_rad", 1.5)
    assert file.read_text() == TEXT.replace("-0.25", "1.5")


def test_a_key_that_is_not_there_is_added_to_its_table(tmp_path):
    file = tmp_path / "bench.toml"
    file.write_text('[drive]\nkind = "roboclaw"\n\n[limits]\ncurrent_a = 1.0\n')
    set_number(file, "drive", "zero_rad", 1.5)
    assert file.read_text() == '[drive]\nzero_rad = 1.5\nkind = "roboclaw"\n\n[limits]\ncurrent_a = 1.0\n'


@pytest.mark.parametrize("text", ["drive = { zero_rad = 1.0 }\n", 'drive.zero_rad = 1.0\nname = "x"\n'])
def test_a_file_that_is_written_in_another_way_is_left_alone(tmp_path, text):
    file = tmp_path / "bench.toml"
    file.write_text(text)
    with pytest.raises(ConfigurationError, match=r"has no line \[drive\]; write zero_rad = 1\.5 into it by hand"):
        set_number(file, "drive", "zero_rad", 1.5)
    assert file.read_text() == text
