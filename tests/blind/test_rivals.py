import numpy as np
import pytest

from bench.evaluation.blind.baseline_methods import RIVALS
from tests.blind.columns import ROWS, gathered, independent


@pytest.mark.parametrize("name", RIVALS)
def test_each_rival_names_a_strong_effect_and_nothing_in_white_noise(name: str) -> None:
    one, other, third, noise = independent(1, 4)
    blocks = {"one": one, "other": other, "third": third}
    assert RIVALS[name](gathered(0.5 * other + noise, blocks))[0] == "other"
    assert RIVALS[name](gathered(noise, blocks)) == ()


def test_stepwise_takes_one_after_the_other_as_long_as_the_criterion_falls() -> None:
    one, other, third, noise = independent(2, 4)
    effort = 0.5 * one + 0.2 * other + noise
    found = RIVALS["stepwise BIC"](gathered(effort, {"one": one, "other": other, "third": third}))
    assert found == ("one", "other")
    # a gain of less than ln N is not worth a parameter
    weak = 0.9 * np.sqrt(np.log(ROWS) / ROWS)
    found = RIVALS["stepwise BIC"](gathered(0.5 * one + weak * other + noise, {"one": one, "other": other}))
    assert found == ("one",)
