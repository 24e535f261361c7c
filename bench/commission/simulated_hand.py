"""The person's hands at a simulated device: turns the arm and hangs the loads; the rest is still asked."""

from dataclasses import replace
from math import pi

from bench.commission.questions import Person, Question
from bench.config.drives.simulated_device import DriveTable
from bench.drives.far_joint import FarJoint


class SimulatedHand:
    """A person whose hands are the device's side channel."""

    def __init__(self, person: Person, joint: FarJoint) -> None:
        self._person, self._joint = person, joint

    def number(self, question: Question) -> float | None:
        """Ask; the arm is turned level for the question of its angle, and a weight that was answered is hung.

        Raises:
            ExperimentError: the device says no, or is not there.
        """
        if question.key == "hand_angle_deg":
            self._joint.hold_arm(pi / 2.0)
            return 90.0
        answer = self._person.number(replace(question, deed=False))  # these hands do it
        if question.key == "first_load_kg" and answer:
            self._joint.hang_load(answer, balanced=False)
        return answer

    def done(self, key: str, sentence: str) -> bool:
        """Do it; a person has only to agree to motion.

        Raises:
            ExperimentError: the device says no, or is not there.
        """
        if key == "down":
            self._joint.hang_load(0.0, balanced=False)
            return True
        self._joint.hang_load(0.0, balanced=False)
        self._joint.hold_arm(0.0)  # a balanced arm, or one with much friction, does not fall by itself
        self._joint.release_arm()
        return self._person.done(key, sentence)


def hands_at(section: DriveTable, person: Person) -> Person:
    """The person, or the hands of a simulated device before the person, as the drive's section says."""
    side_channel = str(section.get("side_channel", ""))
    return SimulatedHand(person, FarJoint(side_channel)) if side_channel else person
