"""What the store keeps of a calibrated friction curve, as JSON."""

from pydantic import BaseModel, Field


class Estimate(BaseModel):
    """One parameter with its 95 % interval."""

    value: float | None
    low: float | None = None
    high: float | None = None
    note: str = ""


class Curve(BaseModel):
    """General Kinetic Friction of the balanced joint under one load, over the speed of the motor shaft."""

    load_kg: float
    f_load_a: float = Field(description="F_load under this load; it selects the curve")
    f_load_from: str
    coulomb_a: float
    static_a: float
    stribeck_speed_rad_s: float
    shape: float
    viscous_a_s_rad: float
    offset_a: float = Field(description="half of what friction is more forwards than backwards")
    rise_offset_a: float = Field(default=0.0, description="what that rises by towards rest")
    inertia_a_s2_rad: float = Field(description="current per acceleration of the motor shaft: motor, arm and load")
    parameters: dict[str, Estimate] = Field(description="value, low, high (95 %) and note of each, by name")
    scatter_a: float
    points: int
