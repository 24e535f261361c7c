"""A serial port for questions and answers in bounded time; what is said on it is the protocol's."""

import time
from contextlib import suppress
from typing import Any

import serial
from serial.tools import list_ports

from drivers.errors import DriveConnectionError

LEAST_WRITE_S = 0.1  # that a write is waited for: a busy host, which was away for a moment, is no line that is stuck


class SerialPort:
    """An open port that nobody else has open.

    Args:
        device: name used in messages.
        port: "/dev/ttyUSB0".
        baud_rate: of the line.
        timeout_s: longest wait for one answer [s].

    Raises:
        DriveConnectionError: the port is not there, or somebody else uses it.
    """

    def __init__(self, device: str, port: str, baud_rate: int, timeout_s: float) -> None:
        self._device = device
        try:
            write_s = max(timeout_s, LEAST_WRITE_S)
            self._port: Any = serial.Serial(port, baud_rate, timeout=timeout_s, write_timeout=write_s, exclusive=True)
            self._port.reset_input_buffer()
        except (OSError, ValueError) as error:  # SerialException is an OSError
            raise DriveConnectionError(device, f"{error}; {_ports()}") from error

    def fileno(self) -> int:
        """For `select`."""
        number: int = self._port.fileno()
        return number

    def close(self) -> None:
        """Give the port back. Safe to call twice."""
        self._port.close()

    def ask(self, packet: bytes, reply_bytes: int) -> bytes:
        """Write a packet and read so many bytes, or what there is when the time is up.

        Raises:
            DriveConnectionError: the port is gone.
        """
        try:
            self._port.write(packet)
        except (OSError, TypeError) as error:  # TypeError: pyserial, where the port was closed meanwhile
            raise self.gone(error) from error
        return self.read(reply_bytes)

    def read(self, count: int) -> bytes:
        """So many bytes, or what there is when the time is up.

        Raises:
            DriveConnectionError: the port is gone.
        """
        port = self._port
        try:
            reply: bytes = port.read(count)
            if len(reply) < count:  # the host may have been away, and the rest be there by now
                reply += port.read(min(port.in_waiting, count - len(reply)))
        except (OSError, TypeError) as error:
            raise self.gone(error) from error
        return reply

    def arrived(self) -> bytes:
        """What has come, without waiting.

        Raises:
            DriveConnectionError: the port is gone.
        """
        try:
            found: bytes = self._port.read(self._port.in_waiting)
        except (OSError, TypeError) as error:
            raise self.gone(error) from error
        return found

    def read_until(self, end: bytes, most_bytes: int) -> bytes:
        """Bytes up to an end, so many at most, or what there is when the time is up.

        Raises:
            DriveConnectionError: the port is gone.
        """
        try:
            found: bytes = self._port.read_until(end, most_bytes)
        except (OSError, TypeError) as error:
            raise self.gone(error) from error
        return found

    def shout(self, packet: bytes) -> None:
        """Write a packet, and wait for no answer. Never raises."""
        with suppress(Exception):
            self._port.write(packet)

    def rest(self, silence_s: float) -> None:
        """Let the device forget half a packet, and forget half an answer.

        Raises:
            DriveConnectionError: the port is gone.
        """
        time.sleep(silence_s)
        try:
            self._port.reset_input_buffer()
        except Exception as error:  # termios.error is no OSError
            raise self.gone(error) from error

    def gone(self, error: Exception) -> DriveConnectionError:
        """The port does not work any more."""
        return DriveConnectionError(self._device, f"the port is gone ({error}); plug it in, then start again")


def _ports() -> str:
    names = sorted(port.device for port in list_ports.comports())
    return f"ports found here: {', '.join(names)}" if names else "no serial port was found here; plug it in"
