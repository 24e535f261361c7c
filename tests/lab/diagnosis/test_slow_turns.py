"""A bare motor that turns slowly one way: most of its effort is cogging, and none of it is a fault of the data."""

import numpy as np
import pytest

from compensator.lab.diagnosis.alien_effort import alien_effort
from compensator.lab.diagnosis.data_checks import data_problems
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing

ORDER, RATE_HZ, TURN_S = 7.0, 200.0, 10.0


def turn(seed: int, lead: float) -> Recording:
    """One turn; the rotor of a weak servo lags behind the even turning over one pole and leads over the next."""
    random = np.random.default_rng(seed)
    time_s = np.arange(0.0, TURN_S, 1.0 / RATE_HZ)
    place = 2.0 * np.pi * time_s / TURN_S
    position = place + lead * np.sin(ORDER * place + 0.3 * random.standard_normal())
    effort = 0.4 + 0.8 * np.sin(ORDER * position) + 0.01 * random.standard_normal(len(time_s))
    counts = 2.0 * np.pi / 8192.0
    channels = {"time_s": time_s, "position_rad": counts * np.round(position / counts), "current_a": effort}
    return Recording(f"turn-{seed}", "slow", {"repeat": seed}, channels)


def fitted(turns: int, lead: float) -> Fit:
    dataset = make_dataset([turn(seed, lead) for seed in range(turns)], Facts(), Processing(10.0))
    return fit_model(dataset, default_effects(Facts()))


@pytest.mark.parametrize(("lead", "remedy"), [(0.03, "lay the clocks"), (0.06, "turn the sign")])
def test_half_a_period_later_or_turned_the_effort_would_seem_to_push(lead, remedy):
    """Else the test below would hold nothing."""
    fit = fitted(6, lead)
    found = alien_effort(fit)
    assert found is not None
    assert remedy in found.text
    assert found.text in data_problems(fit)


@pytest.mark.parametrize("lead", [-0.06, 0.03, 0.06])
def test_cogging_is_named_where_several_turns_tell_and_no_fault_is_claimed(lead):
    found = diagnose(fitted(6, lead))
    assert found.verdict == "missing", found.sentence
    assert "cogging" in found.classes[0]
    assert found.candidates[0].gain.value > 0.5
    assert not found.data_problems
