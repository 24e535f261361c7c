"""What stands in the place of a simulated device's threads in virtual time: of its ticker, and of its side channel."""

import json
from typing import Any

from sim_backend.devices.process import Hand
from tests.commission.virtual_time import TIME
from tests.virtual import buses, ports

_HANDS: dict[str, Hand] = {}


class NoThread:
    """In the place of a device's ticker: whoever looks brings it to the present."""

    error = None

    def __init__(self, *_arguments: Any) -> None:
        pass

    def start(self) -> None:
        """Nothing runs."""

    def close(self) -> None:
        """Nothing ends."""


class Side(NoThread):
    """In the place of the side channel: its hand, by an address."""

    def __init__(self, hand: Hand, _port: int = 0) -> None:
        self.address = f"virtual:{id(hand)}"
        _HANDS[self.address] = hand

    def close(self) -> None:
        """Nobody is there any more."""
        del _HANDS[self.address]


class SideClient(NoThread):
    """In the place of its client.

    Raises:
        ConnectionError: nobody is there.
    """

    def __init__(self, address: str, _timeout_s: float = 5.0) -> None:
        if address not in _HANDS:
            raise ConnectionError(f"nobody is at {address}")
        self._hand = _HANDS[address]

    def ask(self, deed: str, **values: Any) -> dict[str, Any]:
        """Have something done: what is under way arrives first."""
        look()
        answer: dict[str, Any] = json.loads(json.dumps(self._hand.do(deed, values), default=float))
        look()
        return answer

    def hang_load(self, load_kg: float, balanced: bool) -> None:
        """Hang a load, once a power stage that was told to be off has taken a tick."""
        TIME.advance(2e-3)
        self.ask("hang", load_kg=load_kg, balanced=balanced)


def look() -> None:
    """Bring every line and every device to the present."""
    buses.look()
    for port in list(ports.PORTS.values()):
        port.look()
