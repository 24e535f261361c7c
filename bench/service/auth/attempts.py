"""Wrong tokens, counted per network address: after some in a row, the next ones have to wait."""

import ipaddress
import time
from collections import OrderedDict
from collections.abc import Callable

BURST = 10  # wrong tokens that an address may send at once ...
REFILL_S = 6.0  # ... and one more after each of these
MOST_ADDRESSES = 4096
IPV6_PREFIX = 64  # what one customer is given: any of its addresses is the same client


class Attempts:
    """A token bucket per client address. Used on the event loop alone.

    It keeps wrong tokens away from database, log and processor. It is no protection of the right one, which its 256
    bits are; so a right token is never asked to wait.
    """

    def __init__(self, now_s: Callable[[], float] = time.monotonic) -> None:
        self._now_s = now_s
        self._full_at_s: OrderedDict[str, float] = OrderedDict()  # when an address has its whole burst again

    def wait_s(self, address: str) -> float:
        """How long the address has to wait before its next wrong token is looked at; 0 where it need not."""
        behind_s = self._full_at_s.get(_client(address), 0.0) - self._now_s()
        return max(0.0, behind_s - (BURST - 1) * REFILL_S)

    def failed(self, address: str) -> None:
        """A wrong token came from the address."""
        client, now_s = _client(address), self._now_s()
        self._full_at_s[client] = max(now_s, self._full_at_s.get(client, 0.0)) + REFILL_S
        self._full_at_s.move_to_end(client)
        while len(self._full_at_s) > MOST_ADDRESSES:
            self._full_at_s.popitem(last=False)


def _client(address: str) -> str:
    try:
        found = ipaddress.ip_address(address)
    except ValueError:
        return address
    if found.version == 4:
        return address
    return str(ipaddress.ip_network((address, IPV6_PREFIX), strict=False))
