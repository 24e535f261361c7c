"""The simulated drive: the drive contract on a plant, in virtual time."""

from collections.abc import Iterable
from math import ceil, isfinite, nan

from drivers.contract import Command, Description, Inspection, Mode, Sample, Status
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveFault, DriveStateError
from sim_backend.drive.description import describe
from sim_backend.drive.holding_brake import HoldingBrake
from sim_backend.drive.overload import OverloadMeter
from sim_backend.errors import ParameterError
from sim_backend.faults.play import FaultPlay
from sim_backend.faults.script import Fault, FaultScript, SamplesLost, TorqueDisabled
from sim_backend.mechanisms.joint.gravity import Load
from sim_backend.mechanisms.joint.wiring import Wiring
from sim_backend.mechanisms.motor.motor import BRAKE, CURRENT, OPEN, VOLTAGE
from sim_backend.plant.parameters import PlantParameters
from sim_backend.plant.plant import COARSEST_STEP_S, Plant

_OFF, _CURRENT, _ENABLED = Mode.OFF, Mode.CURRENT, Status.ENABLED  # at hand: Python 3.11 takes 0.1 us to find them
_TORQUE_DISABLED = "safe torque off is active; close its circuit, then enable"
_WATCHDOG_FAULT = "watchdog: no command in time"
WATCHDOG_S = 0.1  # without a command, after which the drive switches itself off


class SimulatedDrive:
    """A drive with one joint on it, both simulated.

    Each exchange advances the plant by exactly one period under the command given, then measures: time passes in
    exchanges alone. What the drive measures is in its samples; what really happens is in `plant.truth()`.

    Args:
        parameters: the joint, and what the drive measures of it.
        seed: of the plant's own randomness; the same seed and commands give the same samples, bit for bit.
        device: name used in messages.
        faults: what goes wrong, and when in the drive's time.

    Raises:
        ParameterError: the plant cannot be integrated, or two faults of a kind overlap.
    """

    def __init__(
        self, parameters: PlantParameters, seed: int = 0, device: str = "sim", faults: Iterable[Fault] = ()
    ) -> None:
        if parameters.wiring != Wiring():
            raise ParameterError("wiring: the drive in process has no leads to be swapped; simulate a device instead")
        self.plant = Plant(parameters, seed)
        self._brake = HoldingBrake(self.plant) if parameters.brake.torque_n_m > 0.0 else None
        self._seed = seed
        self._device = device
        self._open = False
        self._fault = ""
        self._switch(Status.DISABLED)
        self._steps, self._period_s = 0, 0.0
        self._silent_cycles = 0
        self._script = FaultScript(faults)
        self._play = FaultPlay(self._script, self.plant)
        self._duty_counts = parameters.supply.duty_counts
        self._overload = OverloadMeter(parameters.overload) if parameters.overload.present else None
        self._modes = {Mode.DUTY, Mode.CURRENT} if parameters.current_loop.present else {Mode.DUTY}

    # the contract --------------------------------------------------------------------------------

    def describe(self) -> Description:
        """Identity and capabilities."""
        return describe(self._device, self.plant.parameters, self._seed, self._modes, WATCHDOG_S)

    def open(self, period_s: float) -> None:
        """Connect. The power stage stays off.

        Raises:
            DriveConfigurationError: the period is shorter than a plant step, or longer than the watchdog waits.
        """
        if not COARSEST_STEP_S <= period_s < WATCHDOG_S:
            raise DriveConfigurationError(
                self._device,
                f"period {period_s:g} s: at least {COARSEST_STEP_S:g} s (a plant step) and less than "
                f"{WATCHDOG_S:g} s (the watchdog) is wanted; change the control period",
            )
        # the longest step that divides the period
        self._steps = ceil(period_s / COARSEST_STEP_S - 1e-9)
        self.plant.use_step(period_s / self._steps)
        self._period_s = self._steps * self.plant.step_s
        self._open = True
        self._switch(Status.DISABLED)

    def close(self) -> None:
        """Power off and disconnect."""
        self._switch(Status.DISABLED)
        self.set_brake(released=False)
        self._open = False

    def set_brake(self, released: bool, confirmed: bool = True) -> None:  # noqa: ARG002  there is no line to wait for
        """Switch the coil of the joint's brake, where the plant has one."""
        if self._brake is not None:
            self._brake.energise(released)

    def enable(self, mode: Mode) -> None:
        """Power the stage for a mode, with zero demand.

        Raises:
            DriveConfigurationError: the drive does not have the mode.
            DriveStateError: the drive is not open, has a fault, is stopping, or its torque is disabled.
        """
        self._require_open("enable")
        if mode not in self._modes:
            names = ", ".join(sorted(known.value for known in self._modes))
            raise DriveConfigurationError(self._device, f"mode '{mode.value}' is not one of its modes ({names})")
        if self._status in (Status.FAULT, Status.QUICK_STOP):
            raise DriveStateError(self._device, f"cannot be enabled in state {self._state_text()}; {self._next_step()}")
        if self._script.holding(TorqueDisabled, self.plant.time_s):
            raise DriveStateError(self._device, f"cannot be enabled: {_TORQUE_DISABLED}")
        self._silent_cycles = 0
        self._switch(Status.ENABLED, mode)

    def disable(self) -> None:
        """Power off; a fault stays until it is cleared."""
        self._require_open("disable")
        if self._status is not Status.FAULT:
            self._switch(Status.DISABLED)

    def quick_stop(self) -> None:
        """Brake with shorted terminals, during the exchanges that follow, until the motor stands; then power off."""
        self._require_open("quick_stop")
        if self._status is Status.ENABLED:
            self._switch(Status.QUICK_STOP)

    def inspect(self) -> Inspection:
        """State, fault and applied output; no time passes."""
        self._require_open("inspect")
        stage, demand = self._held
        duty = demand if stage == VOLTAGE else 0.0 if stage == OPEN else nan
        is_off = self._script.holding(TorqueDisabled, self.plant.time_s) is not None
        return Inspection(self._status, self._fault, duty, torque_off="its circuit is open" if is_off else "")

    def clear_fault(self) -> None:
        """Acknowledge a fault. The drive is left disabled.

        Raises:
            DriveFault: the cause is still there.
        """
        self._require_open("clear_fault")
        if self._status is Status.FAULT:
            trip = self._script.trip(self.plant.time_s)
            if trip:
                raise DriveFault(self._device, f"cannot be cleared: {trip.cause()}; remove the cause, then clear it")
            self._fault = ""
            self._switch(Status.DISABLED)

    def exchange(self, command: Command) -> Sample:
        """Advance the plant by one period under a command, and measure.

        Raises:
            DriveFault: the drive has switched itself off, and motion was commanded.
            DriveStateError: the drive is not open, or motion was commanded in a mode that is not enabled.
            DriveConfigurationError: the command is not finite, or a duty is outside -1 .. 1.
            DriveConnectionError: the script loses this cycle's command and sample; time has passed all the same.
        """
        mode, value, _ = command
        if self._script.faults:
            self._lose_sample()
        self._silent_cycles = 0
        if mode is _OFF:
            self._require_open("exchange")
            if self._status is Status.ENABLED:
                self._switch(Status.DISABLED)
            return self._exchange_unpowered()
        if self._status is not _ENABLED or mode is not self._mode:
            self._refuse_motion(mode)
        if not isfinite(value):
            raise DriveConfigurationError(self._device, f"{mode.value} demand {value}: a finite number is wanted")
        if mode is _CURRENT:
            return self._advance(CURRENT, self.plant.parameters.overload.limited(value), nan)
        if not -1.0 <= value <= 1.0:
            raise DriveConfigurationError(self._device, f"duty {value:g}: -1 .. 1 is allowed; limit the demand")
        duty = round(value * self._duty_counts) / self._duty_counts
        return self._advance(VOLTAGE, duty, duty)

    # what only a simulation can do -----------------------------------------------------------------

    def hang_load(self, load_kg: float, balanced: bool) -> None:
        """Do the technician's work: hang a load on the arm, and put the arm at rest at angle 0.

        Raises:
            DriveStateError: the power stage is on; nobody reaches into a powered arm.
            DriveConfigurationError: the load is negative or not finite.
        """
        if self._status in (Status.ENABLED, Status.QUICK_STOP):
            raise DriveStateError(
                self._device, f"a load can be hung only with power off, not {self._state_text()}; disable it"
            )
        try:
            load = Load(mass_kg=load_kg, balanced=balanced)
        except ParameterError as error:
            raise DriveConfigurationError(self._device, str(error)) from error
        self.plant.hang(load)

    def idle(self, duration_s: float) -> None:
        """Let time pass while nobody talks to the drive. After `WATCHDOG_S` a powered drive switches itself off."""
        self._require_open("idle")
        for _ in range(round(duration_s / self._period_s)):
            self._pass_period()

    # the inside ---------------------------------------------------------------------------------------

    def _advance(self, stage: int, demand: float, duty: float) -> Sample:
        self._held = stage, demand
        plant, faulty = self.plant, self._script.faults
        if faulty and self._meet_faults():
            stage, demand, duty = OPEN, 0.0, 0.0
        if self._brake is not None:
            self._brake.advance()
        position_rad, velocity_rad_s, current_a, temperature_c, supply_v = plant.advance(stage, demand, self._steps)
        if self._overload is not None and self._overload.overloads(current_a, self._period_s):
            self._trip(f"I2t overload, {current_a:.3g} A")
        sample = Sample(
            plant.time_s, 0.0, position_rad, velocity_rad_s, duty, current_a, supply_v, temperature_c, self._status
        )
        return self._play.falsify(sample) if faulty else sample

    def _meet_faults(self) -> bool:
        """Do what the script wants of plant and power stage now; tell whether the stage has gone off."""
        self._play.work_on_plant()
        powered = self._status in (Status.ENABLED, Status.QUICK_STOP)
        trip = self._script.trip(self.plant.time_s)
        if trip and self._status is not Status.FAULT:
            self._trip(trip.cause())
        elif powered and self._script.holding(TorqueDisabled, self.plant.time_s):
            self._switch(Status.DISABLED)
        return powered and self._status not in (Status.ENABLED, Status.QUICK_STOP)

    def _lose_sample(self) -> None:
        """Let a period pass without a host, where the script loses what is sent."""
        if self._open and self._script.holding(SamplesLost, self.plant.time_s):
            time_s = self.plant.time_s
            self._pass_period()
            raise DriveConnectionError(
                self._device, f"no answer to the command of {time_s:.4f} s; check the cable, then connect again"
            )

    def _pass_period(self) -> None:
        """Let a period pass under the last command, until the watchdog acts."""
        silent_s = self._silent_cycles * self._period_s
        if self._status in (Status.ENABLED, Status.QUICK_STOP) and silent_s >= WATCHDOG_S:
            self._trip(_WATCHDOG_FAULT)
        stage, demand = self._held
        if self._script.faults and self._meet_faults():
            stage, demand = self._held
        if self._brake is not None:
            self._brake.advance()
        self.plant.advance(stage, demand, self._steps)
        self._silent_cycles += 1

    def _trip(self, fault: str) -> None:
        """Switch off because of a fault."""
        self._fault = fault
        self._switch(Status.FAULT)

    def _exchange_unpowered(self) -> Sample:
        if self._status is not Status.QUICK_STOP:
            return self._advance(OPEN, 0.0, 0.0)
        sample = self._advance(BRAKE, 0.0, 0.0)
        if sample.velocity_rad_s == 0.0 and self._status is Status.QUICK_STOP:
            self._switch(Status.DISABLED)
        return sample

    def _switch(self, status: Status, mode: Mode = Mode.OFF) -> None:
        self._status = status
        self._mode = mode
        # what the stage does until the next command
        if status is Status.ENABLED:
            self._held = (CURRENT if mode is Mode.CURRENT else VOLTAGE), 0.0
        else:
            self._held = (BRAKE if status is Status.QUICK_STOP else OPEN), 0.0

    def _require_open(self, call: str) -> None:
        if not self._open:
            raise DriveStateError(self._device, f"{call} before open; call open(period_s) first")

    def _refuse_motion(self, mode: Mode) -> None:
        """Raise for a command that the state does not allow."""
        self._require_open("exchange")
        if self._status is Status.FAULT:
            raise DriveFault(self._device, f"switched itself off: {self._fault}; {self._next_step()}")
        raise DriveStateError(
            self._device, f"a {mode.value} command in state {self._state_text()}; {self._next_step(mode)}"
        )

    def _state_text(self) -> str:
        text = self._status.name.lower().replace("_", " ")
        return f"'{text}' ({self._mode.value})" if self._status is Status.ENABLED else f"'{text}'"

    def _next_step(self, mode: Mode = Mode.DUTY) -> str:
        if self._status is Status.FAULT:
            return "find the cause, then clear the fault"
        if self._status is Status.QUICK_STOP:
            return "exchange OFF commands until it stands"
        if self._script.holding(TorqueDisabled, self.plant.time_s):
            return _TORQUE_DISABLED
        return f"enable {mode.value} mode first"
