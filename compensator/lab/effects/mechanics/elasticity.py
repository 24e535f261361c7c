"""Joint elasticity."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.effects.mechanics.beyond_teeth import arm_shares, beyond_teeth
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
    """Resonances [Hz] up to the sample rate, dampings, and shares of the arm in the inertia without load.

    The resonance is that of all inertia without load on the spring, so that of a light arm alone lies higher. Beyond
    half the sample rate the compliance is seen, and with a load more of it.
    """
    resonances_hz = np.geomspace(3.0, 1.0 / motion.step_s, SCANNED)
    return [(float(hz), d, share) for hz in resonances_hz for d in DAMPINGS for share in arm_shares(motion.facts)]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """What the gear carries less while it winds up, for shape (resonance [Hz], damping, share of the arm)."""
    inertia, parting = beyond_teeth(motion, shape[2])
    unloaded = motion.inertia_beyond - motion.load_inertia
    lighter = np.sqrt(unloaded / inertia) if min(inertia, unloaded) > 0.0 else 1.0
    resonance_rad_s = 2.0 * np.pi * shape[0] * lighter
    damping = shape[1] * lighter  # the damper stays as it is
    return -inertia * parting_on_a_spring(parting, resonance_rad_s, damping, motion.step_s)[None]


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
    shape_names=("resonance of the inertia without load", "its damping, of critical", "share of the arm in it"),
    shape_units=("Hz", "1", "1"),
    source="Spong 1987; Janot, Gautier, Brunot 2019",
    confused_with=("measurement_delay", "inertia"),
    builds_on="load",
    rows="moving",
    told=told,
    ends_within_scan=2,
    searched=swings,
)
