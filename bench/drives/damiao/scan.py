"""Which Damiao actuators are on a CAN bus."""

from collections.abc import Iterator

from bench.config.drives.scanning import CanPlace, FoundDrive

_IDS = range(1, 33)
_ANSWER_S = 0.01


def scan(place: CanPlace) -> Iterator[FoundDrive]:
    """Ask each of the usual ids for its range of torques: the reading of a register."""
    from drivers.can_bus.port import CanPort
    from drivers.can_bus.settings import BusSettings
    from drivers.damiao import protocol

    port = CanPort(BusSettings(place.interface, place.channel, place.bitrate))
    try:
        for motor_id in _IDS:
            frame = protocol.register_frame(motor_id, protocol.READ, protocol.Register.TORQUE_RANGE)
            port.send(protocol.REGISTERS_ID, frame)
            port.wait_for([-1], _ANSWER_S)  # which never comes
            for identifier in port.heard_ids():
                heard = port.last(identifier)
                if heard and protocol.is_register(heard.data, motor_id, protocol.Register.TORQUE_RANGE):
                    torque_n_m = protocol.FLOAT.unpack(heard.data[4:])[0]
                    yield FoundDrive(f"Damiao actuator, range of torques {torque_n_m:g} N m", {
                        "kind": "damiao", "interface": place.interface, "channel": place.channel,
                        "bitrate": place.bitrate, "motor_id": motor_id, "feedback_id": identifier,
                    })  # fmt: skip
    finally:
        port.close()
