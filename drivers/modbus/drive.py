"""The drive contract on a register map."""

from drivers.contract import Description
from drivers.host_time import CycleTime, Lateness
from drivers.joint import JointScale
from drivers.modbus.link import Link
from drivers.modbus.register_map import RegisterMap
from drivers.modbus.sampling import Sampling
from drivers.modbus.session import ENABLING_S, Session
from drivers.modbus.settings import ModbusSettings
from drivers.polled_drive import Identity, PolledDrive

_OPENING_REQUESTS = 24


class ModbusDrive(PolledDrive[Session]):
    """One drive with one joint."""

    def __init__(self, settings: ModbusSettings, register_map: RegisterMap, joint: JointScale) -> None:
        super().__init__(
            settings.device,
            register_map.modes,
            Lateness(settings.device, "watchdog", _watchdog_s(settings, register_map)),
            connect=lambda: Session(settings, register_map, joint),
            describe=lambda session, cycle: _describe(settings, register_map, joint, session, cycle),
        )


def _watchdog_s(settings: ModbusSettings, register_map: RegisterMap) -> float:
    """Silence after which the drive stops by itself [s]: as set, or as its map has it."""
    return settings.watchdog_s if register_map.watchdog.register else register_map.watchdog.fixed_s


def _describe(
    settings: ModbusSettings,
    register_map: RegisterMap,
    joint: JointScale,
    session: Session | None,
    cycle: CycleTime | None,
) -> Description:
    """Identity and capabilities; rate, firmware and serial number are known once it is open."""
    family = register_map.identity
    identity = Identity(family.vendor, family.product) if session is None else session.identity
    sampling, link_s = Sampling(register_map, joint), Link.longest_call_s(settings)
    notes = () if session is None or cycle is None else (*session.notes, cycle.note)
    return Description(
        device=settings.device,
        **identity._asdict(),
        modes=register_map.modes,
        measured=sampling.measured,
        resolution=sampling.resolution,
        max_rate_hz=0.0 if cycle is None else 1.0 / cycle.quickest_s,
        watchdog_s=_watchdog_s(settings, register_map),
        longest_call_s=link_s + ENABLING_S,
        longest_open_s=_OPENING_REQUESTS * link_s + ENABLING_S,
        notes=tuple(filter(None, notes)),
    )
