"""What a person is asked: each question with its unit, what is allowed, and what happens without an answer."""

from dataclasses import dataclass, replace
from typing import Protocol

from bench.errors import BenchError


class CommissionError(BenchError, RuntimeError):
    """Raised when a step has left doubt, or a person has given up: what was found, what is wanted, what to do."""


class AnswerError(CommissionError, ValueError):
    """Raised when an answer is missing, or out of what is allowed."""


@dataclass(frozen=True, slots=True)
class Question:
    """A number that a person may know.

    Attributes:
        key: short name, for programs that answer.
        sentence: as it is asked.
        unit: of the answer; "" for a number.
        least, most: what is allowed.
        optional: whether "not known" is an answer.
        deed: whether it is about what hands have just done: an answer known before does not stand for the deed.
    """

    key: str
    sentence: str
    unit: str
    least: float
    most: float
    optional: bool = False
    deed: bool = False

    def check(self, answer: float | None) -> float | None:
        """The answer, if it can be.

        Raises:
            AnswerError: it is missing, or out of what is allowed.
        """
        if answer is None:
            if self.optional:
                return None
            raise AnswerError(f"{self.key}: an answer is needed: {self.sentence}")
        if not self.least <= answer <= self.most:
            allowed = f"{self.least:g} .. {self.most:g} {self.unit}".strip()
            raise AnswerError(f"{self.key} is {answer:g} {self.unit}; allowed is {allowed}".replace("  ", " "))
        return answer


ARM_LENGTH = Question("arm_length_m", "How far from the axis does the load hang?", "m", 0.02, 3.0)
GEAR_RATIO = Question("gear_ratio", "How many turns does the motor make for one of the joint?", "", 1.0, 5000.0, True)
COUNTS = Question("counts_per_turn", "How many counts does the encoder give a motor turn?", "", 4.0, 1e8, True)
MOTOR_CURRENT = Question("motor_current_a", "What is the highest current that the motor may have?", "A", 0.02, 500.0)
LOAD = Question("load_kg", "What weight can you hang on the arm, the heaviest that it is to carry?", "kg", 0.005, 50.0)
FIRST_LOAD = Question(
    "first_load_kg",
    "Hang another weight that you know, as a trial, and stand clear. How heavy is it?",
    "kg",
    0.0,
    50.0,
    deed=True,
)
RESISTANCE = Question("resistance_ohm", "What is the resistance of the motor's winding?", "ohm", 1e-3, 1e4)
BACK_EMF = Question("back_emf_v_s_rad", "What is the motor's back-EMF (torque) constant?", "V s/rad", 1e-5, 1e2)
SUPPLY = Question("supply_v", "What is the supply voltage?", "V", 1.0, 1000.0)
HAND_ANGLE = Question(
    "hand_angle_deg",
    "Turn the arm by hand to a known angle on the side that is to be positive, best level (90), and hold it there. "
    "Which angle?",
    "degrees",
    20.0,
    180.0,
    deed=True,
)


class Person(Protocol):
    """Who stands at the bench, or a program in the place of one."""

    def number(self, question: Question) -> float | None:
        """The answer to a question; None where it is not known."""

    def done(self, key: str, sentence: str) -> bool:
        """Have something done; False where the person gives up."""


@dataclass(frozen=True, slots=True)
class Known:
    """What the person knows; None where not."""

    arm_length_m: float
    motor_current_a: float
    load_kg: float
    gear_ratio: float | None
    counts_per_turn: float | None
    resistance_ohm: float | None = None
    back_emf_v_s_rad: float | None = None
    supply_v: float | None = None


def ask(person: Person, question: Question) -> float | None:
    """Ask, and check the answer.

    Raises:
        CommissionError: it is missing, or out of what is allowed.
    """
    return question.check(person.number(question))


def need(person: Person, question: Question) -> float:
    """Ask for what cannot be done without.

    Raises:
        CommissionError: as `ask`.
    """
    answer = ask(person, replace(question, optional=False))
    assert answer is not None
    return answer


def ask_all(person: Person, measured: frozenset[str], closes_current: bool) -> Known:
    """What a person knows of the joint, and of what the drive does not measure.

    Args:
        person: is asked.
        measured: fields of `Sample` that the drive measures.
        closes_current: whether the drive has a current mode.

    Raises:
        CommissionError: an answer is missing, or out of what is allowed.
    """
    by_data_sheet = not closes_current and "current_a" not in measured
    needs_supply = not closes_current and "supply_v" not in measured
    return Known(
        arm_length_m=need(person, ARM_LENGTH),
        gear_ratio=ask(person, GEAR_RATIO),
        counts_per_turn=ask(person, COUNTS),
        motor_current_a=need(person, MOTOR_CURRENT),
        load_kg=need(person, LOAD),
        resistance_ohm=need(person, RESISTANCE) if by_data_sheet else None,
        back_emf_v_s_rad=need(person, BACK_EMF) if by_data_sheet else None,
        supply_v=need(person, SUPPLY) if needs_supply else None,
    )
