"""The sections of `bench.toml`, one class each: what its keys are, their units, defaults and bounds."""

from typing import Annotated, Literal

from pydantic import Field, field_validator, model_validator

from bench.config.quantities import quantity
from bench.config.rig import Section
from compensator.rest.rest_calibration import RestCalibration

Rate = Annotated[float, Field(gt=0)]
Row = Annotated[tuple[float, ...], Field(min_length=3, max_length=3)]


class ControlSettings(Section):
    """The control loop."""

    period_s: float = quantity(0.005, "s", "Control period", ge=0.0005, le=0.1)


class Limits(Section):
    """What the bench never exceeds. Compared with every sample, before motion and during it."""

    position_min_rad: float = quantity(-2.2, "rad", "Lowest joint angle")
    position_max_rad: float = quantity(2.2, "rad", "Highest joint angle")
    speed_rad_s: float = quantity(8.0, "rad/s", "Highest joint speed, either way", gt=0)
    current_a: float = quantity(2.0, "A", "Highest motor current, either way", gt=0)
    temperature_c: float = quantity(80.0, "degC", "Highest drive temperature", gt=0)
    tracking_error_rad: float = quantity(0.5, "rad", "Largest position error", gt=0)
    sample_age_s: float = quantity(0.1, "s", "Oldest sample that still counts", gt=0)
    slow_sample_age_s: float = quantity(
        2.0, "s", "Oldest supply voltage, temperature or state of the drive that still counts", gt=0
    )
    load_kg: float = quantity(0.1, "kg", "Heaviest load on the arm", ge=0)

    @model_validator(mode="after")
    def _check_order(self) -> "Limits":
        if not self.position_min_rad < self.position_max_rad:
            raise ValueError(f"position_min_rad must be below position_max_rad, {self.position_max_rad} rad")
        return self

    def position_range(self) -> str:
        """The allowed positions, in words."""
        return f"{self.position_min_rad:g} .. {self.position_max_rad:g}"


class MotionSettings(Section):
    """How the joint is moved between set points."""

    speed_rad_s: float = quantity(3.0, "rad/s", "Top speed of a move", gt=0)
    acceleration_rad_s2: float = quantity(60.0, "rad/s2", "Acceleration of a move", gt=0)
    settled_cycles: int = quantity(20, "cycles", "Cycles without motion after which the joint is settled", ge=1)
    settle_timeout_s: float = quantity(10.0, "s", "Longest wait for the joint to settle", gt=0)


class ServoSettings(Section):
    """Gains of the position servo; its output is motor current."""

    closed_by: Literal["bench", "drive"] = quantity(
        "bench", "", "Who closes the position loop; 'drive': by its own gains, where it has a position mode"
    )
    proportional_a_rad: float = quantity(35.0, "A/rad", "Current per position error", ge=0)
    integral_a_rad_s: float = quantity(200.0, "A/(rad s)", "Current per integrated error", ge=0)
    derivative_a_s_rad: float = quantity(0.6, "A s/rad", "Current per speed error", ge=0)
    dead_band_rad: float = quantity(0.004, "rad", "Position error that is left alone", gt=0)
    current_a: float = quantity(1.6, "A", "Most current the servo asks for", gt=0)


class SearchSettings(Section):
    """The zero-speed search: the flow chart of the paper (Fig. 5), or the improved one.

    Both keep to `excursion_rad` and `ceiling_a`. Up to `creep_timeout_s` the values are the flow chart's; the others
    the improved search's.
    """

    method: Literal["paper", "improved"] = quantity("improved", "", "Flow chart of the paper, or the improved search")
    current_step_a: float = quantity(0.004, "A", "One step of the ramp", gt=0)
    step_s: float = quantity(0.02, "s", "Length of one step", gt=0)
    onset_counts: float = quantity(4.0, "", "Encoder counts that make a departure", ge=2)
    free_play_rad: float | None = quantity(
        None, "rad", "Travel without the joint moving; the rig's backlash where left out", ge=0
    )
    excursion_rad: float = quantity(0.15, "rad", "Farthest from the set point", gt=0)
    ceiling_a: float = quantity(1.5, "A", "Largest current of the ramp, either way", gt=0)
    creep_timeout_s: float = quantity(3.0, "s", "Longest creep without an outcome", gt=0)
    noise_counts: float = quantity(0.25, "", "Noise of a position reading, in encoder counts", ge=0)
    false_alarms_per_hour: float = quantity(1.0, "", "Times that noise may be taken for motion", gt=0)
    coarse_rate_a_s: float = quantity(1.5, "A/s", "Rate of the first ramp either way", gt=0)
    fine_rates_a_s: tuple[Rate, ...] = quantity((0.6, 0.15), "A/s", "Rates of the others, in turn", min_length=2)
    pairs: int = quantity(4, "", "Slow ramps up and down", ge=2, le=100)
    stand_s: float = quantity(0.04, "s", "Rest before each ramp", gt=0)
    stand_timeout_s: float = quantity(0.5, "s", "Longest wait for that rest", gt=0)

    @field_validator("fine_rates_a_s")
    @classmethod
    def _check_rates(cls, rates: tuple[float, ...]) -> tuple[float, ...]:
        if len(set(rates)) < 2:
            raise ValueError("two different rates are needed, to tell what a ramp gains before motion is seen")
        return rates


class RetentionSettings(Section):
    """How long experiments are kept after their end, see `friction-bench store prune`; without a number: for ever."""

    completed_days: float | None = quantity(None, "days", "Completed experiments and imports", gt=0)
    incomplete_days: float | None = quantity(None, "days", "Stopped, tripped, failed, interrupted, refused ones", gt=0)
    simulated_days: float | None = quantity(None, "days", "Those of a simulated drive, however they ended", gt=0)
    audit_days: float | None = quantity(None, "days", "Entries of the audit log", gt=0)

    def keeps_days(self, outcome: str, source: str) -> float | None:
        """How long an experiment is kept [days]; the shortest where several apply, None: for ever."""
        limits = [self.completed_days if outcome == "completed" else self.incomplete_days]
        limits.append(self.simulated_days if source == "simulated" else None)
        return min((limit for limit in limits if limit is not None), default=None)


class StoreSettings(Section):
    """Where the trials are kept."""

    url: str = quantity(
        "sqlite:///friction-bench.sqlite", "", "Database address: sqlite:///FILE or postgresql://USER@HOST/DATABASE"
    )
    lab_url: str | None = quantity(
        None,
        "",
        "Database of a laboratory of several benches, to which what was recorded is handed in: postgresql://...",
    )
    lab_queue: bool = quantity(
        False, "", "Take work from the laboratory's queue: the joint moves without anybody here having started it"
    )
    lab_tags: tuple[str, ...] = quantity((), "", "What this bench can do, for work that asks for it: words of your own")
    reserve_mb: float = quantity(200.0, "MB", "Space that a new trial has to leave free on the disk", ge=0)
    retention: RetentionSettings = RetentionSettings()


class RestSettings(Section):
    """Corrections of eqs (9), (10); see `compensator.rest.rest_calibration`."""

    gain: float = quantity(1.0, "", "a: what the paper's eq. (9) gives for a load, over the load", gt=0)
    step_a: float = quantity(0.0, "A", "c: what the paper's eq. (9) gives too much under any load")
    asymmetry: float = quantity(0.0, "", "r: friction forwards is 1 + r times, backwards 1 - r times its mean")
    covariance: Annotated[tuple[Row, ...], Field(min_length=3, max_length=3)] = Field(
        default=((0.0,) * 3,) * 3, description="Of gain, step_a and asymmetry"
    )
    slope: float = quantity(0.0, "", "b: what the paper's eq. (10) grows by with the current of the load")
    offset_a: float = quantity(0.0, "A", "e: what the paper's eq. (10) gives too much under any load")
    offset_sd_a: float = quantity(0.0, "A", "Standard deviation of offset_a", ge=0)
    delay: Row = Field(default=(0.0, 0.0, 0.0), description="k0, k1, k2: what a ramp gains before motion is seen")
    floor_a: float = quantity(1e-6, "A", "Least scatter of one breakaway", gt=0)
    scatter: float = quantity(0.0, "", "Scatter of one breakaway, as a share of friction", ge=0)
    moment_scatter: float = quantity(0.0, "", "The same, as a share of friction with what a moment adds", ge=0)

    def calibration(self) -> RestCalibration:
        """For the compensator."""
        return RestCalibration(**self.model_dump())


class ReflectionSettings(Section):
    """How the slave's load is given to the master's motor; `compensator.reflection.reflection` says what each does."""

    torque_n_m: float = quantity(1.5, "N m", "Most torque that is reflected, either way", gt=0)
    slew_n_m_s: float = quantity(30.0, "N m/s", "Fastest change of it", gt=0)
    damping_n_m_s_rad: float = quantity(
        0.0, "N m s/rad", "Torque against the master's speed, beside what is reflected", ge=0
    )
