"""Joint elasticity."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.far_side import PLAUSIBLE_SHARE, TOLD, parting_on_a_spring
from compensator.lab.recordings.recording import FloatArray

# of critical: material and teeth alone; with the arm's bearings; where friction of the arm soon ends the swing, too. A
# column that swings more than the joint does would take a share of the load that is far too small
DAMPINGS = (0.06, 0.25, 0.7)
MOST_DAMPED = 0.5  # of critical, in a model that has it: it overshoots by 16 %
SCANNED = 10  # anti-resonances; between them the shape is looked for once it speaks


def known_hz(facts: Facts) -> float | None:
    """Anti-resonance [Hz] of the arm without load on the stiffness that is known; None where either is not."""
    stiffness, arm_kg_m2 = facts.stiffness_n_m_rad, facts.arm_inertia_kg_m2
    if facts.joint == "linear" or not stiffness or not arm_kg_m2:
        return None
    return float(np.sqrt(stiffness / arm_kg_m2) / (2.0 * np.pi))


def told(facts: Facts, shape: Shape) -> bool:
    """Whether the joint hardly gives more than the stiffness that is known lets it."""
    hz = known_hz(facts)
    return hz is not None and TOLD * shape[0] ** 2 >= hz**2


def swings(shape: Shape) -> bool:
    """Whether it swings at all: what hardly overshoots is no spring, but what a lossy line makes of reversals."""
    return shape[1] <= MOST_DAMPED


def shapes(motion: Motion) -> list[Shape]:
    """Anti-resonances [Hz] of the arm without load, up to 0.4 of the sample rate, and how they are damped."""
    return [(float(hz), damping) for hz in np.geomspace(3.0, 0.4 / motion.step_s, SCANNED) for damping in DAMPINGS]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """What the gear carries less while it winds up, for shape (anti-resonance [Hz], damping)."""
    arm_kg_m2 = motion.facts.arm_inertia_kg_m2 or 0.0
    heavier = 1.0 + motion.load_inertia_kg_m2 / arm_kg_m2 if arm_kg_m2 > 0.0 else 1.0
    resonance_rad_s = 2.0 * np.pi * shape[0] / np.sqrt(heavier)
    damping = shape[1] / np.sqrt(heavier)  # the damper stays as it is
    parting = parting_on_a_spring(motion.parting, resonance_rad_s, damping, motion.step_s)
    return -motion.inertia_beyond * parting[None]


EFFECT = Effect(
    name="elasticity",
    title="Joint elasticity",
    physics=(
        "Gear and shaft twist under the load they carry: the far side is a mass on a spring that the motor moves. "
        "Below its resonance, which is the anti-resonance of the joint, the motor carries more than the load of a "
        "rigid joint needs, above it less. A heavier load swings more slowly."
    ),
    equation=(
        r"-s\,\hat J_a\,\ddot d,\quad "
        r"\ddot d + 2 D\omega_a\dot d + \omega_a^2 d = \hat\tau_{load}/\hat J_a"
    ),
    columns=columns,
    parameters=(Parameter("load beyond the spring over the load that is known", "1", *PLAUSIBLE_SHARE),),
    driver="acceleration",
    excited_by="fast motion with a load: frequencies from a third of the anti-resonance up",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("anti-resonance of the arm without load", "its damping, of critical"),
    shape_units=("Hz", "1"),
    source="Spong 1987; Janot, Gautier, Brunot 2019",
    confused_with=("measurement_delay", "inertia"),
    builds_on="load",
    rows="moving",
    told=told,
    ends_within_scan=True,
    holds=swings,
)
