"""A drawn joint: its physics, its drive, its sensors, its trials, what its owner knows, and what it hides."""

from dataclasses import dataclass, replace
from math import pi
from typing import Literal

import numpy as np

from sim_backend.second_plant.controller import Control
from sim_backend.second_plant.foreign_mechanisms import FOREIGN
from sim_backend.second_plant.mechanism import Mechanism, Scales
from sim_backend.second_plant.physics import GRAVITY_M_S2, REFERENCE_C, Physics
from sim_backend.second_plant.protocol import Bounds
from sim_backend.second_plant.textbook_mechanisms import TEXTBOOK

MECHANISMS: dict[str, Mechanism] = {**TEXTBOOK, **FOREIGN}
Level = Literal["textbook", "foreign"]
EffortChannel = Literal["current", "torque", "duty", "estimate"]
LONGEST_BY_THE_BOOK_RAD = 4e-5  # pre-sliding distance that no recording shows


@dataclass(frozen=True)
class Hidden:
    """A mechanism that a joint has, its size, and the seed of what else is drawn of it."""

    name: str
    size: float
    seed: int


@dataclass(frozen=True)
class Arm:
    """The arm without load, and where the load hangs."""

    length_m: float
    mass_kg: float
    centre_m: float
    inertia_kg_m2: float


@dataclass(frozen=True)
class Sensors:
    """How the joint is recorded.

    Attributes:
        effort: what stands for the effort.
        supply_measured: otherwise recordings hold the nominal voltage.
        rate_hz: of the samples.
        jitter: standard deviation of a time stamp, as a share of the period.
        hold_s: the drive renews its values so often and holds them in between; 0 at once.
        skew_s: by how much later the effort is taken than the position.
        filter_hz: of the current measurement.
        noise: of the effort, as a share of the drive's peak; position has only its counts.
        counts_per_turn: of the encoder, per motor turn.
        speed_told: a speed channel is recorded, too.
        temperature_told, session_told: the temperature channel; the time of the trial in its session.
    """

    effort: EffortChannel
    supply_measured: bool
    rate_hz: float
    jitter: float
    hold_s: float
    skew_s: float
    filter_hz: float
    noise: float
    counts_per_turn: float
    speed_told: bool
    temperature_told: bool
    session_told: bool


@dataclass(frozen=True)
class Told:
    """Which facts the owner knows; each number is off by the tolerance of its source."""

    ratio: bool
    counts: bool
    torque_constant: bool
    length_in_rig: bool
    inertia: bool
    mass: bool
    nominal: bool
    tolerance: float  # factor on the torque constant


@dataclass(frozen=True)
class Trial:
    """One trial: its kind, its conditions and its seed."""

    name: str
    kind: str
    load_kg: float
    seconds: float
    gear_c: float
    session_s: float
    friction_factor: float
    seed: int


@dataclass(frozen=True)
class DrawnJoint:
    """Everything about a joint: the truth.

    Attributes:
        level: friction that textbook formulas state exactly, or laws that they do not.
        physics: complete, without load and without what is hidden.
        scales: what is usual in this joint.
        control, sensors, arm, told, trials: see there.
        bounds: of its motions.
        hidden: what it hides.
    """

    seed: int
    level: Level
    physics: Physics
    scales: Scales
    control: Control
    sensors: Sensors
    arm: Arm
    told: Told
    trials: tuple[Trial, ...]
    bounds: Bounds
    hidden: tuple[Hidden, ...]

    def by_the_book(self) -> "DrawnJoint":
        """The same joint with friction that the base model can state: viscous, of one Coulomb level, even, stiff."""
        laws = {"viscous_power": 1.0, "film_rad_s": 0.0, "second_level": 0.0, "path_scatter": 0.0}
        laws["bristle_rad"] = min(self.physics.bristle_rad, LONGEST_BY_THE_BOOK_RAD)
        return replace(self, level="textbook", physics=self.physics._replace(**laws))

    def physics_of(self, trial: Trial, without: frozenset[str] = frozenset()) -> Physics:
        """The joint under the conditions of a trial; with some of what it hides left out."""
        load_kg, length_m = trial.load_kg, self.arm.length_m
        changes: dict[str, float] = {}
        for hidden in self.hidden:
            if hidden.name not in without:
                random = np.random.default_rng(hidden.seed)
                mechanism = MECHANISMS[hidden.name]
                changes |= mechanism.changes(min(hidden.size, mechanism.most), self.scales, random)
        return self.physics._replace(
            arm_kg_m2=self.physics.arm_kg_m2 + load_kg * length_m**2,
            moment_n_m=self.physics.moment_n_m + load_kg * GRAVITY_M_S2 * length_m,
            coulomb_n_m=self.physics.coulomb_n_m * trial.friction_factor,
            static_n_m=self.physics.static_n_m * trial.friction_factor,
            gear_c=trial.gear_c,
            winding_c=trial.gear_c,
            session_s=trial.session_s,
            load_kg=load_kg,
            **changes,
        )


def physics_drawn(random: np.random.Generator, level: Level) -> tuple[Physics, Scales, Arm]:
    """Motor, gear, arm and friction of a joint, without load."""

    def between(low: float, high: float) -> float:
        return float(random.uniform(low, high))

    def log_between(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    peak_n_m, peak_a, top_rad_s = log_between(3.0, 40.0), log_between(1.5, 20.0), log_between(1.5, 5.0)
    # the heaviest arm takes a third of the peak torque at 90 degrees
    moment_n_m, length_m, load_share = between(0.3, 0.42) * peak_n_m, between(0.15, 0.5), between(0.5, 0.8)
    heaviest_kg = round(load_share * moment_n_m / (GRAVITY_M_S2 * length_m), 3)
    centre_m = between(0.4, 0.6) * length_m
    mass_kg = (1.0 - load_share) * moment_n_m / (GRAVITY_M_S2 * centre_m)
    arm = Arm(length_m, mass_kg, centre_m, between(1.2, 1.5) * mass_kg * centre_m**2)
    middle_kg_m2 = arm.inertia_kg_m2 + 0.5 * heaviest_kg * length_m**2
    coulomb_n_m, turns = between(0.06, 0.15) * peak_n_m, float(random.integers(20, 121))
    torque_per_a = peak_n_m / peak_a
    resistance_ohm = between(0.5, 1.5) * torque_per_a * top_rad_s / peak_a
    foreign = level == "foreign"
    physics = Physics(
        resistance_ohm=resistance_ohm,
        inductance_h=resistance_ohm * between(0.5e-3, 1.5e-3),
        torque_per_a=torque_per_a,
        emf_per_rad_s=torque_per_a,
        supply_v=float(f"{1.4 * (resistance_ohm * peak_a + torque_per_a * top_rad_s):.3g}"),
        turns=turns,
        rotor_kg_m2=between(0.3, 1.5) * middle_kg_m2,
        arm_kg_m2=arm.inertia_kg_m2,
        moment_n_m=mass_kg * GRAVITY_M_S2 * centre_m,
        coulomb_n_m=coulomb_n_m,
        static_n_m=coulomb_n_m * between(1.1, 1.6),
        stribeck_rad_s=between(0.02, 0.08) * top_rad_s,
        stribeck_power=between(0.5, 2.5) if foreign else float(random.choice([1.0, 2.0])),
        viscous_n_m=between(0.04, 0.12) * peak_n_m / top_rad_s,
        viscous_power=between(0.6, 1.4) if foreign else 1.0,
        bristle_rad=log_between(5e-5, 2e-4) if foreign else log_between(1e-5, LONGEST_BY_THE_BOOK_RAD),
        bristle_damping_n_m_s=0.0,
        gear_c=REFERENCE_C,
        winding_c=REFERENCE_C,
        winding_j_k=resistance_ohm * (0.3 * peak_a) ** 2 * between(2.0, 10.0),
        session_s=0.0,
        load_kg=0.0,
        film_rad_s=between(1.0, 3.0) * top_rad_s if foreign and random.random() < 0.5 else 0.0,
        second_level=between(-0.15, 0.15) if foreign and random.random() < 0.5 else 0.0,
        second_rad_s=between(0.2, 0.6) * top_rad_s,
        path_scatter=log_between(0.002, 0.02) if foreign else 0.0,
        path_phase_rad=between(0.0, 2.0 * pi),
    )
    scales = Scales(
        coulomb_n_m, moment_n_m * (1.0 - 0.5 * load_share), physics.viscous_n_m, top_rad_s, peak_a,
        resistance_ohm * peak_a, torque_per_a, torque_per_a, resistance_ohm, middle_kg_m2, heaviest_kg, turns,
        physics.bristle_rad,
    )  # fmt: skip
    # a fifth of critical damping of the joint on its bristles
    stiffness = coulomb_n_m / physics.bristle_rad
    damping = 0.4 * (stiffness * (physics.rotor_kg_m2 + middle_kg_m2)) ** 0.5
    return physics._replace(bristle_damping_n_m_s=damping), scales, arm


def control_drawn(random: np.random.Generator, physics: Physics, scales: Scales, sensors: Sensors) -> Control:
    """A drive tuned as a technician tunes it, for the arm with half of the load."""
    inertia = physics.rotor_kg_m2 + scales.arm_kg_m2
    cascade = bool(random.random() < 0.5)
    rate = float(random.uniform(25.0, 50.0) if cascade else random.uniform(15.0, 28.0))
    gain = inertia / scales.torque_per_a
    speed_a_s = gain * rate if cascade else 1.5 * gain * rate
    return Control(
        cascade=cascade,
        voltage_drive=sensors.effort in ("duty", "estimate"),
        position_per_s=float(random.uniform(6.0, 12.0)),
        speed_a_s=speed_a_s,
        integral_a=speed_a_s * 5.0 if cascade else 0.15 * gain * rate**3,
        stiffness_a_rad=gain * rate**2,
        inertia_a_s2=gain * float(random.uniform(0.7, 1.1)),
        gravity_a=scales.moment_n_m / scales.torque_per_a * float(random.uniform(0.8, 1.1)),
        most_a=scales.peak_a,
        resistance_ohm=scales.resistance_ohm,
        emf_per_rad_s=scales.emf_per_rad_s,
        count_rad=2.0 * pi / (sensors.counts_per_turn * scales.turns),
        speed_filter_s=4e-3,
        tether_rad=0.15,
    )
