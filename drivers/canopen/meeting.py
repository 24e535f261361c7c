"""Meeting a drive that somebody may have left as it was: first the power off, then everything else."""

import time
from collections.abc import Callable
from time import perf_counter
from typing import Final

from drivers.canopen.cia301.object_access import ObjectAccess, ObjectRefusedError
from drivers.canopen.cia301.object_table import Need, ObjectTable
from drivers.canopen.cia301.objects import CONTROLWORD, STATUSWORD
from drivers.canopen.cia402.bits import OUTPUTS
from drivers.canopen.cia402.state_machine import DISABLE_VOLTAGE, QUICK_STOP, State, state_of
from drivers.canopen.identity import Identity, identify
from drivers.canopen.settings import CanopenSettings
from drivers.errors import DriveConnectionError

_POWERED: Final = (State.ENABLED, State.QUICK_STOP, State.FAULT_REACTION)
_BRAKE_S: Final = 1.0
_OFF_S: Final = 0.5
_PAUSE_S: Final = 0.002
_PURPOSE: Final = "power"


def meet(
    table: ObjectTable, access: ObjectAccess, settings: CanopenSettings, pre_operational: Callable[[], None]
) -> tuple[State, Identity]:
    """Identity, power off, PRE-OPERATIONAL, in this order: a drive that leaves OPERATIONAL may go on turning.

    Returns:
        The state in which the drive was found, and who it is.

    Raises:
        DriveConnectionError: it does not answer, or does not switch off.
        DriveConfigurationError: it is no drive, or another one than the settings name.
    """
    try:
        access.read(STATUSWORD)
    except ObjectRefusedError:
        pass  # whatever it is, it answers: its identity says more
    except DriveConnectionError:
        pre_operational()  # a node that was stopped answers nothing else
    identity = identify(table, access, settings)
    found = state_of(table.read(STATUSWORD, _PURPOSE))
    if found in _POWERED:
        _switch_off(access, settings, found)
        table.note(
            "power", Need.REQUIRED, _PURPOSE, True, f"found in state '{found.value}', left by a host before: off"
        )
    pre_operational()
    access.write(CONTROLWORD, DISABLE_VOLTAGE)
    return found, identity


def _switch_off(access: ObjectAccess, settings: CanopenSettings, found: State) -> None:
    """Brake, then take the power away, by SDO alone; a holding brake on an output is set before."""
    outputs = None if settings.brake is None else access.read_if_present(OUTPUTS)
    if settings.brake is not None and outputs is not None:
        access.write(OUTPUTS, settings.brake.word(outputs, released=False))
    access.write(CONTROLWORD, QUICK_STOP)
    _await(access, lambda state: state not in _POWERED, _BRAKE_S)
    access.write(CONTROLWORD, DISABLE_VOLTAGE)
    if not _await(access, lambda state: state not in _POWERED, _OFF_S):
        raise DriveConnectionError(
            settings.device,
            f"was left in state '{found.value}' by a host before, and does not switch off; cut its power supply",
        )


def _await(access: ObjectAccess, condition: Callable[[State], bool], timeout_s: float) -> bool:
    deadline_s = perf_counter() + timeout_s
    while not condition(state_of(access.read(STATUSWORD))):
        if perf_counter() > deadline_s:
            return False
        time.sleep(_PAUSE_S)
    return True
