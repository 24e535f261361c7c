"""Who hangs the load."""

import pytest

from bench.control.technician import PersonTechnician, SimulatedTechnician
from bench.errors import ExperimentError
from tests.control.fake_drive import FakeDrive


def test_the_simulation_is_touched_only_when_something_changes():
    drive = FakeDrive()
    technician = SimulatedTechnician(drive)
    for load_kg, balanced in [(0.1, False), (0.1, False), (0.1, True), (0.0, True)]:
        technician.hang_load(load_kg, balanced)
    assert drive.calls == ["hang 0.1 hanging", "hang 0.1 balanced", "hang 0 balanced"]


def test_a_person_is_asked_only_when_something_changes():
    asked = []
    technician = PersonTechnician(lambda sentence: asked.append(sentence) or True)
    technician.hang_load(0.05, False)
    technician.hang_load(0.05, False)
    technician.hang_load(0.05, True)
    assert asked == [
        "Hang 50 g at the tip of the arm, and stand clear.",
        "Hang 50 g balanced, half of it on each side of the axis, and stand clear.",
    ]


def test_a_person_may_give_up():
    technician = PersonTechnician(lambda _sentence: False)
    with pytest.raises(ExperimentError, match="50 g was not hung"):
        technician.hang_load(0.05, False)
