"""Errors of every drive, real or simulated.

Each message names the device, the quantity, what was found, what is allowed, the unit
and the next step. Each class has the matching builtin as a second base.
"""


class DriveError(Exception):
    """Base of all drive errors. Raised only through a subclass.

    Args:
        device: name of the drive as configured ("sim", "/dev/ttyACM0", "can0 node 5").
        message: what was found, what is allowed, the unit, and what to do next.

    Attributes:
        device, message: as given, for a message that this one becomes part of.
    """

    def __init__(self, device: str, message: str) -> None:
        super().__init__(f"drive '{device}': {message}")
        self.device, self.message = device, message


class DriveConfigurationError(DriveError, ValueError):
    """Raised before any motion when a drive cannot do what is asked.

    - a mode that the drive does not have
    - a command that is not finite or is outside the drive's range
    - a cycle period shorter than the drive sustains
    """


class DriveStateError(DriveError, RuntimeError):
    """Raised when a call does not fit the drive's state.

    - exchange or enable before open
    - a commanded motion while the drive is disabled
    """


class DriveFault(DriveError, RuntimeError):
    """Raised when the drive reports a fault of its own; the message carries its name."""


class DriveConnectionError(DriveError, ConnectionError):
    """Raised when the device does not answer, answers nonsense, or the port is gone."""


class WatchdogError(DriveError, RuntimeError):
    """Raised when the drive-side watchdog cannot be set, or reads back otherwise than set."""
