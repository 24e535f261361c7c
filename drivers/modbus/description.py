"""What a drive is and can do, in the words of the contract: what its map says, and what it has said itself."""

from drivers.contract import Description
from drivers.joint import JointScale
from drivers.modbus.link import Link
from drivers.modbus.opening import UNKNOWN
from drivers.modbus.register_map import RegisterMap
from drivers.modbus.sampling import Sampling
from drivers.modbus.session import Session
from drivers.modbus.settings import ModbusSettings

ENABLING_S = 0.5  # longest wait for the drive to say that it is on
_OPENING_REQUESTS = 12


def watchdog_s(settings: ModbusSettings, register_map: RegisterMap) -> float:
    """Silence after which the drive stops by itself [s]: as set, or as its map has it."""
    return settings.watchdog_s if register_map.watchdog.register else register_map.watchdog.fixed_s


def describe(
    settings: ModbusSettings, register_map: RegisterMap, joint: JointScale, session: Session | None, rate_hz: float
) -> Description:
    """Identity and capabilities; rate, firmware and serial number are known once it is open."""
    identity = UNKNOWN if session is None else session.identity
    sampling, link_s = Sampling(register_map, joint), Link.longest_call_s(settings)
    return Description(
        device=settings.device,
        vendor=register_map.identity.vendor,
        product=identity.product or register_map.identity.product,
        firmware=identity.firmware,
        serial=identity.serial,
        simulated=identity.simulated,
        modes=register_map.modes,
        measured=sampling.measured,
        resolution=sampling.resolution,
        max_rate_hz=rate_hz,
        watchdog_s=watchdog_s(settings, register_map),
        longest_call_s=link_s + ENABLING_S,
        longest_open_s=_OPENING_REQUESTS * link_s + ENABLING_S,
    )
