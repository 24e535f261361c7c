"""Who hangs the load on the arm: the simulation itself, or a person who is asked."""

from collections.abc import Callable
from typing import Protocol, runtime_checkable

from bench.errors import ExperimentError


@runtime_checkable
class Technician(Protocol):
    """Prepares the arm for a trial. Called with the power off."""

    def hang_load(self, load_kg: float, balanced: bool) -> None:
        """Hang a load at the tip; balanced: the same weight on the axis without a moment."""


class SimulatedTechnician:
    """Hangs the load on a simulated joint, and only when something has to change, as a person would."""

    def __init__(self, joint: Technician) -> None:
        self._joint = joint
        self._hung: tuple[float, bool] | None = None

    def hang_load(self, load_kg: float, balanced: bool) -> None:
        """Hang a load at once."""
        if self._hung == (load_kg, balanced):
            return
        self._joint.hang_load(load_kg, balanced)
        self._hung = (load_kg, balanced)


class PersonTechnician:
    """Asks a person, and only when something has to change.

    Args:
        ask: shows a sentence and returns True when it is done, False when the person gives up.
    """

    def __init__(self, ask: Callable[[str], bool]) -> None:
        self._ask = ask
        self._hung: tuple[float, bool] | None = None

    def assume(self, load_kg: float, balanced: bool) -> None:
        """It hangs already, as the experiment before left it: nobody is asked for it."""
        self._hung = (load_kg, balanced)

    def hang_load(self, load_kg: float, balanced: bool) -> None:
        """Ask for a load.

        Raises:
            ExperimentError: the person gave up.
        """
        if self._hung == (load_kg, balanced):
            return
        if not self._ask(_request(load_kg, balanced)):
            raise ExperimentError(f"the load of {load_kg * 1000:g} g was not hung; start again when it can be")
        self._hung = (load_kg, balanced)


def _request(load_kg: float, balanced: bool) -> str:
    if load_kg == 0.0:
        return "Take every load off the arm, and stand clear."
    how = "balanced, half of it on each side of the axis" if balanced else "at the tip of the arm"
    return f"Hang {load_kg * 1000:g} g {how}, and stand clear."
