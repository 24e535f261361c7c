"""Opening a CAN bus of python-can, sending on it and closing it in bounded time."""

import errno
import socket
import time
from contextlib import suppress

import can

from drivers.can_bus.bounded import bounded
from drivers.can_bus.settings import BusSettings
from drivers.can_bus.slcan_bus import SlcanBus
from drivers.errors import DriveConnectionError

_OPEN_S = 3.0
_CLOSE_S = 1.0
_KNOCK_S = 2.0
_SEND_S = 0.02  # longest wait for room in the transmit buffer
_RETRY_S = 0.0005

_NEXT_STEP = {
    "socketcan": "is the interface there and up? `ip link set {channel} up type can bitrate {bitrate}`",
    "slcan": "is the adapter plugged in, the port right and nobody else using it?",
    "socketcand": "does socketcand run at {host}:{port}, and does it offer {channel}?",
    "virtual": "it exists inside one process only",
}
_WITHOUT_DRIVER = (
    ImportError,
    NameError,
    AttributeError,
)  # what interfaces raise where the vendor's library is missing
_ANY_STEP = "is the adapter plugged in, its driver installed, and `channel` as python-can's documentation has it?"


def open_bus(settings: BusSettings, device: str) -> can.BusABC:
    """Open a bus.

    Raises:
        DriveConnectionError: it is not there, or does not open in time.
    """
    arguments = settings.arguments()
    timeout_s = _OPEN_S + settings.adapter_start_s
    try:
        if settings.interface == "socketcand":
            # python-can would knock ten seconds long, without a pause
            socket.create_connection((settings.host, settings.port), timeout=_KNOCK_S).close()
        if settings.interface != "slcan":
            return bounded(lambda: can.Bus(**arguments), timeout_s, undo=lambda bus: bus.shutdown())
        del arguments["interface"], arguments["ignore_config"]
        return bounded(lambda: SlcanBus(**arguments), timeout_s, undo=lambda bus: bus.shutdown())
    except (can.CanError, OSError, ValueError, TypeError, *_WITHOUT_DRIVER) as error:
        step = _NEXT_STEP.get(settings.interface, _ANY_STEP).format(
            channel=settings.channel,
            bitrate=settings.bitrate,
            host=settings.host,
            port=settings.port,
        )
        raise DriveConnectionError(
            device, f"the bus {settings.interface} {settings} does not open: {error}; {step}"
        ) from error


def send(bus: can.BusABC, message: can.Message) -> None:
    """Send a frame, and wait for room in the transmit buffer where there is none.

    Raises:
        CanError, OSError: there is no room in time (`is_full`), or the bus cannot be sent on.
    """
    end_s = 0.0  # a clock is asked only where there was no room
    while True:
        try:
            bus.send(message, _SEND_S)
            return
        except (can.CanError, OSError) as error:
            end_s = end_s or time.perf_counter() + _SEND_S
            if not is_full(error) or time.perf_counter() > end_s:
                raise
            time.sleep(_RETRY_S)


def is_full(error: Exception) -> bool:
    """Whether nothing was sent for want of room: SocketCAN tells it by a number, other interfaces by words."""
    code = getattr(error, "error_code", None) or getattr(error, "errno", None)
    return code in (errno.ENOBUFS, errno.EAGAIN) or "buffer full" in str(error).lower()


def close_bus(bus: can.BusABC) -> None:
    """Close a bus, also one that is broken. Never raises, never hangs."""
    with suppress(Exception):
        bounded(bus.shutdown, _CLOSE_S)
