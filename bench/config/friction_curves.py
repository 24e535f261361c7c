"""Friction curves of a joint as part of a bench configuration: what was calibrated, and how it is looked up."""

from dataclasses import fields

from pydantic import Field

from bench.config.quantities import quantity
from bench.config.rig import Section
from compensator.motion.friction_lookup import MARGIN, FrictionLookup
from compensator.motion.kinetic_friction import KineticFriction


class FrictionCurve(Section):
    """General Kinetic Friction of the balanced joint under one load; speeds of the motor shaft."""

    load_kg: float = quantity(..., "kg", "Load under which it holds", ge=0)
    f_load_a: float = quantity(..., "A", "F_load of the zero-speed search under that load; it selects the curve", gt=0)
    coulomb_a: float = quantity(..., "A", "Coulomb friction", ge=0)
    static_a: float = quantity(..., "A", "Static friction", ge=0)
    stribeck_speed_rad_s: float = quantity(..., "rad/s", "Stribeck speed", gt=0)
    shape: float = quantity(2.0, "", "Shape of the Stribeck curve", gt=0)
    viscous_a_s_rad: float = quantity(0.0, "A s/rad", "Viscous friction", ge=0)
    offset_a: float = quantity(0.0, "A", "Friction forwards over that backwards, half of it; no part of the curve")
    rise_offset_a: float = quantity(0.0, "A", "What offset_a rises by towards rest; no part of the curve")
    inertia_a_s2_rad: float = quantity(0.0, "A s2/rad", "Of motor, arm and load; no part of the curve", ge=0)

    def curve(self) -> KineticFriction:
        """Eq. (2).

        Raises:
            ModelParameterError: static friction below Coulomb friction.
        """
        names = (field.name for field in fields(KineticFriction))
        return KineticFriction(**{name: getattr(self, name) for name in names})


class StudiedEffect(Section):
    """One effect of a study's model, the effort as joint torque [N m]."""

    effect: str = Field(description="Name in the catalogue")
    shape: tuple[float, ...] = Field(description="Its nonlinear shape values")
    coefficients: tuple[float, ...] = Field(description="One per parameter")


class StudiedModel(Section):
    """A study's model: what the joint takes in motion, in place of the curves."""

    study_id: int = Field(description="Study in the store that it comes from")
    model_id: int = Field(description="Which of its models")
    effects: tuple[StudiedEffect, ...] = Field(min_length=1, description="Of the model, those that work online")
    slow_rad_s: float = quantity(..., "rad/s", "Speed below which direction was uncertain", gt=0)
    fast_rad_s: float = quantity(..., "rad/s", "95 % quantile of speed", gt=0)
    position_span_rad: float = quantity(..., "rad", "Range of position", gt=0)
    inertia_n_m_s2_rad: float = quantity(..., "N m s2/rad", "Of motor and arm", ge=0)
    load_inertia_scale: float = quantity(1.0, "", "Of the load, over that of a point at the tip", ge=0)
    largest_effort_n_m: float = quantity(0.0, "N m", "Largest that it predicts for the trials; 0: not kept", ge=0)


class FrictionSettings(Section):
    """The curves that a bench compensates with."""

    calibration_id: int | None = Field(default=None, description="Calibration in the store that they come from")
    curves: tuple[FrictionCurve, ...] = Field(min_length=2, description="One for each load")
    study: StudiedModel | None = Field(default=None, description="What a study found; in motion it counts, not curves")

    def over_friction(self, margin: float = MARGIN) -> FrictionLookup:
        """Looked up by F_load [A], as eq. (10) gives it. Raises `CalibrationError` where they are not different."""
        return FrictionLookup.over_friction({one.f_load_a: one.curve() for one in self.curves}, margin)
