"""A simulated device at work: its ticker, its port, its side channel; started together and ended together.

The side channel is the way past the drive's own protocol: one JSON object a line, over TCP on this machine.

{"do": "hang", "load_kg": 0.05, "balanced": true}   ->  {"ok": true}
{"do": "truth"}                                     ->  {"ok": true, "powered": false, ...}
{"do": "fault", "name": "over-current"}             ->  {"ok": false, "error": "..."}
"""

import contextlib
import json
import math
import socketserver
import threading
from collections.abc import Callable
from dataclasses import asdict, dataclass
from threading import Event
from typing import Any, Protocol, Self

from sim_backend.devices.axis import Device
from sim_backend.devices.joint_tables import fault_by_name
from sim_backend.devices.link.faults import LinkFaults, link_fault
from sim_backend.devices.wall_time import PatientTime, Ticker, WallTime
from sim_backend.errors import ParameterError, SimulationError

Answer = dict[str, Any]


class Hand:
    """Deeds by name, as the side channel asks for them. Each takes the values of its request and returns its answer.

    Args:
        device: what it reaches into.
        clock: of the device.
        links: the lines to the device; they break together.
    """

    def __init__(self, device: Device, clock: WallTime, links: LinkFaults) -> None:
        self._device = device
        self._clock = clock
        self._links = links
        self._deeds: dict[str, Callable[..., Answer]] = {
            "truth": self.truth,
            "hang": self.hang,
            "hold": self.hold,
            "release": self.release,
            "fault": self.fault,
            "link": self.link,
            "repair": self.repair,
        }

    def do(self, deed: str, values: Answer) -> Answer:
        """Do a deed.

        Raises:
            ParameterError: it is not known, or its values are not.
        """
        if deed not in self._deeds:
            raise ParameterError(f"deed '{deed}' is unknown; known are {', '.join(self._deeds)}")
        with self._device.lock:
            self._device.advance_to(self._clock.now_s())
            try:
                return self._deeds[deed](**values)
            except TypeError as error:
                raise ParameterError(f"deed '{deed}': {error}") from error

    def truth(self) -> Answer:
        """Say how things really are. Names ending in `monotonic_s` are of `time.monotonic()`."""
        axis, origin_s = self._device.axis, self._clock.origin_s
        return {
            "now_monotonic_s": origin_s + axis.time_s,
            "powered": axis.power.on,
            "powered_since_monotonic_s": origin_s + axis.power.since_s,
            "stage": axis.stage_name,
            "demand": axis.applied.value,
            "device": self._device.report(),
            "joint": asdict(axis.plant.truth()),
        }

    def hang(self, load_kg: float, balanced: bool = False) -> Answer:
        """Hang a load."""
        self._device.axis.hang_load(load_kg, balanced)
        return {}

    def hold(self, angle_rad: float) -> Answer:
        """Turn the arm to an angle, and hold it there."""
        self._device.axis.hold_arm(angle_rad)
        return {}

    def release(self) -> Answer:
        """Let go of the arm."""
        self._device.axis.release_arm()
        return {}

    def fault(self, name: str, delay_s: float = 0.0, **values: Any) -> Answer:
        """Let something of drive or joint go wrong after a time."""
        self._device.axis.meet(fault_by_name(name, self._device.axis.time_s + delay_s, **values))
        return {}

    def link(self, name: str, delay_s: float = 0.0, **values: Any) -> Answer:
        """Let something of the line go wrong after a time."""
        self._links.add([link_fault(name, self._clock.now_s() + delay_s, **values)])
        return {}

    def repair(self) -> Answer:
        """Put right what is wrong with drive, joint and line."""
        self._device.axis.script.lift(self._device.axis.time_s)
        self._links.lift()
        return {}


class SideChannel(socketserver.ThreadingTCPServer):
    """Serves a hand on the loopback interface, from a thread.

    Args:
        hand: what does the deeds.
        port: TCP port; 0 is any free one, see `address`.
    """

    allow_reuse_address = True
    daemon_threads = True
    block_on_close = False

    def __init__(self, hand: Hand, port: int = 0) -> None:
        self.hand = hand
        super().__init__(("127.0.0.1", port), _Visitor)
        self._thread = threading.Thread(target=self.serve_forever, args=(0.05,), name="side channel", daemon=True)
        self._thread.start()

    @property
    def address(self) -> str:
        """Where it listens, as host:port."""
        host, port = self.socket.getsockname()
        return f"{host}:{port}"

    def close(self) -> None:
        """End the thread and the port."""
        self.shutdown()
        self._thread.join()
        self.server_close()


class _Visitor(socketserver.StreamRequestHandler):
    server: SideChannel

    def handle(self) -> None:
        with contextlib.suppress(ConnectionError):  # a visitor who leaves in the middle is no error
            for line in self.rfile:
                self.wfile.write(json.dumps(_finite(self._answer(line))).encode() + b"\n")

    def _answer(self, line: bytes) -> Answer:
        try:
            request = json.loads(line)
            deed = request.pop("do")
        except (ValueError, KeyError, AttributeError, TypeError):
            return {"ok": False, "error": 'one JSON object a line is wanted, such as {"do": "truth"}'}
        try:
            return {"ok": True, **self.server.hand.do(deed, request)}
        except SimulationError as error:
            return {"ok": False, "error": str(error)}


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(one) for key, one in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value


class Port(Protocol):
    """What carries the protocol, in threads of its own."""

    @property
    def path(self) -> str:
        """What a host opens."""

    @property
    def error(self) -> BaseException | None:
        """What ended a thread before its time."""

    def start(self) -> None:
        """Begin."""

    def close(self) -> None:
        """End."""


@dataclass(frozen=True)
class Workplace:
    """What a port needs beside the device."""

    clock: WallTime
    faults: LinkFaults


class RunningDevice:
    """A device in wall-clock time.

    Args:
        device: not yet advanced.
        make_port: its port; the faults it is given are those of the side channel.
        side_port: TCP port of the side channel; 0 is any free one.
        patience_s: of `PatientTime` [s]; None: time waits for nobody.
    """

    def __init__(
        self,
        device: Device,
        make_port: Callable[[Workplace], Port],
        side_port: int = 0,
        patience_s: float | None = None,
    ) -> None:
        clock = WallTime() if patience_s is None else PatientTime(device.axis, patience_s)
        workplace = Workplace(clock, LinkFaults())
        self.device = device
        self._ticker = Ticker(device, workplace.clock)
        self._port = make_port(workplace)
        self._side_channel = SideChannel(Hand(device, workplace.clock, workplace.faults), side_port)
        self._ticker.start()
        self._port.start()

    @property
    def path(self) -> str:
        """What a host opens."""
        return self._port.path

    @property
    def side_channel(self) -> str:
        """Where the side channel listens, as host:port."""
        return self._side_channel.address

    def wait(self, stop: Event) -> None:
        """Return when `stop` is set.

        Raises:
            BaseException: whatever has ended the ticker or the port before.
        """
        while not stop.wait(0.1):
            for thread in (self._ticker, self._port):
                if thread.error is not None:
                    raise thread.error

    def close(self) -> None:
        """End every thread and port."""
        self._side_channel.close()
        self._port.close()
        self._ticker.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()
