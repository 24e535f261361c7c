"""How fast the CANopen driver is beside python-can used barely, and whether it keeps up: see `tests.drivers.rates`.

The device is the simulated drive. "Barely" is what a script would do: send RPDO and SYNC, receive until both TPDOs
are there, unpack them. Both talk to the same device, one after the other, in rounds.
"""

import struct
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from math import inf
from time import perf_counter

import can

from drivers.can_bus.settings import BusSettings
from drivers.canopen.drive import CanopenDrive
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Mode
from drivers.errors import DriveError
from tests.drivers.canopen.conversation import JOINT, bus_of, started
from tests.drivers.holes import watched
from tests.drivers.rate_rows import ratio_row, row

ROUNDS, CYCLES = 12, 200
WATCHDOG_S, ANSWER_S = 1.0, 0.5
SPIN_S = 0.0002


@contextmanager
def in_one_process() -> Iterator[BusSettings]:
    """The simulated drive on a virtual bus of this process."""
    from sim_backend.devices.canopen.serve import CanOpenSettings, serve_canopen

    with serve_canopen(CanOpenSettings(interface="virtual", channel="rates")):
        yield BusSettings("virtual", "rates")


@contextmanager
def over(interface: str) -> Iterator[BusSettings]:
    """The simulated drive in a process of its own."""
    with started(interface) as device:
        yield bus_of(device)


PLACES: dict[str, Callable[[], object]] = {
    "virtual, one process": in_one_process,
    "slcan on a pty, two processes": lambda: over("slcan"),
    "socketcand on TCP, two processes": lambda: over("socketcand"),
}


def drive_on(bus: BusSettings) -> CanopenDrive:
    return CanopenDrive(CanopenSettings(bus=bus, node_id=5, watchdog_s=WATCHDOG_S, answer_s=ANSWER_S), JOINT)


def barely(bus: can.BusABC, cycles: int) -> float:
    """Seconds per cycle of python-can and struct."""
    began_s = perf_counter()
    for _ in range(cycles):
        bus.send(can.Message(arbitration_id=0x205, data=bytes(6), is_extended_id=False))
        bus.send(can.Message(arbitration_id=0x080, data=b"", is_extended_id=False))
        missing = {0x185, 0x285}
        while missing:
            message = bus.recv(1.0)
            assert message is not None, "no answer to SYNC"
            if message.arbitration_id in missing:
                struct.unpack("<Hh" if message.arbitration_id == 0x185 else "<ii", message.data)
                missing.discard(message.arbitration_id)
    return (perf_counter() - began_s) / cycles


def driven(drive: CanopenDrive, cycles: int) -> float:
    """Seconds per cycle of the driver."""
    off = Command(Mode.OFF)
    began_s = perf_counter()
    for _ in range(cycles):
        drive.exchange(off)
    return (perf_counter() - began_s) / cycles


def side_by_side(bus: BusSettings) -> tuple[float, float]:
    """Seconds per cycle of driver and bare library, best of some rounds each: what else runs only makes them longer."""
    driver_s, bare_s = inf, inf
    for _ in range(ROUNDS):
        drive = drive_on(bus)
        drive.open(0.005)
        driver_s = min(driver_s, driven(drive, CYCLES))
        drive.close()
        arguments = bus.arguments() | ({"sleep_after_open": 0.0} if bus.interface == "slcan" else {})
        with can.Bus(**arguments) as bare:
            bare.send(can.Message(arbitration_id=0, data=[1, 5], is_extended_id=False))  # NMT start
            time.sleep(0.05)
            bare_s = min(bare_s, barely(bare, CYCLES))
    return driver_s, bare_s


def endurance_row(bus: BusSettings, place: str, rate_hz: float, duration_s: float) -> str:
    """Cycle with the power on and no current for a time; a late cycle starts at once, and none is left out."""
    drive, cycles = drive_on(bus), round(rate_hz * duration_s)
    drive.open(1.0 / rate_hz)
    drive.enable(Mode.CURRENT)
    before, late_s, ending = replace(drive.counts), [], ""
    with watched() as holes:
        began_s = perf_counter()
        try:
            for number in range(cycles):
                late_s.append(_wait_until(began_s + number / rate_hz))
                drive.exchange(Command(Mode.CURRENT, 0.0))
        except DriveError as error:
            ending = f"; {error}"
    took_s, after = perf_counter() - began_s, replace(drive.counts)
    drive.close()
    late_s.sort()
    sent, lost = after.sent - before.sent, after.missed - before.missed
    surplus, late = after.surplus - before.surplus, after.late - before.late
    p99_ms, max_ms = 1e3 * late_s[len(late_s) * 99 // 100], 1e3 * late_s[-1]
    return row(
        f"{rate_hz:.0f} Hz for {duration_s:g} s, {place}",
        "0 cycles lost",
        f"{lost} lost of {sent} SYNC in {took_s:.1f} s, {late} answered late, {surplus} TPDO too many; cycle's start "
        f"late by p99 {p99_ms:.2f} ms, max {max_ms:.1f} ms; {holes}{ending}",
        sent == cycles and lost == surplus == 0,
    )


def _wait_until(deadline_s: float) -> float:
    """Sleep and spin until then; how late that is [s]."""
    while (remaining_s := deadline_s - perf_counter()) > 0.0:
        if remaining_s > SPIN_S:
            time.sleep(remaining_s - SPIN_S)
    return -remaining_s


def report(duration_s: float) -> None:
    """Print every figure."""
    for place, start in PLACES.items():
        with start() as bus:  # type: ignore[attr-defined]
            driver_s, bare_s = side_by_side(bus)
            print(ratio_row(f"CANopen / python-can, {place}", bare_s, driver_s), flush=True)
            rate_hz = {"virtual": 1000.0, "slcan": 500.0}.get(bus.interface)
            if rate_hz is not None:
                print(endurance_row(bus, place, rate_hz, duration_s), flush=True)
