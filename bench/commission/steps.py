"""The steps of commissioning as a person follows them: what each is for, what will move, and how far."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Step:
    """One step.

    Attributes:
        moves: what moves, how far, and what stops it; of a step without power, what is done instead.
        low_rad, high_rad: where the arm may get to by the motor; both 0 where nothing is powered.
    """

    key: str
    title: str
    moves: str
    low_rad: float = 0.0
    high_rad: float = 0.0


STEPS = (
    Step("look", "Look", "Nothing is powered. The drive says who it is, what it measures, and how fast it answers."),
    Step("know", "What you know", "Nothing is powered. You say what you know of the joint; some may be left out."),
    Step(
        "scale",
        "Zero, sign and scale",
        "Nothing is powered: your hand turns the arm. The encoder's zero, sign and scale are told from that.",
    ),
    Step(
        "push",
        "Pushes",
        "The drive's watchdog is tried. Then the motor pushes the bare arm to either side, by 26 degrees at most; it "
        "moves on by as much again. Told from it: sign of the demand, friction, inertia, resistance, back-EMF.",
        -0.9,
        0.9,
    ),
    Step(
        "signs",
        "Signs",
        "The motor pushes the bare arm to either side, by 34 degrees at most. Signs and scales have to agree.",
        -0.6,
        0.6,
    ),
    Step(
        "weigh",
        "Weigh",
        "The motor holds the arm at 23, 46 and 90 degrees, with the heaviest weight and without. Told from it: torque "
        "per current.",
        -0.15,
        1.75,
    ),
    Step(
        "signs-again",
        "Signs again",
        "The motor pushes the bare arm once more, by 34 degrees at most, with what the weight has told.",
        -0.6,
        0.6,
    ),
    Step(
        "first-load",
        "First load",
        "The motor holds the arm level with a weight that took no part in what was found so far.",
        -0.15,
        1.75,
    ),
)
