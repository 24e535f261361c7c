"""A drive small enough to be checked by eye: a rigid joint with dry friction, no backlash, and faults on demand."""

import time
from collections.abc import Callable
from math import copysign, nan, sin

from bench.config.rig import Arm, Gear, Motor, Rig, Sensor, Supply
from drivers.contract import Command, Description, Inspection, Mode, Sample, Status
from drivers.errors import DriveStateError

RATIO = 50.0
RIG = Rig(
    name="fake",
    motor=Motor(resistance_ohm=4.0, back_emf_v_s_rad=0.02, torque_constant_n_m_a=0.02),
    gear=Gear(ratio=RATIO, backlash_rad=0.0),
    arm=Arm(length_m=0.4, centre_of_mass_m=0.0),
    sensor=Sensor(counts_per_turn=4096),
    supply=Supply(voltage_v=24.0),
)


class FakeDrive:
    """Duty in, sample out. `alter` may change each sample; `before` is called with the number of each exchange."""

    def __init__(
        self,
        alter: Callable[[int, Sample], Sample] = lambda _cycle, sample: sample,
        before: Callable[[int], None] = lambda _cycle: None,
        modes: frozenset[Mode] = frozenset({Mode.DUTY}),
    ) -> None:
        self.alter, self.before, self.modes = alter, before, modes
        self.calls: list[str] = []
        self.commands: list[Command] = []
        self.powered = False
        self.exchanges = 0
        self.position_rad = 0.0
        self.velocity_rad_s = 0.0
        self.load_torque_n_m = 0.0
        self.friction_n_m = 0.2
        self.watches = True  # switches itself off after 0.1 s without an exchange; seen by `inspect` alone
        self._time_s = 100.0
        self._heard_s = time.perf_counter()
        self._period_s = nan

    def describe(self) -> Description:
        return Description(
            "fake", "tests", "rigid joint", "1", "0", True, self.modes, frozenset(Sample._fields) - {"current_a"},
            {"position_rad": 6.283185 / 4096 / RATIO}, 10_000.0, 0.1,
        )  # fmt: skip

    def open(self, period_s: float) -> None:
        self.calls.append("open")
        self._period_s = period_s

    def close(self) -> None:
        self.calls.append("close")
        self.powered = False

    def enable(self, mode: Mode) -> None:
        self.calls.append(f"enable {mode.value}")
        self.powered = True

    def disable(self) -> None:
        self.calls.append("disable")
        self.powered = False

    def quick_stop(self) -> None:
        self.calls.append("quick_stop")
        self.powered = False

    def inspect(self) -> Inspection:
        self.calls.append("inspect")
        if self.watches and time.perf_counter() - self._heard_s > 0.1:
            self.powered = False
        return Inspection(Status.ENABLED if self.powered else Status.DISABLED)

    def clear_fault(self) -> None:
        self.calls.append("clear_fault")

    def hang_load(self, load_kg: float, balanced: bool) -> None:
        self.calls.append(f"hang {load_kg:g} {'balanced' if balanced else 'hanging'}")
        self.load_torque_n_m = 0.0 if balanced else load_kg * 9.80665 * 0.4

    def exchange(self, command: Command) -> Sample:
        self.before(self.exchanges)
        if command.mode is not Mode.OFF and not self.powered:
            raise DriveStateError("fake", "motion commanded while disabled")
        self.commands.append(command)
        self._heard_s = time.perf_counter()
        duty = command.value if command.mode is Mode.DUTY else 0.0
        self._time_s += self._period_s
        for _ in range(10):
            self._step(duty, self._period_s / 10)
        count_rad = 6.283185307179586 / 4096 / RATIO
        sample = Sample(
            self._time_s, 0.0, round(self.position_rad / count_rad) * count_rad, self.velocity_rad_s, duty, nan, 24.0,
            25.0, Status.ENABLED if self.powered else Status.DISABLED,
        )  # fmt: skip
        sample = self.alter(self.exchanges, sample)
        self.exchanges += 1
        return sample

    def _step(self, duty: float, step_s: float) -> None:
        current_a = (24.0 * duty - 0.02 * self.velocity_rad_s * RATIO) / 4.0 if self.powered else 0.0
        drive_n_m = current_a * 0.02 * RATIO - self.load_torque_n_m * sin(self.position_rad)
        inertia_kg_m2 = 0.03
        if self.velocity_rad_s == 0.0:
            if abs(drive_n_m) <= self.friction_n_m:
                return
            net_n_m = drive_n_m - copysign(self.friction_n_m, drive_n_m)
        else:
            net_n_m = drive_n_m - copysign(self.friction_n_m, self.velocity_rad_s)
        velocity_rad_s = self.velocity_rad_s + net_n_m / inertia_kg_m2 * step_s
        if velocity_rad_s * self.velocity_rad_s < 0.0:
            velocity_rad_s = 0.0
        self.velocity_rad_s = velocity_rad_s
        self.position_rad += velocity_rad_s * step_s


class ListSink:
    """Keeps what it is given; fails on the block of a given number."""

    def __init__(self, fail_on_block: int | None = None) -> None:
        self.blocks: list = []
        self.events: list[tuple[float, str, str]] = []
        self._fail_on_block = fail_on_block

    def append(self, rows, events=()) -> None:
        if len(self.blocks) == self._fail_on_block:
            raise OSError("No space left on device")
        if len(rows):
            self.blocks.append(rows)
        self.events += events
