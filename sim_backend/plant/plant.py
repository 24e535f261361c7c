"""The plant: parameters, state and the compiled kernel behind four calls."""

from dataclasses import dataclass, replace
from math import sin
from typing import Any

import numpy as np

from sim_backend.environment.end_stops import Wall
from sim_backend.environment.operator import Operator
from sim_backend.errors import ParameterError
from sim_backend.mechanisms.friction.friction import Friction
from sim_backend.mechanisms.joint.clutch import Clutch
from sim_backend.mechanisms.joint.gravity import STANDARD_GRAVITY_M_S2, Load
from sim_backend.plant.jit import pack
from sim_backend.plant.kernel import Measured, Whole, advance, stored_energy
from sim_backend.plant.parameters import PlantParameters, constants_of
from sim_backend.plant.state import at_rest
from sim_backend.plant.stiffness import quickest, stiffest

COARSEST_STEP_S = 1e-4


@dataclass(frozen=True, slots=True)
class Truth:
    """What no sensor of the drive shows. For tests and demonstrations only.

    Rotor angles are motor angles / ratio; bristles are measured at the shaft where the friction acts.
    """

    time_s: float
    rotor_rad: float
    rotor_rad_s: float
    arm_rad: float
    arm_rad_s: float
    current_a: float
    contact_n_m: float
    clutch_rad: float
    leant_n_m: float
    hand_n_m: float
    bristle_rad: float
    arm_bristle_rad: float
    winding_c: float
    housing_c: float


_TRUE = tuple(name for name in Truth.__dataclass_fields__ if name != "time_s")
_FORGOTTEN = (
    "current_a", "contact_n_m", "leant_n_m", "hand_n_m", "clutch_rad", "slid",
    "bristle_rad", "arm_bristle_rad", "rest_s", "arm_rest_s",
    "hose_first_rad", "hose_second_rad", "hose_third_rad",
)  # fmt: skip
_PLACED = ("rotor_rad", "rotor_rad_s", "rotor_mean_rad_s", "arm_rad", "arm_rad_s", "arm_mean_rad_s", *_FORGOTTEN)


@dataclass(frozen=True, slots=True)
class Energy:
    """Energy since the plant was made [J]: supplied = lost + stored (+ what a technician's hand put in).

    Supplied is what came from the supply and from the operator's hand; either may also take.
    """

    supplied_j: float
    lost_j: float
    stored_j: float


class Plant:
    """One joint, with its load hung on, at rest at angle 0.

    Args:
        parameters: what it is made of.
        seed: of its own randomness; the same seed gives the same bytes, however the steps are grouped into calls.
        step_s: integration step [s].

    Raises:
        ParameterError: the step is too coarse for something stiff.
    """

    def __init__(self, parameters: PlantParameters, seed: int = 0, step_s: float = COARSEST_STEP_S) -> None:
        self.parameters = parameters
        self._unbraked: Friction | None = None
        self._whole = pack(Whole(parameters, constants_of(parameters), at_rest(seed, parameters.heat.start_c)))
        self._state = self._whole["state"]  # a view of it
        # and one of each value, at hand: a name that the record looks up costs five times as much
        self._values = {name: self._state[name] for name in (*_TRUE, *_PLACED)}
        self._state["supply_v"] = parameters.supply.voltage_v
        # the record's own count of steps, at hand: reading a record from Python takes as long as a control cycle
        self._origin_s, self._steps = 0.0, 0
        self.step_s = step_s
        self.use_step(step_s)

    def use_step(self, step_s: float) -> None:
        """Go on with another integration step [s]; the drive's speed window starts afresh.

        Raises:
            ParameterError: the step is coarser than 0.1 ms, or too coarse for something stiff.
        """
        self._check_step(step_s)
        self._origin_s, self._steps = self.time_s, 0
        self._state["origin_s"] = self._origin_s
        self._state["origin_steps"] = self._state["steps"]
        self.step_s = step_s
        self._window = max(round(self.parameters.encoder.speed_window_s / step_s), 1)
        self._delay = round(self.parameters.latency.delay_s / step_s)
        self._forget()

    @property
    def time_s(self) -> float:
        """Simulated time since the plant was made [s]."""
        return self._origin_s + self._steps * self.step_s

    def advance(self, stage: int, demand: float, steps: int) -> Measured:
        """Advance at a constant demand and measure.

        Args:
            stage: OPEN, VOLTAGE, CURRENT or BRAKE of `motor`.
            demand: duty -1 .. 1, or current [A], after the stage.
            steps: number of integration steps.

        Returns:
            position [rad], velocity [rad/s], current [A], temperature [degC], supply [V] as the drive measures them.
        """
        self._steps += steps
        # an int would have the kernel compiled for itself
        return advance(self._whole, self._history, stage, float(demand), steps, self.step_s, self._window, self._delay)

    def hang(self, load: Load) -> None:
        """Hang a load on the arm and put the arm at rest at angle 0, in the middle of the free play."""
        self._change(load=load)
        self.place(0.0, 0.0)

    def drop_load(self) -> None:
        """Let the load fall off: weight and inertia are gone, and with them their energy; the arm moves on."""
        self._change(load=Load())

    def loosen_clutch(self, limit_n_m: float) -> None:
        """Let the clutch slip at a torque [N m]; 0 is rigid again."""
        self._change(clutch=Clutch(limit_n_m=limit_n_m))

    def hold_by_brake(self, holds: bool) -> None:
        """Let the holding brake add its torque to the dry friction of the motor shaft, or take it away again."""
        if self._unbraked is None:
            self._unbraked = self.parameters.friction
        free, torque_n_m = self._unbraked, self.parameters.brake.torque_n_m
        locked = replace(free, coulomb_n_m=free.coulomb_n_m + torque_n_m, static_n_m=free.static_n_m + torque_n_m)
        self._change(friction=locked if holds else free)

    def put_wall(self, wall: Wall) -> None:
        """Put a wall in the arm's way, or take it away.

        Raises:
            ParameterError: too stiff for the integration step.
        """
        before = self.parameters
        self._change(wall=wall)
        try:
            self._check_step(self.step_s)
        except ParameterError:
            self._change(wall=before.wall)
            raise

    def take_hold(self, operator: Operator) -> None:
        """Let an operator hold the arm from now on, or have something else in mind; arm and hand move on as they do."""
        self._change(operator=operator)

    def interaction_n_m(self) -> float:
        """Return the true torque that holds up load and arm, and presses the arm against what it leans on [N m]."""
        state, parameters = self._state[0], self.parameters
        angle_rad = float(state["arm_rad"]) + parameters.centre_of_mass.angle_rad
        weight_n_m = STANDARD_GRAVITY_M_S2 * float(self._whole["constants"]["moment_kg_m"][0]) * sin(angle_rad)
        return weight_n_m - float(state["leant_n_m"])

    def _change(self, **components: Any) -> None:
        self.parameters = replace(self.parameters, **components)
        self._whole["parameters"] = pack(self.parameters)
        self._whole["constants"] = pack(constants_of(self.parameters))

    def place(self, rotor_rad: float, arm_rad: float, rotor_rad_s: float = 0.0, arm_rad_s: float = 0.0) -> None:
        """Put rotor (motor angle / ratio) and arm where a hand would, moving as given, without current."""
        moving = (rotor_rad, rotor_rad_s, rotor_rad_s, arm_rad, arm_rad_s, arm_rad_s)
        for name, value in zip(_PLACED, (*moving, *[0.0] * len(_FORGOTTEN)), strict=True):
            self._values[name][0] = value
        self._forget()

    def truth(self) -> Truth:
        """Return the true state."""
        return Truth(self.time_s, *self.true_values(*_TRUE))

    def true_values(self, *names: str) -> list[float]:
        """Return some of the true state, by the names of `Truth` but the time: each takes a while to read."""
        values = self._values
        return [float(values[name].item()) for name in names]

    def energy(self) -> Energy:
        """Return the energy balance so far."""
        state = self._state[0]
        lost = ("electrical_loss_j", "friction_loss_j", "arm_friction_loss_j", "contact_loss_j", "leant_loss_j")
        return Energy(
            float(state["supplied_j"]),
            float(sum(state[name] for name in lost)),
            stored_energy(self._whole),
        )

    def _check_step(self, step_s: float) -> None:
        if not 0.0 < step_s <= COARSEST_STEP_S:
            raise ParameterError(f"step = {step_s:g} [s]: must be above 0 and at most {COARSEST_STEP_S:g}")
        for stiff in stiffest(self.parameters):
            stiff.check(step_s)
        for quick in quickest(self.parameters):
            quick.check(step_s)
        window_s = self.parameters.encoder.speed_window_s
        if window_s < 0.5 * step_s:
            raise ParameterError(
                f"Encoder.speed_window_s = {window_s:g} [s]: shorter than a step, {step_s:g} s, counts nothing"
            )

    def _forget(self) -> None:
        """Fill the drive's memory with what it would see at rest here."""
        self._history = np.zeros((self._window + self._delay + 1, 2))
        self._history[:, 0] = self._state["rotor_rad"]
