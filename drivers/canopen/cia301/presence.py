"""Whether the drive is still there, after each cycle: its answers to SYNC, its heartbeat."""

from collections.abc import Callable

from drivers.canopen.cia301.heartbeat import DriveMonitor, NmtState
from drivers.canopen.cia301.sync_cycle import SyncCycle
from drivers.canopen.settings import CanopenSettings
from drivers.errors import DriveConnectionError, DriveFault


def check_presence(
    settings: CanopenSettings,
    cycle: SyncCycle,
    monitor: DriveMonitor | None,
    fault_name: Callable[[], str],
    now_s: float,
) -> None:
    """Compare its silence with what is allowed.

    Args:
        settings: of the drive.
        cycle: that was run just now.
        monitor: of its heartbeat; None where it sends none now.
        fault_name: asks for its fault in words.
        now_s: the time now [s].

    Raises:
        DriveConnectionError: it is silent for too long, or has restarted.
        DriveFault: it has left OPERATIONAL.
    """
    silence_s = cycle.silence_s
    if silence_s > settings.answer_s:
        device, state = settings.device, monitor.state if monitor is not None else None
        if state is not None and state is not NmtState.OPERATIONAL:
            raise DriveFault(device, f"has left OPERATIONAL, it is {state.name}: {fault_name()}; open it again")
        raise DriveConnectionError(
            device,
            f"no answer to SYNC for {silence_s:.3g} s; at most {settings.answer_s:g} s is allowed. Check cable and "
            "supply, then open it again",
        )
    if monitor is None:
        return
    mute_s = monitor.silence_s(now_s)
    if monitor.restarted or mute_s > monitor.timeout_s:
        what = "has restarted" if monitor.restarted else f"has sent no heartbeat for {mute_s:.3g} s"
        raise DriveConnectionError(settings.device, f"{what}; check supply and cable, then open it again")
