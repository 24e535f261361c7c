"""The CiA 402 drive: node, state machine and modes around an axis."""

from threading import RLock

from drivers.contract import Sample
from sim_backend.devices.axis import CURRENT, OFF, Axis, Demand, Device
from sim_backend.devices.can.frame import Frame
from sim_backend.devices.canopen.abort import Abort, AbortCode, only
from sim_backend.devices.canopen.conduct import GOOD, REACTIONS, Conduct
from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.emergency import ErrorCode
from sim_backend.devices.canopen.measured import Measured
from sim_backend.devices.canopen.modes.braking import Braking
from sim_backend.devices.canopen.modes.cyclic_position import CyclicPosition
from sim_backend.devices.canopen.modes.homing import METHODS, Homing
from sim_backend.devices.canopen.modes.mode import Mode, Seen, Units
from sim_backend.devices.canopen.modes.modes import make_modes
from sim_backend.devices.canopen.modes.position_loop import Gains, PositionLoop
from sim_backend.devices.canopen.modes.profile_position import ProfilePosition
from sim_backend.devices.canopen.node import Node
from sim_backend.devices.canopen.objects.drive_profile import NO_WINDOW
from sim_backend.devices.canopen.objects.family import Family, Rating
from sim_backend.devices.canopen.state_machine import (
    QUICK_STOP_CODES,
    Command,
    Ending,
    State,
    StateMachine,
    command_of,
)
from sim_backend.faults.script import tripped
from sim_backend.plant.parameters import PlantParameters

_REMOTE, _LIMITED, _WARNING, _VOLTAGE = 1 << 9, 1 << 11, 1 << 7, 1 << 4
_FOLLOWING_ERROR = 1 << 13
_INTERLOCK = 1 << 3  # of 0x60FD: safe torque off is active
_WARM_C = 85.0


class ServoDrive(Device):
    """One drive on a CAN bus.

    Args:
        parameters: the joint on it.
        family: which objects it has.
        node_id: 1 .. 127.
        seed: of the plant.
        conduct: its manners.
    """

    def __init__(
        self, parameters: PlantParameters, family: Family, node_id: int, seed: int = 0, conduct: Conduct = GOOD
    ) -> None:
        rating = Rating.of(parameters)
        self.family = family
        self.lock = RLock()
        objects = family.objects(rating)
        self.dictionary = Dictionary(objects, node_id, conduct.absent_code, conduct.refused_code)
        self.node = Node(self.dictionary, conduct)
        self._conduct = conduct
        self.axis = Axis(parameters, self, seed)
        self._rating = rating
        self._measured = Measured(self.axis, self.dictionary, family, rating)
        self._loop = PositionLoop(Gains.tuned(parameters, rating.torque_n_m))
        self._braking = Braking(self._loop)
        units = Units(self._measured.counts, self._measured.counts_per_s, self._measured.counts_per_s2)
        self._modes = make_modes(family.modes, self.dictionary, self._loop, units, self.axis, rating.counts_per_turn)
        self._machine = StateMachine(self._option)
        self._wire()
        self._begin()

    def _begin(self) -> None:
        self._machine.reset()
        self._mode: Mode | None = None
        self._mode_number = 0
        self._controlwords: list[int] = []
        self._look_s = 0.0
        self._enabling_s: float | None = None
        self._enabled = False
        self._ending: Ending | None = None
        self._limited = False
        self._astray_since_s: float | None = None
        self._follow_output()

    def _wire(self) -> None:
        book = self.dictionary
        live = self._measured.live() | {
            (0x6041, 0): self._statusword,
            (0x6061, 0): self._mode_shown,
            (0x6062, 0): lambda: self._measured.position(self._position_demand()),
            (0x60FD, 0): lambda: _INTERLOCK if self.axis.torque_is_disabled() else 0,
            (0x60F4, 0): lambda: self._measured.position(self._position_demand() - self.axis.counts()),
        }
        book.live = {place: source for place, source in live.items() if place in book}
        book.checks[0x6060, 0] = self._check_mode
        book.checks[0x605A, 0] = only(QUICK_STOP_CODES)
        book.checks[0x6098, 0] = only(METHODS)
        book.reactions[0x6040, 0] = lambda: self._controlwords.append(book.number(0x6040))
        book.reactions[0x607A, 0] = self._aim
        book.reactions[0x60FE, 1] = book.reactions[0x60FE, 2] = self._follow_output
        self.node.on_reset = self._begin
        self.node.on_lost = self._lose_master

    # what the threads around it call ------------------------------------------------------------------

    def receive(self, frame: Frame, time_s: float) -> None:
        """Take a frame from the bus at a time [s]; answers go out through `node.send`."""
        self.node.receive(frame, time_s)

    def report(self) -> dict[str, object]:
        """Say what the drive is about."""
        return {
            "kind": "canopen",
            "nmt": self.node.state.name,
            "state": self._machine.state.name,
            "mode": self._mode_number,
            "error_code": self.dictionary.number(0x603F),
            "watchdog_trips": self.node.losses,
            "brake": "set" if self.axis.brake.holds else "released",
        }

    # the real-time half ---------------------------------------------------------------------------------

    def demand(self, seen: Sample) -> Demand:  # noqa: ARG002
        """Return the current of the coming tick."""
        self._measured.tick()
        self.node.poll(self.axis.time_s)
        self._meet_faults()
        self._obey()
        return self._apply(self._torque(self._seen()))

    def _torque(self, seen: Seen) -> float | None:
        """Return the torque [permille]; None with the stage off."""
        machine = self._machine
        if machine.ending is not None:
            return self._brake(machine.ending, seen)
        self._ending = None
        if machine.state is not State.OPERATION_ENABLED:
            self._enabled = False
            if self._conduct.sets_brake:
                self.axis.brake.energise(False)
            return None
        self._choose_mode(seen)
        if self._conduct.sets_brake:
            self.axis.brake.energise(True)
        return 0.0 if self._mode is None else self._mode.torque(seen)

    def _brake(self, ending: Ending, seen: Seen) -> float:
        if ending != self._ending:
            self._ending, self._enabled = ending, False
            self._braking.start(seen)
        if self._braking.done:
            self._set_own_brake()
        deceleration = self._measured.counts_per_s2(self.dictionary.number(ending.ramp.value))
        return self._braking.torque(seen, deceleration)

    def _set_own_brake(self) -> None:
        """The motor stands: it is held until the brake does that, where the drive sets it."""
        if self._conduct.sets_brake:
            self.axis.brake.energise(False)
        if not self._conduct.sets_brake or self.axis.brake.holds:
            self._machine.braked()

    def _follow_output(self) -> None:
        """Let the brake's coil follow bit 0 of the outputs, where the mask lets it through."""
        book = self.dictionary
        if self._conduct.sets_brake or (0x60FE, 1) not in book:
            return
        mask = book.number(0x60FE, 2) if (0x60FE, 2) in book else 1
        self.axis.brake.energise(bool(mask & 1) and not book.number(0x60FE, 1) & 1)

    def _choose_mode(self, seen: Seen) -> None:
        wanted = self.dictionary.number(0x6060)
        if wanted != self._mode_number or not self._enabled:
            self._mode_number, self._mode, self._enabled = wanted, self._modes.get(wanted), True
            if self._mode is not None:
                self._mode.start(seen)

    def _apply(self, permille: float | None) -> Demand:
        limit = self._limit_permille()
        self._loop.limit_permille = limit
        self._limited = permille is not None and abs(permille) > limit
        applied = 0.0 if permille is None else max(-limit, min(limit, permille))
        self._loop.applied_permille = applied
        self._measured.demand_a = self._measured.current_of_torque(applied)
        return OFF if permille is None else Demand(CURRENT, self._measured.demand_a)

    def _words(self) -> list[int]:
        """Return the controlwords that the drive sees now: each, or the last one when it looks."""
        if self._conduct.look_s and self.axis.time_s < self._look_s:
            return []
        words, self._controlwords = self._controlwords, []
        if not self._conduct.look_s:
            return words
        self._look_s = self.axis.time_s + self._conduct.look_s
        return words[-1:]

    def _waits(self, word: int) -> bool:
        """Tell whether the brake, or whatever takes time, still holds up enabling; the word is looked at again."""
        ready = self._machine.state in (State.READY_TO_SWITCH_ON, State.SWITCHED_ON)
        if not self._conduct.enable_s or not ready or command_of(word) is not Command.ENABLE_OPERATION:
            self._enabling_s = None
            return False
        if self._enabling_s is None:
            self._enabling_s = self.axis.time_s
        return self.axis.time_s - self._enabling_s < self._conduct.enable_s

    def _obey(self) -> None:
        words = self._words()
        for place, word in enumerate(words, 1):
            if self._waits(word):
                if place == len(words):
                    self._controlwords.insert(0, word)
                continue
            was_enabled = self._enabled
            if self._machine.obey(word, fault_is_over=self.axis.trip() is None):
                self.dictionary.put(0x603F, 0, 0)
                self.node.clear_errors()
            if was_enabled and isinstance(self._mode, ProfilePosition | Homing):
                self._mode.command(word)
        if self._machine.state is not State.OPERATION_ENABLED:
            self._mode_number = self.dictionary.number(0x6060)

    def _meet_faults(self) -> None:
        trip = self.axis.trip()
        if trip is not None:
            code = tripped(
                trip, ErrorCode.OVER_TEMPERATURE, ErrorCode.OVER_CURRENT, ErrorCode.UNDER_VOLTAGE, ErrorCode.GENERIC
            )
            self._fault(ErrorCode(code), at_once=True)
        elif self.axis.torque_is_disabled():
            self._obey()
            self._machine.lose_torque()
        if self._goes_astray():
            self._fault(ErrorCode.FOLLOWING_ERROR)

    def _fault(self, code: ErrorCode, at_once: bool = False) -> None:
        if self._machine.state not in (State.FAULT, State.FAULT_REACTION_ACTIVE):
            self.dictionary.put(0x603F, 0, code)
        self.node.raise_error(code)
        if at_once:
            self._machine.fail()
        else:
            self._machine.fault()

    def _goes_astray(self) -> bool:
        """Tell whether the following error has been outside its window for too long."""
        if not self._is_astray():
            self._astray_since_s = None
            return False
        if self._astray_since_s is None:
            self._astray_since_s = self.axis.time_s
        return self.axis.time_s - self._astray_since_s >= self.dictionary.number(0x6066) * 1e-3

    def _is_astray(self) -> bool:
        if not self._enabled or self._mode is None:
            return False
        window = self.dictionary.number(0x6065)  # 0 where nobody has set it
        if not window or window == NO_WINDOW or self._mode.position() is None:
            return False
        return abs(self._position_demand() - self.axis.counts()) > self._measured.counts(window)

    def _lose_master(self, code: ErrorCode) -> None:
        before = self._machine.state
        if (0x60FE, 1) in self.dictionary:  # outputs fall back
            self.dictionary.put(0x60FE, 1, 1)
            self._follow_output()
        self._machine.lose_master()
        if self._machine.state is not before and self._machine.state in (State.FAULT, State.FAULT_REACTION_ACTIVE):
            self.dictionary.put(0x603F, 0, code)

    # what objects ask -----------------------------------------------------------------------------------

    def _option(self, index: int) -> int:
        """Return an option code; that of a lost host by the drive's manners where it has no object for it."""
        if index == 0x6007 and self.dictionary.is_hidden(index):
            return REACTIONS[self._conduct.reaction]
        return self.dictionary.number(index)

    def _mode_shown(self) -> int:
        hides = self._conduct.mode_shown_enabled and self._machine.state is not State.OPERATION_ENABLED
        return 0 if hides else self._mode_number

    def _seen(self) -> Seen:
        return Seen(self.axis.time_s, self.axis.counts(), self.axis.counts_per_s())

    def _statusword(self) -> int:
        state = self._machine.state
        word = state.value | _REMOTE
        if self.axis.seen.supply_v > 0.0:
            word |= _VOLTAGE
        if self._limited:
            word |= _LIMITED
        if self.axis.temperature_c >= _WARM_C:
            word |= _WARNING
        if self._is_astray():
            word |= _FOLLOWING_ERROR
        if state is State.OPERATION_ENABLED and self._mode is not None and self._enabled:
            word |= self._mode.status()
        return word

    def _position_demand(self) -> float:
        position = self._mode.position() if self._enabled and self._mode is not None else None
        return self.axis.counts() if position is None else position

    def _limit_permille(self) -> float:
        limits_a = (self.dictionary.number(*place) * unit_a(self._rating) for place, unit_a in self.family.peak)
        return self._measured.torque_of_current(min(limits_a))

    def _aim(self) -> None:
        if self._enabled and isinstance(self._mode, CyclicPosition):
            self._mode.aim(self.axis.time_s)

    def _check_mode(self, value: int) -> None:
        if value != 0 and value not in self.family.modes:
            raise Abort(AbortCode.INVALID_VALUE)
        if value != self._mode_number and self.axis.mode_is_refused():
            raise Abort(AbortCode.DEVICE_STATE)
