"""What is settled with a controller before anything moves: who it is, its current limit, and that it minds its host."""

import re

from drivers.errors import DriveConfigurationError, DriveConnectionError, WatchdogError
from drivers.polled_drive import Identity
from drivers.roboclaw import commands
from drivers.roboclaw.link import Link
from drivers.roboclaw.settings import WATCHDOG_STEP_S, RoboclawSettings

_VERSION = re.compile(r"(?P<product>.*roboclaw.*?)\s+v(?P<firmware>\d[\w.]*)", re.IGNORECASE)


VENDOR = "Basicmicro"


def parse_version(text: str) -> Identity | None:
    """Take "USB Roboclaw 2x15a v4.1.34" (command 21) apart; None where it is no RoboClaw."""
    found = _VERSION.match(text.strip())
    if found is None:
        return None
    return Identity(VENDOR, found["product"].strip(), found["firmware"], simulated="simulated" in text.lower())


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


def set_watchdog(link: Link, settings: RoboclawSettings) -> None:
    """Set the serial time-out, and see that it is set.

    Raises:
        WatchdogError: it is not.
    """
    link.begin()
    steps = settings.watchdog_steps
    try:
        link.write(commands.SET_TIMEOUT, steps)
        found = link.read(commands.READ_TIMEOUT)[0]
    except DriveConnectionError as error:
        raise WatchdogError(settings.device, f"its serial time-out cannot be set: {error}") from error
    if found != steps:
        raise WatchdogError(
            settings.device,
            f"its serial time-out reads back as {found * WATCHDOG_STEP_S:g} s, set was {steps * WATCHDOG_STEP_S:g} s; "
            "power it off and on, and look at its firmware",
        )


def set_current_limit(link: Link, settings: RoboclawSettings) -> None:
    """Set the highest motor current where one is wanted, and see that it is set; it is not kept beyond power-off.

    Raises:
        DriveConfigurationError: it is not.
        DriveConnectionError: the controller does not answer; older firmware does not know the command.
    """
    if settings.current_limit_a is None:
        return
    link.begin()
    channel, wanted = commands.CHANNELS[settings.motor], round(settings.current_limit_a / commands.CURRENT_A)
    link.write(channel.set_current_limit, wanted, 0)
    found = link.read(channel.current_limit)[0]
    if found != wanted:
        raise DriveConfigurationError(
            settings.device,
            f"its current limit reads back as {found * commands.CURRENT_A:g} A, set was {settings.current_limit_a:g} "
            "A; choose one that the controller takes, or leave drive.current_limit_a out",
        )
