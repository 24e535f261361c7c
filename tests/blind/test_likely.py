"""What the lab says to be likely is an answer of its own: right or wrong, as a name is."""

from types import SimpleNamespace
from typing import Any

import pytest

from bench.evaluation.blind import judge
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.gain import Gain


@pytest.mark.parametrize(
    ("low", "too_short", "verdict", "first"),
    [
        (-0.01, False, "likely", ("spring", "cogging")),
        (-0.01, True, "nothing", ()),
        (0.1, False, "nothing", ()),  # it lacks something else
    ],
)
def test_a_likely_effect_counts_as_a_name(monkeypatch, low, too_short, verdict, first):
    refused = "" if low < 0.0 else "explains little beside backlash, which cannot be it"
    one = Candidate(
        effect_named("spring"),
        (),
        50.0,
        0.001,
        7.0,
        ("cogging",),
        0.1,
        0.08,
        Gain(0.2, low, 0.3),
        None,
        refused=refused,
    )
    found = SimpleNamespace(
        verdict="nothing", candidates=[one], classes=[("spring",)], remains=False, p_value=0.004, too_short=too_short
    )
    monkeypatch.setattr(judge, "diagnose", lambda _: found)
    monkeypatch.setattr(judge, "fit_effects", lambda fit, names: fit)
    monkeypatch.setattr(judge, "held_out", lambda _: SimpleNamespace(relative=0.1))
    fit: Any = SimpleNamespace(names=("coulomb",))
    answer = judge.ask_lab(fit, several=False)
    assert (answer.verdict, answer.first, answer.named) == (verdict, first, (first,) if first else ())
