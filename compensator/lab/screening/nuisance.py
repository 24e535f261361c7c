"""Columns that the measuring pipeline itself can produce, so that none of them is mistaken for physics.

They stand in every diagnosis: a small delay looks like jerk. An effect that means one of these (see
`Effect.standing_in`) is judged without it.
"""

import numpy as np

from compensator.lab.effects.effect import Motion, MotionRows
from compensator.lab.effects.electrical import measurement_delay
from compensator.lab.effects.friction.memory import pre_sliding
from compensator.lab.effects.mechanics import backlash, elasticity
from compensator.lab.effects.mechanics.beyond_teeth import TOLD_ARM
from compensator.lab.recordings.differentiation import rate_of_change
from compensator.lab.recordings.far_side import ABOUT_KNOWN
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import Dataset

NEAR_REVERSALS = ("delay", "smoothing", "stiff_contact", "slow_sign", "fast_sign", "sign_rate")
KNOWN_PLAY = dict(zip(("known_play_less", "known_play", "known_play_more"), ABOUT_KNOWN, strict=True))  # not missing
# shares of what the owner knows, as far as data sheets are off, and dampings of teeth that swing: a spring that hardly
# swings would take what other causes leave
STIFFNESS_ABOUT = tuple((share, damping) for share in (0.8, 1.25) for damping in (0.06, 0.25))


def nuisance_columns(dataset: Dataset, show_in: MotionRows = "sliding") -> dict[str, FloatArray]:
    """Each nuisance column by name, shape (N,).

    The far side of teeth and shaft is not where the motor side is that is measured: what follows from the free play
    and the stiffness that are known is not missing, be it near a reversal or where slow motion changes flanks. Near
    reversals a delay looks like memory: there its own column stands too, the effort's second derivative, which is what
    a low-pass takes beside the delay, and contacts that give over the shortest distance that can be told: all do.
    """
    named = {"jerk": dataset.stack(trial.motion.jerk[None] for trial in dataset.trials)[:, 0]}
    named |= _far_side_weight(dataset)
    named |= _known_stiffness(dataset)
    if dataset.facts.backlash_rad:
        gaps = [(share * dataset.facts.backlash_rad, TOLD_ARM) for share in KNOWN_PLAY.values()]
        found = dataset.unchecked_columns(backlash.EFFECT, gaps)
        named |= {name: columns[:, 0] for name, columns in zip(KNOWN_PLAY, found, strict=True)}
    if show_in == "moving":
        delay = dataset.columns(measurement_delay.EFFECT, ())[:, 0]
        rates = (rate_of_change(trial.motion.effort_rate, trial.signals.rate_hz) for trial in dataset.trials)
        smoothing = dataset.stack(rate[None] for rate in rates)[:, 0]
        shortest = min(pre_sliding.shapes(dataset.trials[0].motion))
        stiff_contact = dataset.unchecked_columns(pre_sliding.EFFECT, [shortest])[0][:, 0]
        signs = dataset.stack([_signs(trial.motion, trial.signals.rate_hz) for trial in dataset.trials])
        named |= dict(zip(NEAR_REVERSALS, (delay, smoothing, stiff_contact, *signs.T), strict=True))
    return named


def _known_stiffness(dataset: Dataset) -> dict[str, FloatArray]:
    """What the gear carries less for winding up, about the stiffness that is known; none where it is not."""
    known_hz = elasticity.known_hz(dataset.facts)
    if known_hz is None:
        return {}
    shapes = [(known_hz * np.sqrt(share), damping, TOLD_ARM) for share, damping in STIFFNESS_ABOUT]
    found = dataset.unchecked_columns(elasticity.EFFECT, shapes)
    return {f"known_stiffness_{index}": columns[:, 0] for index, columns in enumerate(found)}


def _far_side_weight(dataset: Dataset) -> dict[str, FloatArray]:
    """How much less the arm weighs for being behind the motor side; none where nothing is known of that."""
    facts = dataset.facts
    if facts.horizontal or facts.joint == "linear" or not (facts.backlash_rad or facts.stiffness_n_m_rad):
        return {}
    return {"far_side_weight": dataset.stack(far_side_weight(trial.motion)[None] for trial in dataset.trials)[:, 0]}


def far_side_weight(motion: Motion) -> FloatArray:
    """Effort that the arm lacks for being half the free play, and what it winds up, behind, shape (n,)."""
    facts, carried = motion.facts, motion.load_effort
    behind_rad = 0.5 * (facts.backlash_rad or 0.0) * np.sign(carried)
    known_kg_m2 = motion.load_inertia_kg_m2 + (facts.arm_inertia_kg_m2 or 0.0)
    if facts.stiffness_n_m_rad and known_kg_m2 > 0.0 and motion.inertia_beyond > 0.0:
        effort_per_n_m = motion.inertia_beyond / known_kg_m2
        behind_rad = behind_rad + carried / (effort_per_n_m * facts.stiffness_n_m_rad)
    lacking: FloatArray = motion.carried_slope * behind_rad
    return lacking


def _signs(motion: Motion, rate_hz: float) -> FloatArray:
    """Differences of steep sigmoids of the velocity, and the rate of one, shape (3, n)."""
    sigmoids = [np.tanh(motion.velocity / motion.slow / width) for width in (1.0, 3.0, 10.0)]
    rate = rate_of_change(sigmoids[1], rate_hz)
    return np.array([sigmoids[0] - sigmoids[1], sigmoids[1] - sigmoids[2], rate])
