"""Actuators on one bus, in one exchange."""

from collections.abc import Callable, Sequence
from typing import TypeVar

from drivers.actuator.actuator import Actuator
from drivers.actuator.reading import Reading
from drivers.actuator.session import ActuatorSession
from drivers.contract import Command, Mode, Sample
from drivers.errors import DriveConnectionError

ActuatorT = TypeVar("ActuatorT", bound=Actuator)
ExchangeAll = Callable[[Sequence[tuple[ActuatorT, Mode, float]]], list[Reading]]
"""What a kind brings whose bus asks several actuators in one go. It raises `DriveConnectionError`."""


def exchange_all(
    sessions: Sequence[ActuatorSession[ActuatorT]], commands: Sequence[Command], exchange: ExchangeAll[ActuatorT]
) -> list[Sample]:
    """One cycle of several sessions, whose commands have been found to be allowed.

    Raises:
        DriveConnectionError: one of them does not answer; each is told once to be off.
    """
    demands = [
        (session.actuator, *session.demand(command.mode, command.value))
        for session, command in zip(sessions, commands, strict=True)
    ]
    try:
        readings = exchange(demands)
    except DriveConnectionError:
        for session in sessions:
            session.give_up()
        raise
    return [session.take(reading) for session, reading in zip(sessions, readings, strict=True)]
