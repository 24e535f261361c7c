"""What every simulated device drives: a power stage with a joint on it, advanced in ticks of a millisecond."""

from math import isfinite, isnan, pi
from threading import RLock
from typing import NamedTuple, Protocol

from drivers.contract import Sample, Status
from sim_backend.drive.holding_brake import HoldingBrake
from sim_backend.drive.overload import OverloadMeter
from sim_backend.errors import ParameterError
from sim_backend.faults.play import FaultPlay
from sim_backend.faults.script import Fault, FaultScript, ModeRefused, OverCurrent, TorqueDisabled, Trip
from sim_backend.mechanisms.joint.gravity import Load
from sim_backend.mechanisms.motor.motor import BRAKE, CURRENT, OPEN, VOLTAGE
from sim_backend.mechanisms.motor.thermal_drift import drifted
from sim_backend.plant.parameters import PlantParameters
from sim_backend.plant.plant import COARSEST_STEP_S, Plant

TICK_S = 1e-3
_STEPS = round(TICK_S / COARSEST_STEP_S)
_OVERLOAD_HOLDS_S = 1.0
_ROOM_C = 25.0
# called from here as Python: compiling it for one call in a while costs a second at the start
_drifted = getattr(drifted, "py_func", drifted)
_ELECTRICAL = ("rotor_rad_s", "current_a", "winding_c", "housing_c")
_STAGE_NAMES = {OPEN: "open", VOLTAGE: "voltage", CURRENT: "current", BRAKE: "brake"}


class Demand(NamedTuple):
    """What the power stage does for a tick: a stage of `motor`, and its duty (-1 .. 1) or current [A]."""

    stage: int
    value: float = 0.0


OFF = Demand(OPEN)


class Law(Protocol):
    """The real-time half of a device: asked once a tick, with what the sensors have just shown."""

    def demand(self, seen: Sample) -> Demand:
        """Return what the power stage is to do for the coming tick."""


class Power(NamedTuple):
    """Whether the stage can drive the motor, and since when in the axis' time [s]."""

    on: bool
    since_s: float


class Axis:
    """Power stage and joint.

    Time is the axis' own, from 0; whoever owns the axis says how far it has come. A fault of the script that switches
    a drive off, or an open safe-torque-off circuit, opens the stage whatever the law demands.

    Attributes:
        zero_counts: count that the encoder would show at the 0 of now, had it never begun anew.
    """

    def __init__(self, parameters: PlantParameters, law: Law, seed: int = 0) -> None:
        self.plant = Plant(parameters, seed)
        self.brake = HoldingBrake(self.plant)
        self.script = FaultScript()
        self.applied = OFF
        self.power = Power(False, 0.0)
        self.zero_counts = 0.0
        self._law = law
        self._play = FaultPlay(self.script, self.plant)
        self._overload = OverloadMeter(parameters.overload)
        self._ticks = 0
        self._count_rad = 2.0 * pi / (parameters.encoder.counts_per_turn * parameters.gear.ratio)
        self._duty_counts = parameters.supply.duty_counts
        self._motor_sign, self._encoder_sign = parameters.wiring.motor_sign, parameters.wiring.encoder_sign
        self._held_rad: float | None = None
        self.seen = self._look()

    @property
    def time_s(self) -> float:
        """How far the axis has come [s]."""
        return self._ticks * TICK_S

    @property
    def stage_name(self) -> str:
        """The state of the power stage."""
        return _STAGE_NAMES[self.applied.stage]

    @property
    def current_a(self) -> float:
        """What the device measures of the motor's current [A]; 0 without a sensor."""
        return 0.0 if isnan(self.seen.current_a) else self.seen.current_a

    @property
    def temperature_c(self) -> float:
        """What it measures of the temperature [deg C]; that of a room without a sensor."""
        return _ROOM_C if isnan(self.seen.temperature_c) else self.seen.temperature_c

    def advance_to(self, time_s: float) -> None:
        """Run every tick that is over at a time [s]."""
        while (self._ticks + 1) * TICK_S <= time_s + 1e-9:
            self._tick()

    def trip(self) -> Trip | None:
        """Return what switches the drive off now, or None."""
        return self.script.trip(self.time_s) if self.script else None

    def torque_is_disabled(self) -> bool:
        """Tell whether the safe-torque-off circuit is open."""
        return bool(self.script) and self.script.holding(TorqueDisabled, self.time_s) is not None

    def mode_is_refused(self) -> bool:
        """Tell whether the drive takes no other mode."""
        return self.script.holding(ModeRefused, self.time_s) is not None

    def meet(self, fault: Fault) -> None:
        """Let something go wrong, in the axis' time.

        Raises:
            ParameterError: one of the kind is already there at the time.
        """
        self.script.add(fault)

    def counts(self) -> int:
        """Return the encoder's count."""
        return round(self.seen.position_rad / self._count_rad - self.zero_counts)

    def count_from(self, counts: float) -> None:
        """Have what is some counts now be 0."""
        self.zero_counts += counts

    def counts_per_s(self) -> float:
        """Return the encoder's speed, counted over its window [1/s]."""
        return self.seen.velocity_rad_s / self._count_rad

    def hang_load(self, load_kg: float, balanced: bool) -> None:
        """Hang a load on the arm, and put the arm at rest at angle 0.

        Raises:
            ParameterError: the load is negative or not finite, or the stage drives the motor.
        """
        if self.power.on:
            raise ParameterError("a load can be hung only with the power off; disable the drive, then hang it")
        self.plant.hang(Load(mass_kg=load_kg, balanced=balanced))
        self.seen = self._look()

    def hold_arm(self, angle_rad: float) -> None:
        """Turn the arm by hand to an angle, the motor with it, and hold it there.

        Raises:
            ParameterError: the angle is not finite, or the stage drives the motor.
        """
        if self.power.on or not isfinite(angle_rad):
            raise ParameterError(f"the arm is turned by hand to {angle_rad} rad: with the power off, and by a number")
        self._held_rad = angle_rad
        self.plant.place(angle_rad, angle_rad)
        self.seen = self._look()

    def release_arm(self) -> None:
        """Let go of the arm."""
        self._held_rad = None

    def _tick(self) -> None:
        demand = self._law.demand(self.seen)
        if self.script:
            self._play.work_on_plant()
            if self.trip() is not None or self.torque_is_disabled():
                demand = OFF
        self._apply(demand)
        self.brake.advance()
        measured = self.plant.advance(self.applied.stage, self._motor_sign * self.applied.value, _STEPS)
        if self._held_rad is not None:
            self.plant.place(self._held_rad, self._held_rad)
        self._ticks += 1
        self.seen = self._sample(*measured)
        self._count_overload()

    def _apply(self, demand: Demand) -> None:
        stage, value = demand
        if stage == CURRENT:
            value = self.plant.parameters.overload.limited(value)
        elif stage == VOLTAGE:
            value = round(min(max(value, -1.0), 1.0) * self._duty_counts) / self._duty_counts
        self.applied = Demand(stage, value)
        drives = stage == CURRENT or (stage == VOLTAGE and value != 0.0)
        if drives != self.power.on:
            self.power = Power(drives, self.time_s)

    def _count_overload(self) -> None:
        current_a = self.seen.current_a
        if not isnan(current_a) and self._overload.overloads(current_a, TICK_S) and self.trip() is None:
            self.script.add(
                OverCurrent(start_s=self.time_s, duration_s=_OVERLOAD_HOLDS_S, current_a=max(abs(current_a), 1e-3))
            )

    def _look(self) -> Sample:
        return self._sample(*self.plant.advance(OPEN, 0.0, 0))

    def _sample(
        self, position_rad: float, velocity_rad_s: float, current_a: float, temperature_c: float, supply_v: float
    ) -> Sample:
        status = Status.ENABLED if self.power.on else Status.DISABLED
        encoder, motor = self._encoder_sign, self._motor_sign
        sample = Sample(
            self.time_s, 0.0, encoder * position_rad, encoder * velocity_rad_s, self._duty(supply_v), motor * current_a,
            supply_v, temperature_c, status,
        )  # fmt: skip
        return self._play.falsify(sample) if self.script else sample

    def _duty(self, supply_v: float) -> float:
        """Return the duty that the stage applies; in current mode what the loop needs: (R i + K w) / V, within 1."""
        stage, value = self.applied
        if stage == VOLTAGE:
            return value
        if stage != CURRENT or not supply_v > 0.0:
            return 0.0
        parameters, motor = self.plant.parameters, self.plant.parameters.motor
        rotor_rad_s, current_a, winding_c, housing_c = self.plant.true_values(*_ELECTRICAL)
        winding = _drifted(
            parameters.thermal_drift, motor.resistance_ohm, motor.torque_constant_n_m_a, winding_c, housing_c
        )
        back_emf_v = winding.torque_constant_n_m_a * rotor_rad_s * parameters.gear.ratio
        duty = self._motor_sign * (winding.resistance_ohm * current_a + back_emf_v) / supply_v
        return min(max(duty, -1.0), 1.0)


__all__ = ["BRAKE", "CURRENT", "OFF", "OPEN", "TICK_S", "VOLTAGE", "Axis", "Demand", "Law", "Power"]


class Device(Protocol):
    """A drive's protocol and real-time half on an axis. It reads no clock; whoever calls says what time it is."""

    axis: Axis
    lock: RLock

    def advance_to(self, time_s: float) -> None:
        """Let time pass up to a time [s] of the axis."""
        self.axis.advance_to(time_s)

    def report(self) -> dict[str, object]:
        """What the drive is about, for the side channel: its state, its watchdog, its fault."""
