"""Homing (6): the drive looks for its home position by itself, and counts from there (CiA 402-2, chapter "homing")."""

from collections.abc import Callable
from math import ceil, floor

from sim_backend.devices.axis import TICK_S, Axis
from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.modes.mode import HALT, HOMED, HOMING_FAILED, TARGET_REACHED, Mode, Seen, Units
from sim_backend.devices.canopen.modes.position_loop import PositionLoop

START = 1 << 4  # of the controlword
# of the standard: the next index pulse below or above; the present position, by its old number and by its new one
INDEX, HERE = {33: -1.0, 34: 1.0}, frozenset({35, 37})
# numbers below 0 are the maker's: this one goes down or up to an end stop, with no more torque than 0x5FF0
END_STOP = {-1: -1.0, -2: 1.0}
METHODS = frozenset({*INDEX, *HERE, *END_STOP})
NEEDED = ((0x6098, 0), (0x6099, 1), (0x6099, 2), (0x609A, 0), (0x607C, 0), (0x5FF0, 0))
PRESSES_S = 0.2  # at the highest torque, without motion
STANDS = 50.0  # counts a second, or less
FARTHEST_TURNS = 1.5  # of the motor: there is an index pulse in every turn
LEAD_S = 0.5  # of the speed, by which a search against a stop demands more than it gets


class Homing(Mode):
    """Method (0x6098), speeds (0x6099), acceleration (0x609A), home offset (0x607C).

    Bit 4 of the controlword starts, and breaks off where it falls. In the statusword bit 12 is "homing attained", 13
    "homing error" and 10 "target reached": the motor stands.

    Args:
        dictionary: the drive's.
        loop: its position controller.
        units: of the drive.
        index: the next index pulse from some counts on, in a direction.
        shift: has the encoder count so much less.
    """

    def __init__(
        self,
        dictionary: Dictionary,
        loop: PositionLoop,
        units: Units,
        index: Callable[[float, float], float],
        shift: Callable[[float], None],
        counts_per_turn: float,
    ) -> None:
        self._dictionary, self._loop, self._units = dictionary, loop, units
        self._next_index, self._shift, self._farthest = index, shift, FARTHEST_TURNS * counts_per_turn
        self._method = self._controlword = 0
        self._position = self._speed = self._begun = self._index = self._pressed_s = 0.0
        self._runs = self._homed = self._failed = False

    def start(self, seen: Seen) -> None:
        """Hold the position; what was found before counts no more."""
        self._position, self._speed = seen.counts, seen.counts_per_s
        self._controlword = self._dictionary.number(0x6040)
        self._runs = self._homed = self._failed = False
        self._loop.start()

    def command(self, controlword: int) -> None:
        """Take a controlword."""
        rising, self._controlword = controlword & ~self._controlword, controlword
        if not controlword & START:
            self._runs = False
        elif rising & START:
            self._begin(self._dictionary.number(0x6098))

    def torque(self, seen: Seen) -> float:
        """Return the torque [permille]."""
        if self._searches:
            seen = self._look(seen)
        wanted = self._wanted() if self._searches else 0.0
        step = self._units.counts_per_s2(self._dictionary.number(0x609A)) * TICK_S
        self._speed += max(-step, min(step, wanted - self._speed))
        self._position += self._speed * TICK_S
        if self._searches and self._method in END_STOP:
            lead = abs(wanted) * LEAD_S
            self._position = max(seen.counts - lead, min(seen.counts + lead, self._position))
        most, asked = self._most(), self._loop.torque(self._position, self._speed, seen)
        return max(-most, min(most, asked))

    def status(self) -> int:
        """Whether home was found, whether that failed, whether the motor stands."""
        stands = self._speed == 0.0 and not self._runs
        return (
            (HOMED if self._homed else 0)
            | (HOMING_FAILED if self._failed else 0)
            | (TARGET_REACHED if stands else 0)
        )  # fmt: skip

    @property
    def _searches(self) -> bool:
        return self._runs and not self._controlword & HALT

    def _begin(self, method: int) -> None:
        self._method, self._begun, self._pressed_s = method, self._position, 0.0
        self._homed, self._failed = False, method not in METHODS
        self._runs = not self._failed
        if method in INDEX:
            self._index = self._next_index(self._position, INDEX[method])

    def _look(self, seen: Seen) -> Seen:
        """Look whether home is here; return what is seen, counted from there if it is."""
        if self._method in HERE:
            return self._attain(seen.counts, seen)
        presses = abs(self._loop.applied_permille) >= 0.98 * self._most() and abs(seen.counts_per_s) <= STANDS
        self._pressed_s = self._pressed_s + TICK_S if presses else 0.0
        blocked = self._pressed_s >= PRESSES_S
        if self._method in END_STOP:
            return self._attain(seen.counts, seen) if blocked else seen
        if INDEX[self._method] * (seen.counts - self._index) >= 0.0:
            return self._attain(self._index, seen)
        if blocked or abs(self._position - self._begun) > self._farthest:
            self._runs, self._failed = False, True
        return seen

    def _attain(self, home: float, seen: Seen) -> Seen:
        gone = home - self._units.counts(self._dictionary.number(0x607C))
        self._shift(gone)
        self._position = (seen.counts if self._method in END_STOP else self._position) - gone
        if self._method in END_STOP:
            self._speed = 0.0
        self._runs, self._homed = False, True
        return seen._replace(counts=seen.counts - gone)

    def _wanted(self) -> float:
        way, subindex = (INDEX[self._method], 2) if self._method in INDEX else (END_STOP[self._method], 1)
        return way * self._units.counts_per_s(self._dictionary.number(0x6099, subindex))

    def _most(self) -> float:
        """The highest torque [permille]."""
        limit = self._loop.limit_permille
        return min(self._dictionary.number(0x5FF0), limit) if self._method in END_STOP else limit


def index_of(axis: Axis, counts_per_turn: float) -> Callable[[float, float], float]:
    """Return what tells the next index pulse of an encoder, which does not move where its count begins anew."""

    def following(counts: float, way: float) -> float:
        turns = (counts + axis.zero_counts) / counts_per_turn
        return (floor(turns) + 1.0 if way > 0.0 else ceil(turns) - 1.0) * counts_per_turn - axis.zero_counts

    return following
