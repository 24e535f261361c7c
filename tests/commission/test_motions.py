"""A motion of commissioning that a late host has spoilt is made again; one that the joint has ended is not."""

from types import SimpleNamespace

import numpy as np
import pytest

from bench.commission import motions
from bench.commission.flow import Commission, check_modes
from bench.commission.questions import CommissionError
from bench.config.configuration import default_configuration
from drivers.contract import Mode

BENCH = default_configuration()
LATE, NOT_LATE = {"overruns": 20}, {"overruns": 1}
NO_TRIAL = {"none": "on record"}  # it ended in the trial of the watchdog
FRESH_S, OLD_S = 0.5 * BENCH.limits.sample_age_s, 2.0 * BENCH.limits.sample_age_s


class Ended:
    """A store of experiments that ended so; and what runs them, one after the other."""

    def __init__(self, *endings):
        self._endings, self.ran, self.hung = endings, 0, []

    def to_its_end(self, _runner, request, *_arguments):
        self.hung.append(request.hung)
        self.ran += 1
        return self.ran

    def experiment(self, number):
        return SimpleNamespace(id=number, outcome=self._endings[number - 1][0], reason="age of the sample")

    def trials(self, number):
        results = self._endings[number - 1][1]
        return [] if results is NO_TRIAL else [SimpleNamespace(id=number, results=results)]

    def recording(self, number):
        return SimpleNamespace(channels={"age_s": np.array([FRESH_S, self._endings[number - 1][1].get("age_s", 0.0)])})


def run(monkeypatch, *endings):
    ended = Ended(*endings)
    monkeypatch.setattr(motions, "to_its_end", ended.to_its_end)
    found = motions.Motions(None, ended).run(BENCH, "identification", {}, (0.0, False))
    return found, ended


@pytest.mark.parametrize(
    "ending", [("tripped", LATE), ("failed", LATE), ("tripped", NOT_LATE | {"age_s": OLD_S}), ("tripped", NO_TRIAL)]
)
def test_a_late_host_is_no_reason_to_give_up(monkeypatch, ending):
    found, ended = run(monkeypatch, ending, ("completed", {}))
    assert (found.id, ended.ran) == (2, 2)
    assert ended.hung == [(0.0, False), None], "what the spoilt one has left on the arm is not known"


@pytest.mark.parametrize(
    ("endings", "runs"),
    [
        ([("tripped", NOT_LATE)], 1),
        ([("failed", NO_TRIAL)], 1),  # the watchdog does not stop the drive
        ([("stopped", LATE)], 1),  # a person has stopped it
        ([("tripped", LATE)] * 3, 3),
    ],
)
def test_what_the_joint_or_a_person_has_ended_is_over(monkeypatch, endings, runs):
    ended = Ended(*endings)
    monkeypatch.setattr(motions, "to_its_end", ended.to_its_end)
    with pytest.raises(CommissionError, match="identification"):
        motions.Motions(None, ended).run(BENCH, "identification", {}, (0.0, False))
    assert ended.ran == runs


def test_cycles_that_move_no_joint_are_not_counted(monkeypatch):
    _, few = run(monkeypatch, ("completed", NOT_LATE))
    _, many = run(monkeypatch, ("completed", LATE))
    ran = few.experiment(1)
    assert motions.Motions(None, few).lost_cycles(ran, BENCH) == 0
    assert motions.Motions(None, many).lost_cycles(ran, BENCH) == 20


@pytest.mark.parametrize("modes", [{Mode.TORQUE}, {Mode.POSITION}])
def test_a_drive_that_takes_neither_a_current_nor_a_duty_is_refused_before_anything_is_asked(modes):
    described = SimpleNamespace(device="can0 node 5", modes=frozenset({Mode.OFF, *modes}))
    with pytest.raises(CommissionError, match=r"can0 node 5.*modes: found .*(torque|position).*step by step.*doctor"):
        check_modes(described)
    check_modes(SimpleNamespace(device="can0 node 5", modes=frozenset({Mode.DUTY, *modes})))


def test_commissioning_refuses_such_a_drive_with_its_first_look():
    described = SimpleNamespace(device="can0 node 5", modes=frozenset({Mode.TORQUE}))
    looked = SimpleNamespace(look=lambda _table: SimpleNamespace(description=described))
    table = SimpleNamespace(looking=lambda: None)
    with pytest.raises(CommissionError, match="found torque"):
        Commission(table, None, looked, None).run()
