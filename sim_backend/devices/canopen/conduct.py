"""How a drive behaves where the standard leaves it open, or where it does badly: what a host has to live with."""

from dataclasses import dataclass

from sim_backend.errors import ParameterError

REACTIONS = {"nothing": 0, "fault": 1, "disable": 2, "quick-stop": 3}
"""What a drive without 0x6007 does when its host is lost, by the codes of 0x6007."""


@dataclass(frozen=True, slots=True)
class Conduct:
    """Manners of one drive.

    Attributes:
        look_s: how often it looks at the controlword [s]; 0: at each that comes.
        enable_s: from the command to operation enabled, for a brake or for finding the phase [s].
        mode_shown_enabled: 0x6061 tells the mode in operation enabled alone.
        answer_s: how late SDO answers are [s].
        absent_code: abort code where an object is not there; None: 0x06020000 or 0x06090011.
        refused_code: abort code where an object may not be written; None: 0x06010002.
        deaf: it takes what is written to 0x1016, 0x100C, 0x100D and the event timer of RPDOs, and never watches.
        sets_brake: it sets and releases the joint's brake itself; else bit 0 of 0x60FE does.
        reaction: of `REACTIONS`, where it has no 0x6007.
    """

    look_s: float = 0.0
    enable_s: float = 0.0
    mode_shown_enabled: bool = False
    answer_s: float = 0.0
    absent_code: int | None = None
    refused_code: int | None = None
    deaf: bool = False
    sets_brake: bool = False
    reaction: str = "fault"

    def __post_init__(self) -> None:
        """Refuse what no drive does.

        Raises:
            ParameterError: a time is negative, or the reaction is not known.
        """
        for name in ("look_s", "enable_s", "answer_s"):
            if not 0.0 <= getattr(self, name) <= 60.0:
                raise ParameterError(f"{name} is {getattr(self, name)} s; 0 .. 60 s is allowed")
        if self.reaction not in REACTIONS:
            raise ParameterError(f"reaction '{self.reaction}' is unknown; known are {', '.join(REACTIONS)}")


GOOD = Conduct()
