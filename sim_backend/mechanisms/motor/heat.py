"""Heat in winding and housing."""

from dataclasses import dataclass

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted
from sim_backend.plant.state import State


@dataclass(frozen=True, kw_only=True)
class Heat(Component):
    """Two thermal masses in a row: copper loss warms the winding, friction warms the housing.

        Cw dTw/dt = Pcu - (Tw - Th) / Rwh,    Ch dTh/dt = Pf + (Tw - Th) / Rwh - (Th - Ta) / Rha

    Off, every temperature stays where it started.
    """

    present: bool = False
    ambient_c: float = quantity("degC", at_least=-273.15, default=25.0)
    start_c: float = quantity("degC", at_least=-273.15, default=25.0)
    winding_j_k: float = quantity("J/K", above=0, default=15.0)
    housing_j_k: float = quantity("J/K", above=0, default=120.0)
    winding_to_housing_k_w: float = quantity("K/W", above=0, default=3.0)
    housing_to_ambient_k_w: float = quantity("K/W", above=0, default=8.0)


@jitted
def warm(state: State, heat: Heat, copper_j: float, friction_j: float, step_s: float) -> None:
    """Advance both temperatures by a step in which so much heat was made [J]."""
    through_j = (state.winding_c - state.housing_c) / heat.winding_to_housing_k_w * step_s
    lost_j = (state.housing_c - heat.ambient_c) / heat.housing_to_ambient_k_w * step_s
    state.winding_c += (copper_j - through_j) / heat.winding_j_k
    state.housing_c += (friction_j + through_j - lost_j) / heat.housing_j_k
