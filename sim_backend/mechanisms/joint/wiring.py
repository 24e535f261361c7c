"""How motor and encoder are wired to a device: either may be the wrong way round."""

from dataclasses import dataclass

from sim_backend.plant.component import Component


@dataclass(frozen=True, kw_only=True)
class Wiring(Component):
    """Leads that are swapped. Only simulated devices know of it: the joint in process has no leads.

    Attributes:
        motor_reversed: a positive demand turns the joint to negative angles; the measured current goes with the demand.
        encoder_reversed: the count falls while the joint turns to positive angles.
    """

    motor_reversed: bool = False
    encoder_reversed: bool = False

    @property
    def motor_sign(self) -> float:
        """1, or -1 where the motor's leads are swapped."""
        return -1.0 if self.motor_reversed else 1.0

    @property
    def encoder_sign(self) -> float:
        """1, or -1 where the encoder's leads are swapped."""
        return -1.0 if self.encoder_reversed else 1.0
