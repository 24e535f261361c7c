"""What the drive is and can do, in the words of the contract."""

from collections.abc import Iterator
from math import isnan, nan
from typing import Final

from drivers.canopen.cia301.period import cycle_s
from drivers.canopen.cia402.power_stage import SWITCH_OFF_S
from drivers.canopen.cia402.state_machine import State
from drivers.canopen.session import Session
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Description, FoundTable, Mode, Watchdog

_SOME_S: Final = 1.0  # of whatever else a call takes
_CALL_QUESTIONS: Final = 4  # that are asked in a call, where the drive is slow to answer
_HOMING_QUESTIONS: Final = 16  # more, as it is told how to home
_OPEN_S: Final = 12.0  # opening the bus, braking what was left on, the trial cycles
_OPEN_QUESTIONS: Final = 60  # of those when a drive is opened, which are answered late


def longest_call_s(settings: CanopenSettings, tries_guard: bool) -> float:
    """By then every call has returned [s]: enabling is the longest, above all with a trial of the watchdog."""
    questions_s = (_CALL_QUESTIONS + (_HOMING_QUESTIONS if settings.homing else 0)) * settings.sdo_answer_s
    enabling_s = _SOME_S + questions_s + settings.enable_s + settings.mode_s + SWITCH_OFF_S
    trial_s = 2.0 * settings.watchdog_s + settings.fault_reset_s + settings.enable_s
    return enabling_s + (trial_s if tries_guard else 0.0)


def longest_open_s(settings: CanopenSettings) -> float:
    """By then opening has returned [s]."""
    return _OPEN_S + settings.bus.adapter_start_s + settings.listen_s + _OPEN_QUESTIONS * settings.sdo_answer_s


def describe(settings: CanopenSettings, session: Session | None) -> Description:
    """Identity and capabilities; what only the drive knows is empty until it is open."""
    if session is None:
        return Description(
            settings.device, "", "", "", "", simulated=False, modes=frozenset(), measured=frozenset(), resolution={},
            max_rate_hz=nan, watchdog_s=settings.watchdog_s,
            longest_call_s=longest_call_s(settings, tries_guard=True),
            longest_open_s=longest_open_s(settings),
        )  # fmt: skip
    identity, measurement = session.found.identity, session.measurement
    on_the_bus_s = cycle_s(session.data.sizes, settings.bus.bitrate)
    return Description(
        device=settings.device,
        vendor=identity.vendor,
        product=identity.product,
        firmware=identity.firmware or f"revision 0x{identity.revision:X}",
        serial=f"{identity.serial_number:X}",
        simulated="simulat" in identity.name.lower(),
        modes=frozenset(session.found.modes),
        measured=measurement.measured,
        resolution=measurement.resolution,
        max_rate_hz=1.0 / max(session.round_trip_s, on_the_bus_s),
        watchdog_s=settings.watchdog_s,
        longest_call_s=longest_call_s(settings, not session.guard.is_told),
        longest_open_s=longest_open_s(settings),
        watchdog=Watchdog.PROVEN if session.guard.tried else Watchdog.CONFIGURED,
        notes=tuple(_notes(session)),
        tables=(_units(session), _objects(session)),
        counts_per_turn=session.found.told_counts,
        untold=session.untold,
        own_limit=session.own_limit,
    )


def _notes(session: Session) -> Iterator[str]:
    """What whoever opens the drive should know."""
    yield f"Watchdog: {session.guard.words}."
    yield session.stopping.words
    if not session.guard.is_told:
        yield "Its dictionary does not tell that reaction: it is tried each time before the first motion."
    if session.own_limit is not None:
        yield session.own_limit.words
    if not session.found.modes:
        whys = (session.table.outcome(f"mode '{mode.value}'", "mode") for mode in (Mode.CURRENT, Mode.POSITION))
        yield f"It has no mode that can be used: {'; '.join(whys)}."
    if session.left in (State.ENABLED, State.QUICK_STOP):
        yield f"A host before left the drive in state '{session.left.value}'. It was switched off."
    if isnan(session.found.scale.velocity_unit_rad_s):
        yield "The velocity counts as not measured: its unit is told by neither drive nor velocity_unit."
    if untold := session.untold:
        wants = " and ".join(["measures no current"] * untold.tells + ["takes none"] * untold.takes)
        yield f"It {wants}: {untold.remedy}."
    if not session.found.units[0].drive:
        yield "The drive does not tell its counts per turn: compare the angle of 'doctor --move' with what you see."


def _units(session: Session) -> FoundTable:
    rows = ((row.quantity, row.drive or "not told", _number(row.configuration)) for row in session.found.units)
    return FoundTable("Units", ("quantity", "by the drive", "used"), tuple(rows))


def _objects(session: Session) -> FoundTable:
    """The objects of the drive: those that are required, those that are wished, and what is done without."""
    rows = (
        (row.object, row.need.value if row.found else f"{row.need.value}, done without", row.purpose, row.outcome)
        for row in session.table.rows
    )
    return FoundTable("Objects of the drive", ("object", "need", "purpose", "outcome"), tuple(rows))


def _number(value: float) -> str:
    return "unknown" if isnan(value) else f"{value:.6g}"
