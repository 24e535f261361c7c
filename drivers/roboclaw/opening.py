"""What is settled with a controller before anything moves: who it is, and that it watches over its host."""

from drivers.errors import DriveConfigurationError, DriveConnectionError, WatchdogError
from drivers.roboclaw import commands
from drivers.roboclaw.identity import Identity, parse_version
from drivers.roboclaw.link import Link
from drivers.roboclaw.settings import WATCHDOG_STEP_S


def identify(link: Link, device: str) -> Identity:
    """Ask who answers.

    Raises:
        DriveConfigurationError: it is no RoboClaw.
        DriveConnectionError: nobody does.
    """
    link.begin()
    text = link.version()
    identity = parse_version(text)
    if identity is None:
        raise DriveConfigurationError(
            device, f"what answers calls itself '{text.strip()}'; a RoboClaw is wanted. Check drive.port"
        )
    return identity


def set_watchdog(link: Link, steps: int, device: str) -> None:
    """Set the serial time-out [0.1 s], and see that it is set.

    Raises:
        WatchdogError: it is not.
    """
    link.begin()
    try:
        link.write(commands.SET_TIMEOUT, steps)
        found = link.read(commands.READ_TIMEOUT)[0]
    except DriveConnectionError as error:
        raise WatchdogError(device, f"its serial time-out cannot be set: {error}") from error
    if found != steps:
        raise WatchdogError(
            device,
            f"its serial time-out reads back as {found * WATCHDOG_STEP_S:g} s, set was {steps * WATCHDOG_STEP_S:g} s; "
            "power it off and on, and look at its firmware",
        )
