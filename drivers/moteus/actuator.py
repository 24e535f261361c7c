"""One moteus controller on its line: a torque with a time limit out, its registers in."""

from collections.abc import Callable, Sequence
from time import perf_counter

from drivers.actuator.actuator import Actuator
from drivers.actuator.open_buses import check_alone
from drivers.actuator.reading import Reading
from drivers.contract import Mode
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveStateError, WatchdogError
from drivers.joint import JointScale
from drivers.moteus.frames import POSITION, Frames, fault_name, reading_of, registers, state, text_of
from drivers.moteus.opening import Line
from drivers.moteus.settings import MoteusSettings
from drivers.polled_drive import Identity

_BEGIN_S = 1.0  # longest wait until it drives
_ANSWER_POLLS = 30  # of its console
_LINE_BYTES = 48
TIMEOUT_MODE = "servo.timeout_mode"
SIMULATED_SERIAL = "4c415445-53494d55-00000000"  # of our own simulated device


class MoteusActuator(Actuator):
    """A controller, opened: stopped, and told to be off where its watchdog runs out.

    Args:
        line: open.
        settings: which controller.
        joint: scales and signs.
        leave: called when it is closed; gives the line back.

    Raises:
        DriveError: at the first step that fails.
    """

    modes = frozenset({Mode.TORQUE})
    measured = frozenset(
        {"time_s", "position_rad", "velocity_rad_s", "current_a", "torque_n_m", "supply_v", "temperature_c"}
    )
    notes: tuple[str, ...] = ()
    bus: Line

    def __init__(self, line: Line, settings: MoteusSettings, joint: JointScale, leave: Callable[[], None]) -> None:
        self.bus = line
        self.servo_id, self._settings, self._leave = settings.servo_id, settings, leave
        self._frames = Frames(settings.servo_id, settings.watchdog_s)
        self._counts_per_turn = joint.counts_per_turn
        self._brakes = False
        self.switch_off()
        # first of all: with two of one id the answer to one question may be taken for that to the next
        check_alone(settings.device, f"servo_id ({settings.servo_id})", self._answers)
        self.identity = self._identify()
        self._be_off_after_silence()

    @property
    def steps(self) -> dict[str, float]:
        """Smallest step of each quantity; of the others nothing is known."""
        return {"position_rad": 1.0}

    def begin(self) -> None:
        """A call of the contract begins."""

    def switch_on(self, mode: Mode, here: Reading) -> None:  # noqa: ARG002
        """A torque of 0, until it drives.

        Raises:
            DriveStateError: it does not get there.
        """
        self._brakes = False
        end_s = perf_counter() + _BEGIN_S
        while True:
            data = self._ask(self._frames.torque(0.0), "registers")
            found = state(data)
            if found is not None and found.mode == POSITION:
                return
            why = "" if found is None else fault_name(found)
            if why or perf_counter() > end_s:
                stays = f"its mode is {'not told' if found is None else found.mode}, {POSITION} is wanted"
                raise DriveStateError(
                    self._settings.device, f"does not switch on: {why or stays}; calibrate it with moteus_tool first"
                )

    def switch_off(self) -> None:
        """Stop: the driver is off."""
        self._ask(self._frames.stop, "stop")

    @staticmethod
    def exchange_all(demands: Sequence[tuple["MoteusActuator", Mode, float]]) -> list[Reading]:
        """Send every torque and question, then wait for all answers."""
        asked_s = perf_counter()
        questions = {one.servo_id: one.question(mode, value) for one, mode, value in demands}
        answers = demands[0][0].bus.ask(questions, "registers")
        return [one.reading(answers[one.servo_id], asked_s) for one, _, _ in demands]

    def braking(self) -> tuple[Mode, float]:
        """Its brake: the windings shorted."""
        self._brakes = True
        return Mode.TORQUE, 0.0

    def clear_fault(self) -> None:
        """Stop: it forgets its fault where the cause is gone."""
        self.switch_off()

    def shout_off(self) -> None:
        """Stop, and wait for no answer."""
        self.bus.tell(self.servo_id, self._frames.stop)

    def question(self, mode: Mode, value: float) -> bytes:
        """The data of a cycle."""
        if mode is Mode.OFF:
            return self._frames.question
        return self._frames.brake if self._brakes else self._frames.torque(value)

    def reading(self, data: bytes, asked_s: float) -> Reading:
        """An answer in SI.

        Raises:
            DriveConnectionError: it is none.
        """
        found = state(data)
        if found is None:
            raise DriveConnectionError(
                self._settings.device, f"an answer that has not what was asked for: {data.hex(' ')}; check the cable"
            )
        return reading_of(found, self._counts_per_turn, asked_s)

    def _identify(self) -> Identity:
        """Version and serial number."""
        found = registers(self._ask(self._frames.identity, "identity"))
        if not {0x101, 0x120, 0x121, 0x122} <= found.keys():
            raise DriveConfigurationError(self._settings.device, "it has no firmware version: is it a moteus?")
        version = int(found[0x101])
        serial = "-".join(f"{int(found[one]) & 0xFFFFFFFF:08x}" for one in (0x122, 0x121, 0x120))
        firmware = f"{version >> 16 & 0xFF}.{version >> 8 & 0xFF}.{version & 0xFF}"
        return Identity("mjbots", "moteus", firmware, serial, serial == SIMULATED_SERIAL)

    def _answers(self) -> int:
        heard = self.bus.listen({self.servo_id: self._frames.question}, self._settings.answer_timeout_s)
        return sum(servo_id == self.servo_id for servo_id, _ in heard)

    def _be_off_after_silence(self) -> None:
        """Let its watchdog take the power away: as delivered it holds the speed at 0 then, with power."""
        found = self._console(f"conf get {TIMEOUT_MODE}")
        if found != "0":
            self._console(f"conf set {TIMEOUT_MODE} 0")
            found = self._console(f"conf get {TIMEOUT_MODE}")
        if found != "0":
            raise WatchdogError(
                self._settings.device,
                f"its {TIMEOUT_MODE} reads back as '{found}', and 0 (stopped) is wanted: else it holds after silence. "
                "Set it with tview",
            )

    def _console(self, line: str) -> str:
        """The first line that its console answers."""
        self._heard_text()
        for start in range(0, len(line) + 1, _LINE_BYTES):
            self.bus.tell(self.servo_id, self._frames.text((line + "\n")[start : start + _LINE_BYTES]))
        text = b""
        for _ in range(_ANSWER_POLLS):
            text += text_of(self._ask(self._frames.text_question, "console"))
            whole, end, _ = text.lstrip().partition(b"\n")
            if end:
                return whole.strip().decode("ascii", "replace")
        raise DriveConnectionError(self._settings.device, f"its console does not answer '{line}'; found {text!r}")

    def _heard_text(self) -> None:
        """Take what its console has said before."""
        for _ in range(_ANSWER_POLLS):
            if not text_of(self._ask(self._frames.text_question, "console")):
                return

    def _ask(self, data: bytes, what: str) -> bytes:
        return self.bus.ask({self.servo_id: data}, what)[self.servo_id]
