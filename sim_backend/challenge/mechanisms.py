"""What may be hidden in a plant: one row per mechanism, with the range of its size and why.

Not here, since nothing would be hidden: a supply that sags (the drive measures its supply), gain and offset of the
current sensor (one number with the torque constant, or a constant torque), walls and end stops (seen at a glance),
and faults.
"""

from dataclasses import dataclass

from sim_backend.challenge import makers
from sim_backend.challenge.ranges import Range


@dataclass(frozen=True)
class Mechanism:
    """Something that may be hidden.

    Attributes:
        name: of the component or parameter that makes it.
        size: what it is drawn from, log spread.
        measure: what the size is, in words.
        current: whether the drive has to measure its current (True), must not (False), or either (None), so that the
            mechanism shows at all.
    """

    name: str
    title: str
    size: Range
    measure: str
    make: makers.Make
    current: bool | None = None


def _size(low: float, high: float, unit: str, reason: str) -> Range:
    return Range(low, high, unit, reason, "log")


_ROWS = (
    Mechanism(
        "viscous_asymmetry",
        "viscous friction that differs with the direction",
        _size(0.04, 0.5, "1", "EMPS: 0.2"),
        "share of the mean",
        makers.signed("viscous_asymmetry", "fraction"),
    ),
    Mechanism(
        "coulomb_asymmetry",
        "dry friction that differs with the direction",
        _size(0.03, 0.3, "1", "EMPS: 0.15"),
        "share of the mean",
        makers.signed("coulomb_asymmetry", "fraction"),
    ),
    Mechanism(
        "drag",
        "drag with the square of the speed",
        _size(0.1, 1.0, "1", "churned oil"),
        "of Coulomb friction, at top speed",
        makers.drag,
    ),
    Mechanism(
        "periodic_friction",
        "friction that varies with the angle",
        _size(0.04, 0.5, "1", "eccentric wheels, bent shafts"),
        "share of dry friction",
        makers.periodic,
    ),
    Mechanism(
        "run_in",
        "friction that falls with the way turned",
        _size(0.08, 0.8, "1", "new grease: 2 x"),
        "share of dry friction at the start",
        makers.run_in,
    ),
    Mechanism(
        "spring",
        "a spring or bent cable across the joint",
        _size(0.02, 0.4, "1", "cable bundles; balance springs"),
        "of gravity, at one radian",
        makers.spring,
    ),
    Mechanism(
        "centre_of_mass",
        "a centre of mass off the zero line",
        _size(0.01, 0.15, "rad", "zero set by eye, to some degrees"),
        "angle",
        makers.signed("centre_of_mass", "angle_rad"),
    ),
    Mechanism(
        "lubricant",
        "grease that thins as it warms",
        _size(200.0, 1500.0, "K", "Vogel 1921: mineral oils about 1000"),
        "Vogel temperature",
        makers.one("lubricant", "vogel_k"),
    ),
    Mechanism(
        "cogging",
        "cogging of the motor",
        _size(0.05, 0.8, "1", "iron-core motors: 1 to 5 % of rated torque"),
        "of Coulomb friction",
        makers.cogging,
    ),
    Mechanism(
        "dead_time",
        "dead time of the PWM stage",
        _size(2.5e-7, 2.5e-6, "s", "MOSFET bridges"),
        "dead time at 20 kHz",
        makers.one("dead_time", "time_s"),
        current=False,
    ),
    Mechanism(
        "thermal_drift",
        "a motor that changes as it warms",
        _size(0.001, 0.0039, "1/K", "copper: 0.0039"),
        "growth of resistance",
        makers.drift,
        current=False,
    ),
    Mechanism(
        "eccentricity",
        "an encoder disc off its centre",
        _size(0.01, 0.15, "rad", "0.1 to 1 mm on a disc of 10 mm"),
        "angle at the motor",
        makers.eccentricity,
    ),
    Mechanism(
        "load_friction",
        "mesh loss",
        _size(0.02, 0.4, "1", "Rhoban/bam: 0.06 to 0.25; worm gears more"),
        "share of the transmitted torque",
        makers.mesh,
    ),
    Mechanism(
        "weight_growth",
        "friction that grows with the weight on the axis",
        _size(0.1, 2.0, "1", "the paper: 1.7 at 0.1 kg"),
        "share of dry friction, at the heaviest load",
        makers.weight,
    ),
    Mechanism(
        "bristle",
        "friction that gives before it slips",
        _size(2e-3, 3e-2, "rad", "Rhoban/bam and LuGre papers: 0.1 to 2 degrees"),
        "joint angle before it slips",
        makers.bristle,
    ),
    Mechanism(
        "dwell",
        "static friction that rises at rest",
        _size(0.1, 1.0, "1", "Armstrong et al. 1994"),
        "share of static friction",
        makers.dwell,
    ),
    Mechanism(
        "backlash",
        "more free play than the data sheet says",
        _size(6e-3, 5e-2, "rad", "worn gears"),
        "free play",
        makers.one("gear", "backlash_rad"),
    ),
    Mechanism(
        "shaft",
        "an elastic transmission",
        _size(5e-3, 6e-2, "rad", "belts, flexible splines"),
        "twist at peak torque",
        makers.shaft,
    ),
    Mechanism(
        "latency",
        "a measurement that comes late",
        _size(1e-3, 1e-2, "s", "field buses and filters"),
        "delay",
        makers.one("latency", "delay_s"),
    ),
    Mechanism(
        "clutch",
        "a coupling that slips",
        _size(0.02, 0.3, "1", "worn cone couplings"),
        "by how much gravity exceeds what it holds",
        makers.clutch,
    ),
    Mechanism(
        "hose",
        "a hose that remembers where it was",
        _size(0.15, 1.5, "1", "hose bundles of robots"),
        "most drag, of Coulomb friction",
        makers.hose,
    ),
    Mechanism(
        "friction_jump",
        "dry friction that jumps and jumps back",
        _size(0.1, 0.8, "1", "seal lips, bearing cages"),
        "height of the jump, share of dry friction",
        makers.jump,
    ),
    Mechanism(
        "supply_ripple",
        "a supply that ripples, unseen",
        _size(0.01, 0.1, "1", "axes on one bus, chargers that hunt"),
        "share of the voltage",
        makers.ripple,
        current=False,
    ),
)


MECHANISMS: dict[str, Mechanism] = {mechanism.name: mechanism for mechanism in _ROWS}
"""Every mechanism that may be hidden, by name."""
