"""Holding brake on the motor shaft."""

from dataclasses import dataclass

from sim_backend.plant.component import Component, quantity


@dataclass(frozen=True, kw_only=True)
class Brake(Component):
    """Spring-applied: without current in its coil it holds, as dry friction of so much torque at the motor shaft.

    Without torque there is none. It takes time either way: the coil has to pull the armature off the springs, and the
    field has to decay before they push it back.
    """

    torque_n_m: float = quantity("N m", at_least=0, default=0.0)
    release_s: float = quantity("s", at_least=0, default=0.05)
    engage_s: float = quantity("s", at_least=0, default=0.03)
