"""The drive contract on one motor of a RoboClaw: signed duty in; position, applied duty, current, supply out."""

from drivers.contract import Description, Mode
from drivers.host_time import CycleTime, Lateness
from drivers.joint import JointScale
from drivers.polled_drive import Identity, PolledDrive
from drivers.roboclaw.link import Link
from drivers.roboclaw.opening import VENDOR
from drivers.roboclaw.session import Session
from drivers.roboclaw.settings import RoboclawSettings

_MODES = frozenset({Mode.DUTY})
_OPENING_QUESTIONS = 24  # at most, of which each may be met with silence


class RoboclawDrive(PolledDrive[Session]):
    """One brushed DC motor with its encoder.

    A RoboClaw has no state of its own between a demand and the next: a duty of 0 brakes, the serial time-out
    (commands 14 and 15) stops the motor, a fault stops it too. The states of the contract are kept in the session.
    """

    def __init__(self, settings: RoboclawSettings, joint: JointScale) -> None:
        super().__init__(
            settings.device,
            _MODES,
            Lateness(settings.device, "serial time-out", settings.set_watchdog_s),
            connect=lambda: Session(settings, joint),
            describe=lambda session, cycle: _describe(settings, session, cycle),
        )


def _describe(settings: RoboclawSettings, session: Session | None, cycle: CycleTime | None) -> Description:
    """Identity and capabilities; what only the controller knows is empty until it is open."""
    identity = Identity(VENDOR, "") if session is None else session.identity
    telemetry, link_s = None if session is None else session.telemetry, Link.longest_call_s(settings)
    notes = () if session is None or cycle is None else (*session.notes, cycle.note)
    return Description(
        device=settings.device,
        **identity._asdict(),
        modes=_MODES,
        measured=frozenset() if telemetry is None else telemetry.measured,
        resolution={} if telemetry is None else telemetry.resolution,
        max_rate_hz=0.0 if cycle is None else 1.0 / cycle.quickest_s,
        watchdog_s=settings.set_watchdog_s,
        longest_call_s=link_s,
        longest_open_s=_OPENING_QUESTIONS * link_s,
        notes=tuple(filter(None, notes)),
    )
