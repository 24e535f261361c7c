"""The Modbus server: every call of pymodbus that a simulated device makes is here."""

import asyncio
import logging
import threading
from typing import Any, Protocol

from pymodbus import FramerType
from pymodbus.constants import ExcCodes
from pymodbus.server import ModbusSerialServer, ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice

from sim_backend.devices.axis import Device
from sim_backend.devices.modbus.register_file import Refused, Unanswered
from sim_backend.devices.wall_time import WallTime


class RegisterDevice(Device, Protocol):
    """A device with registers. Both calls raise `Refused` or `Unanswered`, and then have done nothing."""

    def read(self, function: int, address: int, count: int) -> list[int]:
        """Return registers."""

    def write(self, function: int, address: int, words: list[int]) -> None:
        """Write registers."""


_ADDRESSES = 65536
_START_S = 10.0
_WRITE_ONE = 6


class ModbusServer(threading.Thread):
    """Serves a device from an event loop in a thread of its own.

    Args:
        device: whose registers these are.
        clock: of the device.
        unit: number of the device; requests for others are not answered.
        serial: the port to open, for RTU; None: TCP on a free port of the loopback interface, see `address`.
    """

    def __init__(self, device: RegisterDevice, clock: WallTime, unit: int, serial: str | None = None) -> None:
        super().__init__(name="Modbus server", daemon=True)
        self._device = device
        self._clock = clock
        self._unit = unit
        self._serial = serial
        self._mute = False
        self._ready = threading.Event()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ended: asyncio.Event | None = None
        self.address: tuple[str, int] = ("", 0)
        self.error: BaseException | None = None

    def begin(self) -> None:
        """Start, and return when hosts can connect.

        Raises:
            OSError: the port cannot be opened.
        """
        self.start()
        self._ready.wait(_START_S)
        if self.error is not None:
            raise OSError(str(self.error))

    def run(self) -> None:
        """Serve until `close`."""
        try:
            asyncio.run(self._serve())
        except BaseException as error:
            self.error = error
        finally:
            self._ready.set()

    def close(self) -> None:
        """End the server and the thread."""
        if self._loop is not None and self._ended is not None and self.is_alive():
            self._loop.call_soon_threadsafe(self._ended.set)
            self.join()

    async def _serve(self) -> None:
        # what it logs is the host's mistakes, which are told to the host
        logging.getLogger("pymodbus.logging").setLevel(logging.CRITICAL)
        self._loop, self._ended = asyncio.get_running_loop(), asyncio.Event()
        server = self._make_server()
        await server.serve_forever(background=True)
        if self._serial is None:
            self.address = server.transport.sockets[0].getsockname()
        self._ready.set()
        await self._ended.wait()
        await server.shutdown()

    def _make_server(self) -> Any:
        registers = SimData(0, values=[0] * _ADDRESSES, datatype=DataType.REGISTERS)
        context = SimDevice(self._unit, simdata=[registers], action=self._act)
        if self._serial is None:
            return ModbusTcpServer(context, address=("127.0.0.1", 0), trace_pdu=self._trace)
        return ModbusSerialServer(
            context, framer=FramerType.RTU, port=self._serial, baudrate=115200, trace_pdu=self._trace
        )

    async def _act(
        self,
        function: int,
        start: int,
        address: int,
        count: int,
        registers: list[int],
        values: list[int] | list[bool] | None,
    ) -> ExcCodes | None:
        """Let the device read or write; what it reads is put where the library looks for it."""
        if function == _WRITE_ONE and values is None:
            return None  # the library reads back what it has just written, for the answer
        with self._device.lock:
            self._device.advance_to(self._clock.now_s())
            try:
                if values is not None:
                    self._device.write(function, address, [int(value) for value in values])
                else:
                    registers[address - start : address - start + count] = self._device.read(function, address, count)
            except Refused as refused:
                return ExcCodes(refused.code)
            except Unanswered:
                self._mute = True
                return ExcCodes.DEVICE_FAILURE  # and `_trace` holds it back
        return None

    def _trace(self, sending: bool, pdu: Any) -> Any:
        """Hold back the answer that must not be given."""
        if not sending:
            self._mute = pdu is not None and pdu.dev_id != self._unit
            return pdu
        return None if self._mute else pdu
