"""What the controller is and can do, in the words of the contract."""

from drivers.contract import Description, Mode
from drivers.roboclaw.identity import Identity
from drivers.roboclaw.link import Link
from drivers.roboclaw.session import Session
from drivers.roboclaw.settings import RoboclawSettings

MODES = frozenset({Mode.DUTY})
_UNKNOWN = Identity("", "", simulated=False)
_OPENING_QUESTIONS = 12  # at most, of which each may be met with silence


def describe(settings: RoboclawSettings, session: Session | None, rate_hz: float) -> Description:
    """Identity and capabilities; what only the controller knows is empty until it is open."""
    identity = _UNKNOWN if session is None else session.identity
    telemetry, link_s = None if session is None else session.telemetry, Link.longest_call_s(settings)
    return Description(
        device=settings.device,
        vendor="Basicmicro",
        product=identity.product,
        firmware=identity.firmware,
        serial="",
        simulated=identity.simulated,
        modes=MODES,
        measured=frozenset() if telemetry is None else telemetry.measured,
        resolution={} if telemetry is None else telemetry.resolution,
        max_rate_hz=rate_hz,
        watchdog_s=settings.set_watchdog_s,
        longest_call_s=link_s,
        longest_open_s=_OPENING_QUESTIONS * link_s,
    )
