"""The drive contract on one axis of an ODrive, and a listener to one that another host drives."""

from math import nan

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.reading import Reading
from drivers.can_bus.follower import BusFollower
from drivers.can_bus.port import CanPort, Heard, on_bus
from drivers.contract import Mode
from drivers.errors import DriveConfigurationError
from drivers.joint import JointScale
from drivers.odrive import protocol
from drivers.odrive.actuator import STATE_S, OdriveActuator
from drivers.odrive.protocol import Command, can_id
from drivers.odrive.settings import OdriveSettings

_MODES = frozenset({Mode.TORQUE})
_OPENING_QUESTIONS = 8
_NEW_S = 0.05  # a current that is older is not that of the motion
_TOLD_S = 5.0  # what changes slowly


class OdriveDrive(ActuatorDrive[OdriveActuator]):
    """One axis with its joint, by torque; `rig.motor.torque_constant_n_m_a` makes one of a current."""

    def __init__(self, settings: OdriveSettings, joint: JointScale) -> None:
        answer_s = 2 * settings.answer_timeout_s + STATE_S
        family = Family(
            settings.device, "ODrive", _MODES, "watchdog", settings.watchdog_s, answer_s + STATE_S,
            _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(family, joint, lambda: _opened(settings, joint))


def _opened(settings: OdriveSettings, joint: JointScale) -> OdriveActuator:
    if not settings.bus.sends_remote_frames:
        raise DriveConfigurationError(
            settings.device,
            f"python-can sends no remote frames over {settings.bus.interface}, and CANSimple asks with them; use "
            "socketcan or slcan",
        )
    return on_bus(settings.bus, lambda port, leave: OdriveActuator(port, settings, joint, leave))


def follow(settings: OdriveSettings, joint: JointScale) -> BusFollower:
    """Listen to it.

    Raises:
        DriveConnectionError: the bus does not open.
    """

    def told(port: CanPort, command: Command, now_s: float, longest_s: float) -> tuple[float, float]:
        heard = port.last(can_id(settings.node_id, command))
        if heard is None or now_s - heard.at_s > longest_s or len(heard.data) < protocol.PAIR.size:
            return nan, nan
        first, second = protocol.PAIR.unpack_from(heard.data)
        return first, second

    def taken(port: CanPort, heard: Heard) -> Reading | None:
        if len(heard.data) < protocol.PAIR.size:
            return None
        turns, turns_s = protocol.PAIR.unpack_from(heard.data)
        beat = port.last(can_id(settings.node_id, Command.HEARTBEAT))
        errors, state = (0, 0) if beat is None else protocol.HEARTBEAT.unpack_from(beat.data)[:2]
        _, current_a = told(port, Command.GET_IQ, heard.at_s, _NEW_S)
        supply_v, _ = told(port, Command.GET_BUS, heard.at_s, _TOLD_S)
        temperature_c = max(told(port, Command.GET_TEMPERATURE, heard.at_s, _TOLD_S))
        return Reading(
            heard.at_s, turns * joint.counts_per_turn, turns_s * joint.counts_per_turn, nan, current_a, nan, supply_v,
            temperature_c, state == protocol.CLOSED_LOOP, protocol.error_names(errors),
        )  # fmt: skip

    estimates = can_id(settings.node_id, Command.GET_ENCODER_ESTIMATES)
    return BusFollower(settings.bus, estimates, ("ODrive axis", settings.device), taken, joint)
