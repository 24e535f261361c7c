"""USB adapters that hold answers back: an FTDI chip waits up to its `latency_timer`, 16 ms unless told otherwise.

Source: FTDI application note AN232B-04, "Data Throughput, Latency and Handshaking".
"""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from statistics import median
from time import perf_counter

ADAPTERS = Path("/sys/bus/usb-serial/devices")
_LONGEST_MS = 2  # a timer of 1 ms holds back no more than USB itself does
_DEFAULT_S = 0.016
_NEAR_S = 0.003
_QUESTIONS = 8


def latency_note(port: str, ask: Callable[[], object]) -> tuple[str, ...]:
    """What the user should know of a serial port: one sentence, or none.

    Args:
        port: as it was opened; a link such as /dev/serial/by-id/... is followed.
        ask: asks the drive one short question, and returns when it is answered.
    """
    name = Path(port).resolve().name
    timer_ms = _latency_timer_ms(name)
    if timer_ms is not None and timer_ms > _LONGEST_MS:
        return (
            f"the USB adapter of {port} holds each answer back for up to {timer_ms} ms (its latency_timer). Set it to "
            f"1 ms: echo 1 | sudo tee {ADAPTERS / name / 'latency_timer'}",
        )
    if timer_ms is None and abs(_answer_s(ask) - _DEFAULT_S) < _NEAR_S:
        return (
            f"answers on {port} take 16 ms each, as through an FTDI adapter with its latency timer at the default; set "
            "it to 1 ms (Windows: the port's advanced settings; Linux: latency_timer of the adapter)",
        )
    return ()


def _latency_timer_ms(name: str) -> int | None:
    """What the kernel has for it; None where it is no such adapter."""
    with suppress(OSError, ValueError):
        return int((ADAPTERS / name / "latency_timer").read_text(encoding="ascii"))
    return None


def _answer_s(ask: Callable[[], object]) -> float:
    """How long an answer takes [s], the median of some."""
    times_s = []
    for _ in range(_QUESTIONS):
        began_s = perf_counter()
        ask()
        times_s.append(perf_counter() - began_s)
    return median(times_s)
