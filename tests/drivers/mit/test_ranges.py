"""Ranges of every model: each number of a frame stays in its own bits, and what is not known is refused."""

import pytest

from drivers.cubemars import protocol as cubemars
from drivers.damiao import protocol as damiao
from drivers.errors import DriveConfigurationError
from drivers.mit.actuator import chosen_ranges
from drivers.mit.frames import command
from drivers.robstride import protocol as robstride

SHORT = {**damiao.MODELS, **cubemars.MODELS}


@pytest.mark.parametrize("model", SHORT)
def test_the_braking_of_a_quick_stop_stays_in_its_field(model):
    ranges = SHORT[model]
    word = int.from_bytes(command(ranges, 0.0, ranges.braking_damping), "big")
    assert word >> 24 & 0xFFF == 0, "a stiffness: it would turn to a position"
    assert 0 < word >> 12 & 0xFFF <= 0xFFF


@pytest.mark.parametrize("model", robstride.MODELS)
def test_the_same_of_words_of_sixteen_bits(model):
    ranges = robstride.MODELS[model]
    _, data = robstride.command(1, ranges, 0.0, ranges.braking_damping)
    assert data[4:6] == bytes(2)
    assert int.from_bytes(data[6:8], "big") > 0


@pytest.mark.parametrize(
    ("model", "written"),
    [("", (0.0, 0.0, 0.0)), ("AK80-9", (12.5, 50.0, 18.0)), ("", (12.5, 50.0, 0.0))],
)
def test_a_guess_is_refused(model, written):
    with pytest.raises(DriveConfigurationError, match="either a model or all three are wanted"):
        chosen_ranges("can0 motor 1", model, cubemars.MODELS, written)


def test_a_model_or_written_ranges():
    assert chosen_ranges("", "AK80-9", cubemars.MODELS, (0.0, 0.0, 0.0)) == (12.5, 50.0, 18.0, 5.0)
    assert chosen_ranges("", "", cubemars.MODELS, (12.5, 25.64, 18.0)) == (12.5, 25.64, 18.0, 5.0)
