"""How quick the drivers of RoboClaw and Modbus are beside the same exchange written barely with the library.

Each row is a ratio within one run, against one simulated device in a process of its own: some rounds of bare cycles and
of the driver's in turn, the quickest round of each.
"""

from collections.abc import Callable, Iterator
from functools import partial
from time import perf_counter
from typing import Any, Final, Literal

import serial
from pymodbus import FramerType
from pymodbus.client import ModbusSerialClient, ModbusTcpClient

from drivers.contract import Command, Drive, Mode
from drivers.joint import JointScale
from drivers.modbus.drive import ModbusDrive
from drivers.modbus.link import QuickSerialClient
from drivers.modbus.map_file import load_map
from drivers.modbus.settings import ModbusSettings
from drivers.roboclaw.drive import RoboclawDrive
from drivers.roboclaw.settings import RoboclawSettings
from tests.devices.device_process import device_process
from tests.drivers.rate_rows import ratio_row, row
from tests.drivers.roboclaw_answers import crc

CYCLES, ROUNDS = 60, 25  # short rounds, some of which a busy machine leaves in peace
PERIOD_S = 0.02
BAUD_RATE = 115200
JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
OFF = Command(Mode.OFF)
NEVER = 1_000_000
LEAST_SHARE = 0.9  # of what the line carries, one way after the other

Questions = Literal["in turn", "together"]
QUESTIONS: Final[tuple[Questions, ...]] = ("in turn", "together")

# of a cycle, in bytes there and back: duty, encoder, speed, applied PWM, currents
ROBOCLAW_CYCLE = ((6, 1), (2, 7), (2, 7), (2, 6), (2, 6))
Cycle = Callable[[], object]


def report() -> None:
    """Print the rows."""
    for rows in (roboclaw_rows, modbus_tcp_rows, modbus_rtu_rows, line_rows):
        for one in rows():
            print(one, flush=True)


def roboclaw_rows() -> Iterator[str]:
    """Over a pty without pace."""
    with device_process("roboclaw", "--baud", "0") as device:
        for questions in QUESTIONS:
            yield _ratio_row(
                f"RoboClaw {questions} / pyserial in turn, pty",
                partial(_bare_roboclaw, device.port),
                partial(_opened_roboclaw, device.port, questions),
            )


def line_rows() -> Iterator[str]:
    """A RoboClaw paced as 115200 baud: how much of the line is used, and by a bare script that asks in turn."""
    line_s = sum(there + back for there, back in ROBOCLAW_CYCLE) * 10 / BAUD_RATE
    ways: dict[str, Callable[[str], tuple[Cycle, Cycle]]] = {
        "pyserial in turn": _bare_roboclaw,
        **{f"RoboClaw {questions}": partial(_opened_roboclaw, questions=questions) for questions in QUESTIONS},
    }
    for name, make in ways.items():
        with device_process("roboclaw", "--baud", str(BAUD_RATE)) as device:
            cycle, close = make(device.port)
            cycle_s = min(_round(cycle, 50) for _ in range(ROUNDS))
            close()
        share, is_asked = line_s / cycle_s, name == "RoboClaw together"
        yield row(
            f"{name}, line paced as {BAUD_RATE} baud",
            f">= {100.0 * LEAST_SHARE:.0f} %" if is_asked else "",
            f"{100.0 * share:.1f} % ({1.0 / cycle_s:.0f} of {1.0 / line_s:.0f} cycles/s)",
            share >= LEAST_SHARE if is_asked else None,
        )


def _bare_roboclaw(path: str) -> tuple[Cycle, Cycle]:
    port = serial.Serial(path, BAUD_RATE, timeout=1.0, exclusive=True)
    duty = b"\x80\x20\x00\x00"
    questions = [(duty + crc(duty), 1)] + [(bytes((0x80, number)), size) for number, size in _READS]

    def cycle() -> None:
        for packet, size in questions:
            port.write(packet)
            port.read(size)

    return cycle, port.close


_READS = ((16, 7), (18, 7), (48, 6), (49, 6))


def _opened_roboclaw(path: str, questions: Questions) -> tuple[Cycle, Cycle]:
    settings = RoboclawSettings.model_construct(port=path, answer_timeout_s=5.0, slow_every=NEVER, questions=questions)
    return _opened(RoboclawDrive(settings, JOINT))


def modbus_tcp_rows() -> Iterator[str]:
    """Function 23 over loopback."""
    with device_process("modbus", "--transport", "tcp") as device:
        settings = _modbus_settings(device.drive)

        def bare() -> tuple[Cycle, Cycle]:
            client = ModbusTcpClient(settings.host, port=int(settings.port), timeout=5.0, retries=0)
            client.connect()
            return _read_write(client), client.close

        yield _ratio_row("Modbus TCP / pymodbus", bare, partial(_opened_modbus, settings))


def modbus_rtu_rows() -> Iterator[str]:
    """Function 23 over a pty without pace; beside pymodbus' own client and beside the quicker one of `link.py`."""
    with device_process("modbus", "--transport", "rtu", "--baud", "0") as device:
        settings = _modbus_settings(device.drive)

        def pymodbus() -> tuple[Cycle, Cycle]:
            client = ModbusSerialClient(
                settings.port, framer=FramerType.RTU, baudrate=BAUD_RATE, timeout=5.0, retries=0
            )
            client.connect()
            return _read_write(client), client.close

        def quick() -> tuple[Cycle, Cycle]:
            client = QuickSerialClient(settings)
            client.connect()
            return _read_write(client), client.close

        driver = partial(_opened_modbus, settings)
        yield _ratio_row("Modbus RTU / pymodbus, pty", pymodbus, driver)
        yield _ratio_row("Modbus RTU / its client without polling, pty", quick, driver)


def _opened_modbus(settings: ModbusSettings) -> tuple[Cycle, Cycle]:
    return _opened(ModbusDrive(settings, load_map(settings.map), JOINT))


def _modbus_settings(drive: dict[str, Any]) -> ModbusSettings:
    values = {name: value for name, value in drive.items() if name not in ("kind", "side_channel")}
    # without pace there are no characters to be silent for
    return ModbusSettings.model_construct(
        **{**values, "port": str(values["port"])}, answer_timeout_s=5.0, watchdog_s=2.0, silence_s=0.0
    )


def _read_write(client: Any) -> Cycle:
    words = [0] * 5
    return lambda: client.readwrite_registers(
        read_address=100, read_count=12, write_address=0, values=words, device_id=1
    )


def _opened(drive: Drive) -> tuple[Cycle, Cycle]:
    drive.open(PERIOD_S)
    return lambda: drive.exchange(OFF), drive.close


def _ratio_row(name: str, bare: Callable[[], tuple[Cycle, Cycle]], driver: Callable[[], tuple[Cycle, Cycle]]) -> str:
    found: dict[str, list[float]] = {"bare": [], "driver": []}
    for _ in range(ROUNDS):
        for kind, make in (("bare", bare), ("driver", driver)):
            cycle, close = make()  # one at a time: ports are exclusive
            found[kind].append(_round(cycle, CYCLES))
            close()
    return ratio_row(name, min(found["bare"]), min(found["driver"]))


def _round(cycle: Cycle, count: int) -> float:
    """Seconds per cycle."""
    cycle()
    began_s = perf_counter()
    for _ in range(count):
        cycle()
    return (perf_counter() - began_s) / count
