"""The bench configuration (`bench.toml`): rig, drive, limits, servo, search, store."""

import tomllib
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from pydantic import Field, ValidationError

from bench.config.drives.real import RealDriveSettings
from bench.config.drives.registry import AnyDriveSettings, default_drive_settings
from bench.config.friction_curves import FrictionSettings
from bench.config.rig import Rig, Section
from bench.config.sections import (
    ControlSettings,
    Limits,
    MotionSettings,
    ReflectionSettings,
    RestSettings,
    SearchSettings,
    ServoSettings,
    StoreSettings,
)
from bench.config.toml_text import read_toml
from bench.config.validation import problems
from bench.errors import ConfigurationError

PRESETS = resources.files("bench.config") / "presets"
DEFAULT_PRESET = "paper"


class MasterSettings(Section):
    """A second joint, with the operator's hand on its arm. Its motor makes torque; the hand makes the motion."""

    rig: Rig | None = Field(default=None, description="The master's joint; that of the slave where left out")
    drive: AnyDriveSettings = Field(description="The master's drive, as in [drive]")
    limits: Limits = Limits()
    reflection: ReflectionSettings = ReflectionSettings()


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
    values = read_toml(path)
    for table in (values, values.get("master")):
        if isinstance(table, dict) and isinstance(table.get("rig"), str):
            table["rig"] = read_toml(path.parent / table["rig"])
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
    if _is_rig(values):
        raise ConfigurationError(
            f"{source}: is a rig file, which describes one joint; wanted is the file of a bench, such as bench.toml, "
            "which names its rig: rig = 'rig.toml'. Recordings are imported with a rig file by --rig"
        )
    try:
        return BenchConfiguration.model_validate(values)
    except ValidationError as error:
        raise ConfigurationError(
            "\n".join(f"{source}: {problem}" for problem in problems(error, model=BenchConfiguration))
        ) from error


def _is_rig(values: Mapping[str, object]) -> bool:
    """Whether the tables are those of a rig, and none is of a bench; `name` is a key of both."""
    of_rig, of_bench = set(Rig.model_fields), set(BenchConfiguration.model_fields)
    return bool((of_rig - of_bench) & set(values)) and not (of_bench - of_rig) & set(values)
