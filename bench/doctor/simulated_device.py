"""Simulated devices for `friction-bench simulate-device`.

Beside the drive factory the only file that knows the simulation.
"""

import signal
import threading
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Any, Protocol, Self, TypeVar

from bench.errors import ConfigurationError


class SimulatedDevice(Protocol):
    """A device at work; leaving its context ends it."""

    @property
    def path(self) -> str:
        """What a driver opens."""

    @property
    def side_channel(self) -> str:
        """Where loads are hung and faults are made, as host:port."""

    def wait(self, stop: threading.Event) -> None:
        """Return when `stop` is set; raises what has ended the device before."""

    def __enter__(self) -> Self: ...

    def __exit__(self, *error: object) -> None: ...


Made = TypeVar("Made")


@dataclass(frozen=True)
class Joint:
    """The joint behind the device.

    Attributes:
        preset: plant that is simulated.
        plant: TOML file of what differs from the preset; None: nothing.
        seed: of the plant's scatter and noise.
    """

    preset: str = "paper"
    plant: Path | None = None
    seed: int = 1

    def values(self) -> dict[str, Any]:
        """As the settings of every device take them.

        Raises:
            ConfigurationError: the file cannot be read, or is no TOML.
        """
        return {"preset": self.preset, "plant": self._tables(), "seed": self.seed}

    def _tables(self) -> dict[str, Any]:
        if self.plant is None:
            return {}
        try:
            return tomllib.loads(self.plant.read_text(encoding="utf-8"))
        except OSError as error:
            raise ConfigurationError(f"{self.plant}: cannot be read: {error.strerror}") from error
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise ConfigurationError(f"{self.plant}: is no TOML: {error}") from error


def start_roboclaw(joint: Joint, **settings: Any) -> SimulatedDevice:
    """Start a RoboClaw; the settings are those of `RoboClawSettings`."""
    from sim_backend.devices.roboclaw.serve import RoboClawSettings, serve_roboclaw

    return _made(lambda: serve_roboclaw(RoboClawSettings(**joint.values(), **settings)))


def start_canopen(joint: Joint, **settings: Any) -> SimulatedDevice:
    """Start a CiA 402 drive; the settings are those of `CanOpenSettings`."""
    from sim_backend.devices.canopen.serve import CanOpenSettings, serve_canopen

    return _made(lambda: serve_canopen(CanOpenSettings(**joint.values(), **settings)))


def start_modbus(joint: Joint, **settings: Any) -> SimulatedDevice:
    """Start a drive on Modbus; the settings are those of `ModbusSettings`."""
    from sim_backend.devices.modbus.serve import ModbusSettings, serve_modbus

    return _made(lambda: serve_modbus(ModbusSettings(**joint.values(), **settings)))


def electronic_data_sheet(family: str) -> str:
    """The EDS of a simulated CiA 402 drive of a family, on the joint of the paper."""
    from sim_backend.devices.canopen.serve import data_sheet

    return _made(lambda: data_sheet(family))


@contextmanager
def until_told_to_end() -> Iterator[threading.Event]:
    """An event that Ctrl-C, SIGTERM and SIGHUP set, while it lasts."""
    stop = threading.Event()

    def end(_number: int, _frame: FrameType | None) -> None:
        stop.set()

    wanted = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    before = {number: signal.signal(number, end) for number in wanted}
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _made(make: Callable[[], Made]) -> Made:
    from sim_backend.errors import ParameterError

    try:
        return make()
    except (ParameterError, OSError) as error:
        raise ConfigurationError(f"simulated device: {error}") from error
