"""Which ODrive axes are on a CAN bus."""

from collections.abc import Iterator

from bench.config.drives.scanning import CanPlace, FoundDrive

_LISTEN_S = 0.3  # a heartbeat comes every 0.1 s


def scan(place: CanPlace) -> Iterator[FoundDrive]:
    """Listen for heartbeats; nothing is sent. A node whose heartbeat is as long and as seldom looks the same."""
    from drivers.can_bus.port import CanPort
    from drivers.can_bus.settings import BusSettings
    from drivers.odrive.protocol import HEARTBEAT, Command

    port = CanPort(BusSettings(place.interface, place.channel, place.bitrate))
    try:
        port.wait_for([-1], _LISTEN_S)  # which never comes
        for identifier in port.heard_ids():
            heard = port.last(identifier)
            is_heartbeat = identifier & 31 == Command.HEARTBEAT and heard is not None
            if is_heartbeat and heard is not None and len(heard.data) >= HEARTBEAT.size:
                yield FoundDrive(f"ODrive axis, in state {HEARTBEAT.unpack_from(heard.data)[1]}", {
                    "kind": "odrive", "interface": place.interface, "channel": place.channel,
                    "bitrate": place.bitrate, "node_id": identifier >> 5, "watchdog_is_set_in_drive": False,
                })  # fmt: skip
    finally:
        port.close()
