"""Ways to take friction out of a motor current: those that the paper weighs, its own, and ours.

Each is one file with `RIVAL`: pure, (knowledge, state, observation) -> (state, estimate), like `load_estimator`. All
know the same of the joint: curves and inertia of one calibration (`Knowledge`).
"""

from compensator.rivals import (
    dahl,
    disturbance_observer,
    fixed_friction,
    lugre_observer,
    online_estimator,
    paper_scheme,
    reset_integrator,
    uncompensated,
)
from compensator.rivals.rival import Knowledge, Rival

RIVALS: tuple[Rival, ...] = (
    uncompensated.RIVAL,
    fixed_friction.RIVAL,
    dahl.RIVAL,
    reset_integrator.RIVAL,
    lugre_observer.RIVAL,
    disturbance_observer.RIVAL,
    paper_scheme.RIVAL,
    online_estimator.RIVAL,
)

__all__ = ["RIVALS", "Knowledge", "Rival"]
