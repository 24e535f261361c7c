"""A fitted model at work on the bench: what a joint in motion takes beyond inertia and the load that hangs there.

Effects with memory and of the measuring chain are left out: they need what a window of readings does not hold.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Shape
from compensator.lab.recordings.facts import STANDARD_GRAVITY_M_S2, Facts
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import Scales


@dataclass(frozen=True)
class OnlineTerm:
    """One fitted effect: its shape, and its coefficients with the effort as joint torque, shape (k,)."""

    effect: Effect
    shape: Shape
    coefficients: FloatArray


@dataclass(frozen=True)
class OnlineFriction:
    """Motor current of everything in a model but inertia, less the weight by the rig.

    Attributes:
        terms: effects that are computed from the motion of the moment; see `works_online`.
        facts: of the joint; scales: of the study's trials.
        torque_n_m_a: joint torque per motor current, by the rig: what gravity is known by.
        own_n_m: moment of the arm's own weight at 90 degrees, by the rig.
        largest_n_m: largest effort that the model predicts in the study's trials; 0 where nobody kept it.
    """

    terms: tuple[OnlineTerm, ...]
    facts: Facts
    scales: Scales
    torque_n_m_a: float
    own_n_m: float
    largest_n_m: float = 0.0

    def current_a(
        self, position_rad: FloatArray, speed_rad_s: FloatArray, acceleration_rad_s2: float, teeth_a: FloatArray,
        gravity_a: float, temperature_c: float,
    ) -> FloatArray:  # fmt: skip
        """Current [A] at each of some moments in one direction, shape (n,).

        Args:
            position_rad: shape (n,).
            speed_rad_s: shape (n,), of one sign.
            acceleration_rad_s2: of all of them.
            teeth_a: what the teeth pass on, weight and inertia of the arm, shape (n,).
            gravity_a: current that the load takes at 90 degrees.
            temperature_c: NaN where it is not measured: effects of it count as none then.
        """
        motion = self._motion(position_rad, speed_rad_s, acceleration_rad_s2, gravity_a, temperature_c)
        carried_n_m = self._torque_n_m(motion, carried=True)
        weight_a = gravity_a * np.sin(position_rad)
        # the teeth's weight is that by the rig; the load of the fit is the model's own weight and springs
        load_n_m = carried_n_m + self.torque_n_m_a * (teeth_a - weight_a)
        torque_n_m = carried_n_m + self._torque_n_m(motion.having(load_effort=load_n_m), carried=False)
        return np.asarray(torque_n_m / self.torque_n_m_a - weight_a)

    def _torque_n_m(self, motion: Motion, carried: bool) -> FloatArray:
        """Of the terms that are part of the load, or of the others, shape (n,)."""
        torque_n_m = np.zeros(len(motion.position))
        for term in self.terms:
            if term.effect.carried is carried:
                torque_n_m += np.nan_to_num(term.coefficients @ term.effect.columns(motion, term.shape))
        return torque_n_m

    def _motion(
        self, position: FloatArray, speed: FloatArray, acceleration: float, gravity_a: float, temperature_c: float
    ) -> Motion:
        ones = np.ones(len(position))
        arm_m, nothing = self.facts.arm_m or 1.0, 0.0 * ones
        load_kg = max(gravity_a * self.torque_n_m_a - self.own_n_m, 0.0) / (STANDARD_GRAVITY_M_S2 * arm_m)
        return Motion(
            facts=self.facts,
            conditions={"load_kg": load_kg},
            time_s=nothing,
            position=position,
            velocity=speed,
            acceleration=acceleration * ones,
            jerk=nothing,
            direction=np.sign(speed),
            load_effort=nothing,
            inertia_beyond=0.0,
            inertia=0.0,
            parting=nothing,
            predicted=nothing,
            effort_rate=nothing,
            largest_effort=self.largest_n_m,
            bend=nothing,
            temperature_c=temperature_c * ones,
            supply_v=np.nan * ones,
            position_span=self.scales.position_span,
            session_span_s=self.scales.session_span_s,
            slow=self.scales.slow,
            fast=self.scales.fast,
        )


def works_online(effect: Effect) -> bool:
    """Whether an effect is computed from the motion of the moment."""
    memory = effect.rows == "moving" or effect.builds_on == "effort" or effect.driver in ("session_time", "start_rate")
    return not (memory or effect.pipeline or effect.name == "inertia")


def left_out(effects: Sequence[Effect]) -> list[str]:
    """Names of those that do not work online, inertia apart."""
    return [effect.name for effect in effects if not works_online(effect) and effect.name != "inertia"]
