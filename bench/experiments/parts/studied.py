"""A study's model as the load estimator uses it.

A module of its own: it imports the model lab, which is loaded only where a study is used.
"""

import numpy as np

from bench.config.friction_curves import StudiedModel
from bench.config.reflected_load import load_current_a, torque_n_m_a
from bench.config.rig import Rig
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.online import OnlineFriction, OnlineTerm
from compensator.lab.recordings.facts import Facts
from compensator.lab.rows.dataset import Scales


def online_friction(studied: StudiedModel, rig: Rig) -> OnlineFriction:
    """What the joint takes in motion, by a study.

    Raises:
        ConfigurationError: the rig leaves out what a load current needs.
        UnknownEffectError: an effect of a package that is not installed.
    """
    per_a = torque_n_m_a(rig)
    facts = Facts(
        torque_per_current_n_m_a=per_a,
        gear_ratio=rig.gear.ratio,
        backlash_rad=rig.gear.backlash_rad,
        arm_m=rig.arm.length_m,
        arm_inertia_kg_m2=rig.arm.inertia_kg_m2,
    )
    terms = tuple(
        OnlineTerm(effect_named(one.effect), one.shape, np.array(one.coefficients)) for one in studied.effects
    )
    scales = Scales(0.0, studied.slow_rad_s, studied.fast_rad_s, studied.position_span_rad, 1.0)
    own_n_m = load_current_a(0.0, np.pi / 2, rig) * per_a
    return OnlineFriction(terms, facts, scales, per_a, own_n_m, studied.largest_effort_n_m)
