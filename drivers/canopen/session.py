"""A connected drive: from the open bus to OPERATIONAL with the power off, in the order that keeps it safe."""

import time
from collections.abc import Callable
from contextlib import suppress
from time import perf_counter
from typing import Final

from drivers.canopen.capabilities import Capabilities, probe
from drivers.canopen.cia301.emergency import Emergency
from drivers.canopen.cia301.error_codes import HOST_LOST, error_codes
from drivers.canopen.cia301.heartbeat import DriveMonitor, NmtState
from drivers.canopen.cia301.link import CanLink
from drivers.canopen.cia301.object_access import ObjectAccess
from drivers.canopen.cia301.object_table import Need, ObjectTable
from drivers.canopen.cia301.objects import ERROR_CODE, ERROR_FIELD, POSITION, PRODUCER_HEARTBEAT, STATUSWORD
from drivers.canopen.cia301.presence import check_presence
from drivers.canopen.cia301.strangers import Strangers
from drivers.canopen.cia301.sync_cycle import SyncCycle, answer_wait_s
from drivers.canopen.cia402.bits import OUTPUT_MASK, OUTPUTS, BrakeBit, download
from drivers.canopen.cia402.limits import set_limits
from drivers.canopen.cia402.measurement import Measurement
from drivers.canopen.cia402.state_machine import DISABLE_VOLTAGE
from drivers.canopen.cia402.stopping import set_up_stopping
from drivers.canopen.guard import Guard, heartbeat_ms
from drivers.canopen.meeting import meet
from drivers.canopen.process_setup import set_interpolation, set_up_pdos, untold
from drivers.canopen.settings import CanopenSettings
from drivers.canopen.slow_poll import SlowPoll
from drivers.contract import Sample, Status
from drivers.errors import DriveConnectionError, DriveError
from drivers.joint import JointScale

_START, _PRE_OPERATIONAL, _RESET = 0x01, 0x80, 0x81  # NMT commands
_NMT_S: Final = 1.0  # longest wait for an NMT state, on top of a heartbeat
_TRIAL_CYCLES: Final = 15
_TRIAL_S: Final = 0.5  # a host that is held up tries for longer: the quickest cycle counts
_MISSED_HEARTBEATS: Final = 3
_LOOK_S: Final = 0.005
_QUIET_S: Final = 0.1  # after that long without a cycle, the bus is listened to again before anything is sent


class Session:
    """Everything between connecting and disconnecting.

    Args:
        link: open.
        settings: of the drive.
        joint: on it.
        period_s: control period [s].
        speed_rad_s: highest of the joint, from which the drive has to stop soon [rad/s].

    Raises:
        DriveError: at the first step that fails. The power stage is off then, or was never on.
    """

    def __init__(
        self, link: CanLink, settings: CanopenSettings, joint: JointScale, period_s: float, speed_rad_s: float
    ) -> None:
        self.link = link
        self.settings = settings
        node_id = settings.node_id
        self.access = ObjectAccess(link, node_id, settings.device, settings.sdo_answer_s)
        self.table = ObjectTable(self.access, settings.device)
        self.monitor = DriveMonitor(_MISSED_HEARTBEATS * heartbeat_ms(settings) * 1e-3)
        self.strangers = Strangers(link, settings.device, node_id)
        self.emergency: Emergency | None = None
        self.poll = SlowPoll((), 1.0, settings.sdo_answer_s)
        self._subscribe(node_id)
        self._listen(settings.listen_s)
        self.host_id = link.host_id = self.strangers.choose_host_id(settings.host_node_id)

        # SDO only, until everything that keeps the drive safe is set
        self.left, identity = meet(self.table, self.access, settings, lambda: self._nmt(_PRE_OPERATIONAL))
        self.monitor.restarted = False  # it may have been switched on just now; from here on it must stay so
        self._codes = error_codes(identity.vendor_id)
        self.found: Capabilities = probe(self.table, settings, joint, identity)
        self.stopping = set_up_stopping(self.table, self.found.scale, speed_rad_s)
        self.guard = Guard(self.table, link, settings, self.host_id, self.stopping.ends)
        self.guard.prepare()
        self.torque_off()
        self._sends_heartbeats = not self.guard.silences_heartbeat and self.table.try_set(
            PRODUCER_HEARTBEAT, heartbeat_ms(settings), "the drive's own sign of life"
        )
        self._outputs = self._set_up_brake()
        self.own_limit = set_limits(self.table, settings, self.found)
        set_interpolation(self.table, period_s)
        self.data = set_up_pdos(self.table, self.access, settings, self.found)
        self.untold = untold(self.found, self.data)
        self.monitor.state = None
        link.load = self.data.sizes

        places = [self.data.place(item) for item in (STATUSWORD, POSITION)]
        self.status_place, self.position_place = (place for place in places if place is not None)
        self.measurement = Measurement(self.found, self.data.place)
        # its answers also tell which TPDOs are lost: with nothing else to ask for, the statusword is
        asked_for = self.measurement.slow or (STATUSWORD,)
        self.poll = SlowPoll(asked_for, 1.0 / settings.poll_hz, settings.sdo_answer_s)
        self._read_slow_once()
        self.cycle = SyncCycle(link, self.data.tpdos, answer_wait_s(period_s), period_s, settings.sdo_answer_s)
        self.speaking = self.data.idle
        self.start()
        self.round_trip_s = self._try_cycles(period_s)

    def start(self) -> None:
        """Enter OPERATIONAL.

        Raises:
            DriveConnectionError: the drive does not say so.
        """
        self._nmt(_START)
        if self._sends_heartbeats:
            self.await_until(lambda: self.monitor.state is NmtState.OPERATIONAL, "NMT state OPERATIONAL")

    def reset(self) -> None:
        """Have the drive begin anew, which takes its power away whatever state it is in. It is to be opened again."""
        self._nmt(_RESET)

    def run(self, cob_id: int, payload: bytes) -> bool:
        """One cycle, with all that has to be looked after in it; tell whether it was answered in time.

        Raises:
            DriveConnectionError: the drive does not answer for too long, its heartbeat is gone, it has restarted, or
                another host is on the bus.
            DriveFault: it has left OPERATIONAL.
        """
        self.strangers.check()
        self.keep_alive()
        answered = self.cycle.run(cob_id, payload)
        now_s = perf_counter()
        self.ask_slow(now_s)
        watched = self._sends_heartbeats or (self.guard.silences_heartbeat and self.guard.armed)
        check_presence(self.settings, self.cycle, self.monitor if watched else None, self.fault_name, now_s)
        return answered

    def idle(self, controlword: int) -> bool:
        """One cycle that demands nothing; tell whether it was answered. Nobody is looked after."""
        return self.cycle.run(self.speaking.cob_id, self.nothing(controlword))

    def nothing(self, controlword: int) -> bytes:
        """Payload of the RPDO in use that demands nothing."""
        return self.data.nothing(self.speaking, controlword, self.position_counts)

    @property
    def statusword(self) -> int:
        """As last received."""
        return self.cycle.value(self.status_place) if self.cycle.number else 0

    @property
    def position_counts(self) -> int:
        """As last received; 0 before the first."""
        return self.cycle.value(self.position_place) if self.cycle.number else 0

    def sample(self, status: Status) -> Sample:
        """The sample of the last SYNC that was answered."""
        cycle = self.cycle
        return self.measurement.sample(
            cycle.values, self.poll.readings, status, cycle.sync_s, cycle.earliest_s, perf_counter(), cycle.number
        )

    def look_round(self) -> None:
        """Before the power comes: is anybody else on the bus? Old news do not count.

        Raises:
            DriveConnectionError: another host is; with what it sends.
        """
        if self.cycle.idle_s > _QUIET_S:
            self.link.drain()
            self.strangers.forget()
            self._listen(min(self.settings.listen_s, _QUIET_S))
        self.link.drain()
        self.strangers.check()

    def leave(self) -> None:
        """Give the drive back: PRE-OPERATIONAL, nobody watches. With the power off only. Never raises."""
        with suppress(Exception):
            if self.guard.armed:
                self.guard.disarm()
        with suppress(Exception):
            self._nmt(_PRE_OPERATIONAL)

    def keep_alive(self) -> None:
        """Give the host's sign of life if it is due."""
        self.guard.sign(perf_counter())

    def ask_slow(self, now_s: float) -> None:
        """Send the request of the slow poll, if one is due."""
        request = self.poll.request(now_s)
        if request is not None:
            self.link.send_message(0x600 + self.settings.node_id, request)
            self.cycle.asked()

    def fault_name(self) -> str:
        """The fault in words: by the last EMCY since it was switched on or cleared, by 0x603F, or by 0x1003."""
        if self.emergency is not None:
            return self._codes.name(self.emergency.code)
        try:
            code = self._error_code()
        except DriveError:
            code = None
        return self._codes.name(code) if code else "the drive names no error"

    def lost_its_host(self) -> bool:
        """Whether the fault says only that a host was silent."""
        return self._error_code() in HOST_LOST

    def set_brake(self, bit: BrakeBit, released: bool, confirmed: bool) -> None:
        """Release or set the holding brake.

        Args:
            bit: of the outputs.
            released: with current in its coil.
            confirmed: wait for the drive's answer.

        Raises:
            DriveConfigurationError: the drive refuses.
            DriveConnectionError: it does not confirm it.
        """
        outputs = bit.word(self._outputs, released)
        if not confirmed:
            self.link.send_message(0x600 + self.settings.node_id, download(outputs))
            return
        while self.poll.awaits(perf_counter()):  # one request at a time
            self.link.receive(_LOOK_S)
        self.access.write(OUTPUTS, outputs)

    def _set_up_brake(self) -> int:
        """Have the brake set and its output in the hand of this host; the outputs as they are then.

        Raises:
            DriveConfigurationError: the drive has no such output, or keeps it for itself.
        """
        bit = self.settings.brake
        if bit is None:
            return 0
        outputs = bit.word(self.table.read(OUTPUTS, "brake"), released=False)
        self.access.write(OUTPUTS, outputs)  # before the mask: what it lets through is right already
        mask = self.table.ask(OUTPUT_MASK, "brake")
        if mask is not None:
            self.table.set(OUTPUT_MASK, mask | bit.mask, "brake")
        return outputs

    def torque_off(self) -> str:
        """What says that safe torque off is active; "" where nothing does.

        Raises:
            DriveConfigurationError: the drive does not tell the object of the settings.
            DriveConnectionError: it does not answer.
        """
        bit = self.settings.torque_off
        if bit is None:
            return ""
        value = self.access.read_unsigned(bit.index, bit.subindex)
        self.table.note(bit, Need.REQUIRED, "safe torque off", True, bit.seen(value))
        return bit.seen(value) if bit.holds(value) else ""

    def await_until(self, condition: Callable[[], bool], what: str) -> None:
        """Take in frames until a condition holds.

        Raises:
            DriveConnectionError: it does not hold in time.
        """
        limit_s = _NMT_S + heartbeat_ms(self.settings) * 1e-3
        deadline_s = perf_counter() + limit_s
        while not condition():
            remaining_s = deadline_s - perf_counter()
            if remaining_s <= 0.0:
                state = "nothing" if self.monitor.state is None else self.monitor.state.name
                raise DriveConnectionError(
                    self.settings.device,
                    f"{what} is not reached within {limit_s:.3g} s; its heartbeat says {state}. Check the cable, then "
                    "open it again",
                )
            self.link.receive(min(remaining_s, 0.05))

    def _subscribe(self, node_id: int) -> None:
        self.link.subscribe(0x580 + node_id, lambda _id, data, _time: self._take_sdo(bytes(data)))
        self.link.subscribe(0x700 + node_id, lambda _id, data, _time: self.monitor.hear(bytes(data), perf_counter()))
        self.link.subscribe(0x080 + node_id, lambda _id, data, _time: self._take_emergency(bytes(data)))

    def _listen(self, duration_s: float) -> None:
        """Hear who else is on the bus.

        Raises:
            DriveConnectionError: another host is.
        """
        deadline_s = perf_counter() + duration_s
        while (remaining_s := deadline_s - perf_counter()) > 0.0:
            self.link.receive(remaining_s)
        self.strangers.check()

    def _take_emergency(self, data: bytes) -> None:
        emergency = Emergency.decode(data)
        if emergency.code:  # 0 tells that the cause is gone: it was the cause all the same
            self.emergency = emergency

    def _take_sdo(self, data: bytes) -> None:
        if self.poll.take(data, perf_counter()):
            self.cycle.overtaken()
        else:
            self.access.take(data)

    def _error_code(self) -> int | None:
        code = self.access.read_if_present(ERROR_CODE)
        newest = self.access.read_if_present(ERROR_FIELD) if code is None else None
        return newest & 0xFFFF if newest is not None else code

    def _nmt(self, command: int) -> None:
        self.link.send_message(0x000, bytes([command, self.settings.node_id]))

    def _read_slow_once(self) -> None:
        for item in self.measurement.slow:
            value = self.access.read_if_present(item)
            if value is not None:
                self.poll.put(item, value, perf_counter())

    def _try_cycles(self, period_s: float) -> float:
        """Exchange with the power off; the shortest time of a cycle [s]: what drive and line need, not a busy host."""
        times_s: list[float] = []
        deadline_s = perf_counter() + _TRIAL_S
        cycles = 0
        while cycles < _TRIAL_CYCLES or (min(times_s, default=period_s) >= period_s and perf_counter() < deadline_s):
            start_s = perf_counter()
            if self.idle(DISABLE_VOLTAGE):
                times_s.append(perf_counter() - start_s)
            else:
                time.sleep(period_s)  # whoever holds up this host may need the processor
            cycles += 1
        if not self.cycle.number:
            raise DriveConnectionError(
                self.settings.device,
                f"none of {cycles} SYNC frames was answered by TPDOs. Check cable, termination and bit rate",
            )
        return min(times_s, default=answer_wait_s(period_s))
