"""The bench configuration (`bench.toml`): rig, drive, limits, servo, search, store."""

import tomllib
from importlib import resources
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError, field_validator

from bench.config.drives.real import RealDriveSettings
from bench.config.drives.registry import AnyDriveSettings, default_drive_settings
from bench.config.friction_curves import FrictionSettings
from bench.config.master import MasterSettings
from bench.config.quantities import quantity
from bench.config.rest_knowledge import RestSettings
from bench.config.rig import Rig, Section
from bench.config.validation import problems
from bench.control.limits import Limits
from bench.control.servo import ServoSettings
from bench.errors import ConfigurationError

PRESETS = resources.files("bench.config") / "presets"
DEFAULT_PRESET = "paper"


class ControlSettings(Section):
    """The control loop."""

    period_s: float = quantity(0.005, "s", "Control period", ge=0.0005, le=0.1)


class MotionSettings(Section):
    """How the joint is moved between set points."""

    speed_rad_s: float = quantity(3.0, "rad/s", "Top speed of a move", gt=0)
    acceleration_rad_s2: float = quantity(60.0, "rad/s2", "Acceleration of a move", gt=0)
    settled_cycles: int = quantity(20, "cycles", "Cycles without motion after which the joint is settled", ge=1)
    settle_timeout_s: float = quantity(10.0, "s", "Longest wait for the joint to settle", gt=0)


Rate = Annotated[float, Field(gt=0)]


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


class StoreSettings(Section):
    """Where the trials are kept."""

    url: str = quantity(
        "sqlite:///friction-bench.sqlite", "", "Database address: sqlite:///FILE or postgresql://USER@HOST/DATABASE"
    )
    reserve_mb: float = quantity(200.0, "MB", "Space that a new trial has to leave free on the disk", ge=0)
    retention: RetentionSettings = RetentionSettings()


class BenchConfiguration(Section):
    """One bench."""

    name: str = Field(description="Name of the bench")
    rig: Rig
    drive: AnyDriveSettings = Field(default_factory=default_drive_settings)
    control: ControlSettings = ControlSettings()
    limits: Limits = Limits()
    motion: MotionSettings = MotionSettings()
    servo: ServoSettings = ServoSettings()
    search: SearchSettings = SearchSettings()
    rest: RestSettings | None = Field(default=None, description="What known loads told of the joint at rest")
    store: StoreSettings = StoreSettings()
    friction: FrictionSettings | None = Field(
        default=None, description="Friction curves; without them those of the calibration in use"
    )
    master: MasterSettings | None = Field(
        default=None, description="A second joint with the operator's hand on it, whose slave the joint is"
    )

    def require_master(self) -> MasterSettings:
        """The master.

        Raises:
            ConfigurationError: there is none, or one joint is real and the other is not.
        """
        if self.master is None:
            raise ConfigurationError(
                f"bench '{self.name}' has one joint, and a master is needed too: add [master.drive] to bench.toml, and "
                "[master.rig] where the master is not built as the slave is"
            )
        if isinstance(self.master.drive, RealDriveSettings) != isinstance(self.drive, RealDriveSettings):
            raise ConfigurationError(
                f"master.drive.kind is '{self.master.drive.kind}' and drive.kind is '{self.drive.kind}'; a simulated "
                "joint and a real one have no common time. Choose 'sim' for both or for neither"
            )
        return self.master

    def of_master(self) -> "BenchConfiguration":
        """The master as a bench of its own.

        Raises:
            ConfigurationError: as `require_master`.
        """
        master = self.require_master()
        return BenchConfiguration(
            name=f"{self.name}, master",
            rig=master.rig or self.rig,
            drive=master.drive,
            control=self.control,
            limits=master.limits,
            store=self.store,
        )


def read_configuration(path: Path) -> BenchConfiguration:
    """Read `bench.toml`. Its `rig` is a table, or the path of a `rig.toml` beside it.

    Raises:
        ConfigurationError: naming the file, each key, its value, what is allowed and the unit.
    """
    values = _read_toml(path)
    for table in (values, values.get("master")):
        if isinstance(table, dict) and isinstance(table.get("rig"), str):
            table["rig"] = _read_toml(path.parent / table["rig"])
    return parse_configuration(values, str(path))


def default_configuration() -> BenchConfiguration:
    """The simulated bench of the paper, which needs no file."""
    return preset_configuration(DEFAULT_PRESET)


def preset_configuration(name: str) -> BenchConfiguration:
    """A configuration that comes with the package."""
    file = PRESETS / f"{name}.toml"
    if not file.is_file():
        known = ", ".join(sorted(item.name.removesuffix(".toml") for item in PRESETS.iterdir()))
        raise ConfigurationError(f"there is no preset '{name}'; known are {known}")
    return parse_configuration(tomllib.loads(file.read_text(encoding="utf-8")), f"preset {name}")


def parse_configuration(values: dict[str, Any], source: str) -> BenchConfiguration:
    """A configuration from nested tables; `source` is named in errors."""
    try:
        return BenchConfiguration.model_validate(values)
    except ValidationError as error:
        raise ConfigurationError(
            "\n".join(f"{source}: {problem}" for problem in problems(error, model=BenchConfiguration))
        ) from error


def _read_toml(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigurationError(f"{path}: cannot be read: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigurationError(f"{path}: is no TOML: {error}") from error
