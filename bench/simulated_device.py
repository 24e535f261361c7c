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
from typing import Any, Protocol, Self

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

    return _started(lambda: serve_roboclaw(RoboClawSettings(**joint.values(), **settings)))


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


def _started(start: Callable[[], SimulatedDevice]) -> SimulatedDevice:
    from sim_backend.errors import ParameterError

    try:
        return start()
    except (ParameterError, OSError) as error:
        raise ConfigurationError(f"simulated device: {error}") from error
