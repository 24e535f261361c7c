"""A connected drive: from the open line, through identity and watchdog, to its requests and the state that it tells."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import nan
from time import perf_counter

from drivers.contract import Inspection, Mode, Sample, Status
from drivers.errors import DriveConfigurationError, DriveError
from drivers.joint import JointScale, Standstill
from drivers.modbus.blocks import LONGEST_WRITE, Block, blocks
from drivers.modbus.link import Link
from drivers.modbus.opening import identify, set_current_limit, set_watchdog
from drivers.modbus.power_stage import Demand, Values, state_of
from drivers.modbus.register import Space
from drivers.modbus.register_map import SLOW, RegisterMap
from drivers.modbus.sampling import Sampling
from drivers.modbus.settings import ModbusSettings
from drivers.refusal import not_to_be_enabled
from drivers.serial_latency import latency_note

ENABLING_S = 0.5  # longest wait for the drive to say that it is on


@dataclass(frozen=True, slots=True)
class Exchange:
    """The requests of a cycle.

    Attributes:
        written: control, mode and demands.
        read: what is asked for in every cycle.
        slow: what is asked for in turn, now and then.
        in_one: whether one request does it all.
    """

    written: list[Block]
    read: list[Block]
    slow: list[Block]
    in_one: bool

    def cycle(self, link: Link, values: Mapping[str, float]) -> Values:
        """Write values by register name, and return what was read, by register name.

        Raises:
            DriveConnectionError: no valid answer in time.
            ValueError: a value that its register does not hold; nothing was sent.
        """
        words = [block.encode(values) for block in self.written]
        if self.in_one:
            return self.read[0].decode(link.write_then_read(self.written[0], words[0], self.read[0]))
        for block, data in zip(self.written, words, strict=True):
            link.write(block, data)
        found: Values = {}
        for block in self.read:
            found |= block.decode(link.read(block))
        return found


def plan(register_map: RegisterMap) -> Exchange:
    """The fewest requests that a map allows."""
    written = list(register_map.demand.values())
    written += [part.register for part in (register_map.control, register_map.mode) if part is not None]
    fast = [register for name, register in register_map.measured.items() if name not in SLOW]
    fast += [register_map.status.register] if register_map.status is not None else []
    fast += [register_map.fault] if register_map.fault is not None else []
    slow = [register for name, register in register_map.measured.items() if name in SLOW]
    gap = register_map.longest_gap
    quick, everything = blocks(fast, gap), blocks([*fast, *slow], gap)
    if len(everything) <= len(quick):  # what is slow comes along for nothing
        quick, slow = everything, []
    write_blocks = blocks(written, longest=LONGEST_WRITE)
    in_one = (
        register_map.read_write
        and len(write_blocks) == len(quick) == 1
        and quick[0].space is write_blocks[0].space is Space.HOLDING
    )
    return Exchange(write_blocks, quick, blocks(slow, gap), in_one)


class Session:
    """Everything between connecting and disconnecting.

    Attributes:
        told: the state that the drive was last told to be in.

    Raises:
        DriveError: at the first step that fails. The drive is off then where it can be told, and the port is free.
    """

    def __init__(self, settings: ModbusSettings, register_map: RegisterMap, joint: JointScale) -> None:
        self._settings, self._map, self._joint = settings, register_map, joint
        self._plan = plan(register_map)
        self._demand = Demand(register_map, joint)
        self._sampling = Sampling(register_map, joint)
        self._braking = Standstill()
        self._fault = self._cycle = 0
        self.told = self.state = Status.DISABLED
        self.link = Link(settings, register_map.write_function)
        try:
            self.link.begin()
            self.identity = identify(self.link, register_map, settings.device)
            self.switch_off()
            self._forgive_lost_host()
            self.link.begin()
            set_watchdog(self.link, register_map, settings)
            set_current_limit(self.link, register_map, settings)
            self._read_slow()
            self.notes = self._latency_note() if settings.transport == "rtu" else ()
        except BaseException:
            self.leave()
            raise

    def begin(self) -> None:
        """A call of the contract begins."""
        self.link.begin()

    def switch_on(self, mode: Mode) -> None:
        """Power the stage, with a demand that moves nothing."""
        self.told = Status.ENABLED
        deadline_s = perf_counter() + ENABLING_S
        self._stay(mode)
        while self.state is not Status.ENABLED:
            if self.state is Status.FAULT:
                raise not_to_be_enabled(self._settings.device, self.fault_text())
            if perf_counter() > deadline_s:
                raise not_to_be_enabled(self._settings.device, self.state.name.lower())
            self._stay(mode)

    def move(self, mode: Mode, value: float) -> Sample:
        """One cycle with a demand [duty, A or rad of the joint].

        Raises:
            DriveConnectionError: no valid answer within the time limit.
            DriveConfigurationError: its register does not hold the value; nothing was sent.
        """
        asked_s = perf_counter()
        return self._sample(self._move(mode, value), asked_s)

    def rest(self) -> Sample:
        """One cycle without a demand."""
        if self.told is Status.ENABLED:
            self.told = Status.DISABLED
        asked_s = perf_counter()
        return self._sample(self._rest(), asked_s)

    def switch_off(self) -> None:
        """Power off, within a time limit of its own."""
        self.link.begin()
        self.told = Status.DISABLED
        self._rest()

    def begin_quick_stop(self) -> None:
        """Brake where it is enabled, in the drive's own way; `told` is DISABLED again once that is over."""
        if self.told is Status.ENABLED:
            self.told = Status.QUICK_STOP
            self._braking.restart()
            self._rest()

    def clear_fault(self) -> None:
        """Acknowledge a fault, and switch off."""
        clearing = self._demand.clearing()
        if clearing is not None:
            self._transact(clearing)
        self.switch_off()

    def inspect(self) -> Inspection:
        """State, fault and applied output, by reading alone."""
        values: Values = {}
        for block in self._plan.read:
            values |= block.decode(self.link.read(block))
        self._follow(values)
        is_fault = self.state is Status.FAULT
        status = self._map.status
        told = self.state if is_fault or status is not None else None
        is_off = status is not None and status.holds("torque_off", values[status.register.name])
        seen = f"bit or word 'torque_off' of its {status.register.name}" if status is not None and is_off else ""
        return Inspection(told, self.fault_text() if is_fault else "", *self._sampling.output(values), seen)

    def fault_text(self) -> str:
        """The fault in words."""
        return self._map.fault_name(self._fault) if self._map.fault is not None else "a fault that it does not name"

    def leave(self) -> None:
        """Power off where it answers, and give the port back; otherwise its watchdog stops it."""
        try:
            self.switch_off()
        except DriveError:
            pass
        finally:
            self.link.close()

    def _move(self, mode: Mode, value: float) -> Values:
        found = self._transact(self._demand.motion(mode, value))
        self._demand.keep(mode)
        return found

    def _stay(self, mode: Mode) -> Values:
        """Write the demand of a mode that moves nothing: in POSITION the present one."""
        here_rad = 0.0
        if mode is Mode.POSITION:
            here_rad = self._joint.position_rad(self.link.read_one(self._map.measured["position_counts"]))
        return self._move(mode, here_rad)

    def _rest(self) -> Values:
        """Write that nothing is demanded."""
        return self._transact(self._demand.rest(self.told is Status.QUICK_STOP))

    def _sample(self, values: Values, asked_s: float) -> Sample:
        """The sample of a cycle whose values were asked for at a time [s]; asks for what is slow where it is its turn.

        They were measured then or a little later: ages that come of it are not too small, however slow the line is.
        """
        self._cycle += 1
        if self._plan.slow and self._cycle % self._settings.slow_every == 0:
            self._read_slow()
        return self._sampling.sample(values, self.state, asked_s)

    def _transact(self, values: Mapping[str, float]) -> Values:
        try:
            found = self._plan.cycle(self.link, values)
        except ValueError as error:
            raise DriveConfigurationError(self._settings.device, f"{error}. Limit the demand") from error
        self._follow(found)
        return found

    def _follow(self, values: Values) -> None:
        """Take over the state that the drive reports."""
        self.state = state_of(self._map, values, self.told)
        self._fault = int(values[self._map.fault.name]) if self._map.fault is not None else 0
        if self.told is Status.QUICK_STOP and self._has_stopped(values):
            self.told = Status.DISABLED

    def _has_stopped(self, values: Values) -> bool:
        """Whether a quick stop is over: by the drive's own word, or where it has none by its count."""
        if self._map.status is not None and "quick_stop" in self._map.status.words:
            return self.state is not Status.QUICK_STOP
        return self._braking.stands(values.get(self._map.measured["position_counts"].name, nan))

    def _forgive_lost_host(self) -> None:
        """Clear the fault that says only that the last host went away: this one is here, and the power is off."""
        if self.state is Status.FAULT and self._fault == self._map.watchdog.fault:
            self.clear_fault()

    def _latency_note(self) -> tuple[str, ...]:
        register = self._map.measured["position_counts"]
        self.link.begin()
        return latency_note(self._settings.port, lambda: self.link.read_one(register))

    def _read_slow(self) -> None:
        for block in self._plan.slow:
            self._sampling.keep(block.decode(self.link.read(block)))
