"""A connected drive: from the open bus to OPERATIONAL with the power off, in the order that keeps it safe."""

from collections.abc import Callable
from contextlib import suppress
from time import perf_counter
from typing import Final

from drivers.canopen.capabilities import Capabilities, probe
from drivers.canopen.cia301.emergency import HEARTBEAT_LOST, Emergency, error_name
from drivers.canopen.cia301.heartbeat import DriveMonitor, HostHeartbeat, NmtState
from drivers.canopen.cia301.link import CanLink
from drivers.canopen.cia301.object_access import ObjectAccess, ObjectRefusedError
from drivers.canopen.cia301.objects import (
    CONTROLWORD,
    ERROR_CODE,
    INTERPOLATION_EXPONENT,
    INTERPOLATION_PERIOD,
    SYNC_COB_ID,
)
from drivers.canopen.cia301.pdo_setup import ProcessData, choose_pdos, configure_pdos
from drivers.canopen.cia301.presence import check_presence
from drivers.canopen.cia301.sync_cycle import SyncCycle, answer_wait_s
from drivers.canopen.cia402.limits import set_current_limit
from drivers.canopen.cia402.measurement import Measurement
from drivers.canopen.cia402.state_machine import DISABLE_VOLTAGE
from drivers.canopen.cia402.units import interpolation_period
from drivers.canopen.identity import identify
from drivers.canopen.settings import CanopenSettings
from drivers.canopen.slow_poll import SlowPoll
from drivers.canopen.watchdog import Watchdog, heartbeat_ms
from drivers.contract import Sample, Status
from drivers.errors import DriveConnectionError
from drivers.joint import JointScale

_START, _PRE_OPERATIONAL = 0x01, 0x80  # NMT commands
_NMT_S: Final = 1.0  # longest wait for an NMT state, on top of a heartbeat
_TRIAL_CYCLES: Final = 15
_MISSED_HEARTBEATS: Final = 3


class Session:
    """Everything between connecting and disconnecting.

    Args:
        link: open.
        settings: of the drive.
        joint: on it.
        period_s: control period [s].

    Raises:
        DriveError: at the first step that fails. The power stage is off then, or was never on.
    """

    def __init__(self, link: CanLink, settings: CanopenSettings, joint: JointScale, period_s: float) -> None:
        self.link = link
        self.settings = settings
        node_id = settings.node_id
        self.access = ObjectAccess(link, node_id, settings.device)
        self.heartbeat = HostHeartbeat(settings.watchdog_s)
        self.monitor = DriveMonitor(_MISSED_HEARTBEATS * heartbeat_ms(settings) * 1e-3)
        self.watchdog = Watchdog(self.access, settings)
        self.emergency: Emergency | None = None
        self.poll = SlowPoll((), 1.0)
        self._subscribe(node_id)

        # SDO only, until everything that keeps the drive safe is set
        self.found: Capabilities = self._meet(joint)
        self.watchdog.prepare()
        set_current_limit(self.access, settings, self.found)
        self.data: ProcessData = self._configure(period_s)
        self.measurement = Measurement(self.found, self.data.state.layout, self.data.motion.layout)
        self.poll = SlowPoll(self.measurement.slow, 1.0 / settings.poll_hz)
        self._read_slow_once()
        self.cycle = SyncCycle(link, (self.data.state, self.data.motion), answer_wait_s(period_s))
        self.start()
        self.round_trip_s = self._try_cycles(period_s)

    def start(self) -> None:
        """Enter OPERATIONAL.

        Raises:
            DriveConnectionError: the drive does not say so.
        """
        self._nmt(_START)
        self.await_until(lambda: self.monitor.state is NmtState.OPERATIONAL, "NMT state OPERATIONAL")

    def run(self, cob_id: int, payload: bytes) -> bool:
        """One cycle, with all that has to be looked after in it; tell whether it was answered in time.

        Args:
            cob_id: of the RPDO.
            payload: of the RPDO.

        Raises:
            DriveConnectionError: the drive does not answer for too long, its heartbeat is gone, or it has restarted.
            DriveFault: it has left OPERATIONAL.
        """
        self.keep_alive()
        answered = self.cycle.run(cob_id, payload)
        now_s = perf_counter()
        self.ask_slow(now_s)
        check_presence(self.settings, self.cycle, self.monitor, self.fault_name, now_s)
        return answered

    def sample(self, status: Status) -> Sample:
        """The sample of the last SYNC that was answered.

        Args:
            status: of the power stage.
        """
        state, motion = self.cycle.values
        return self.measurement.sample(
            state, motion, self.poll.readings, status, self.cycle.sync_s, perf_counter(), self.cycle.number
        )

    def leave(self) -> None:
        """Give the drive back: PRE-OPERATIONAL, nobody watches. With the power off only. Never raises."""
        with suppress(Exception):
            if self.watchdog.armed:
                self.watchdog.disarm()
        with suppress(Exception):
            self._nmt(_PRE_OPERATIONAL)

    def keep_alive(self, now_s: float | None = None) -> None:
        """Send the host's heartbeat if it is due."""
        if self.heartbeat.due(perf_counter() if now_s is None else now_s):
            self.link.send_message(0x700 + self.settings.host_node_id, HostHeartbeat.PAYLOAD)

    def ask_slow(self, now_s: float) -> None:
        """Send the request of the slow poll, if one is due."""
        request = self.poll.request(now_s)
        if request is not None:
            self.link.send_message(0x600 + self.settings.node_id, request)

    def fault_name(self) -> str:
        """The fault in words, by the last EMCY since it was switched on or cleared, or else by 0x603F."""
        if self.emergency is not None:
            return str(self.emergency)
        try:
            return error_name(self.access.read(ERROR_CODE))
        except (ObjectRefusedError, DriveConnectionError):
            return "a fault that it does not name"

    def lost_its_host(self) -> bool:
        """Whether the fault is the watchdog's, and nothing else."""
        return self.access.read_if_present(ERROR_CODE) == HEARTBEAT_LOST

    def await_until(self, condition: Callable[[], bool], what: str) -> None:
        """Take in frames until a condition holds.

        Raises:
            DriveConnectionError: it does not, in time.
        """
        deadline_s = perf_counter() + _NMT_S + self.monitor.timeout_s
        while not condition():
            remaining_s = deadline_s - perf_counter()
            if remaining_s <= 0.0:
                raise DriveConnectionError(
                    self.settings.device, f"{what} is not heard of within {_NMT_S:g} s; switch the drive off and on"
                )
            self.link.receive(min(remaining_s, 0.01))

    def _subscribe(self, node_id: int) -> None:
        link = self.link
        link.subscribe(0x80 + node_id, lambda _id, data, _time: self._take_emergency(bytes(data)))
        link.subscribe(0x580 + node_id, lambda _id, data, _time: self._take_sdo(bytes(data)))
        link.subscribe(0x700 + node_id, lambda _id, data, _time: self.monitor.hear(bytes(data), perf_counter()))

    def _take_emergency(self, data: bytes) -> None:
        emergency = Emergency.decode(data)
        if emergency.code:  # 0 tells that the cause is gone: it was the cause all the same
            self.emergency = emergency

    def _take_sdo(self, data: bytes) -> None:
        if not self.poll.take(data, perf_counter()):
            self.access.take(data)

    def _nmt(self, command: int) -> None:
        self.link.send_message(0x000, bytes([command, self.settings.node_id]))

    def _meet(self, joint: JointScale) -> Capabilities:
        """PRE-OPERATIONAL, identity, power off, capabilities."""
        self._nmt(_PRE_OPERATIONAL)
        identity = identify(self.access, self.settings)
        self.monitor.restarted = False  # it may have been switched on just now; from here on it must stay so
        self.access.write(CONTROLWORD, DISABLE_VOLTAGE)
        return probe(self.access, self.settings, joint, identity)

    def _configure(self, period_s: float) -> ProcessData:
        access = self.access
        access.write(SYNC_COB_ID, 0x80)
        period = interpolation_period(period_s)
        if period is not None and access.read_if_present(INTERPOLATION_PERIOD) is not None:
            access.write(INTERPOLATION_PERIOD, period[0])
            access.write(INTERPOLATION_EXPONENT, period[1])
        data = choose_pdos(self.settings.node_id, self.found, self.settings.duty_sign_from_current)
        configure_pdos(access, self.settings.device, data)
        self.monitor.state = None
        return data

    def _read_slow_once(self) -> None:
        for item in self.measurement.slow:
            self.poll.put(item, self.access.read(item), perf_counter())

    def _try_cycles(self, period_s: float) -> float:
        """Exchange with the power off; the shortest time of a cycle [s]: what drive and line need, not a busy host.

        Raises:
            DriveConnectionError: the drive does not answer SYNC.
        """
        off = self.data.nothing(DISABLE_VOLTAGE)
        times_s = []
        for _ in range(_TRIAL_CYCLES):
            start_s = perf_counter()
            if self.cycle.run(self.data.torque.cob_id, off):
                times_s.append(perf_counter() - start_s)
        if not self.cycle.number:
            raise DriveConnectionError(
                self.settings.device,
                f"none of {_TRIAL_CYCLES} SYNC frames was answered by TPDOs. Check cable, termination and bit rate",
            )
        return min(times_s, default=answer_wait_s(period_s))
