"""The section of the drive that is commissioned, and the bench of which nothing more is known."""

from pathlib import Path

from bench.commission.bench_table import UNKNOWN_COUNTS, BenchTable
from bench.commission.questions import CommissionError
from bench.config.configuration import BenchConfiguration
from bench.config.drives.real import RealDriveSettings
from bench.config.drives.registry import drive_kind
from bench.config.drives.simulated_device import DriveTable
from bench.config.toml_text import read_toml
from bench.errors import ConfigurationError


def section_of(bench: BenchConfiguration) -> DriveTable:
    """The drive's section of a configuration, as its file has it.

    Raises:
        CommissionError: it is no drive on a wire.
    """
    settings = bench.drive
    if not isinstance(settings, RealDriveSettings):
        raise CommissionError(
            f"the drive of bench '{bench.name}' is of kind '{settings.kind}', and commissioning is for drives on a "
            "wire; write the section that 'friction-bench drives scan' prints into a file, and start the service with "
            "it: friction-bench serve --drive drive.toml"
        )
    return {**settings.model_dump(mode="json", exclude_defaults=True), "kind": settings.kind}


def read_section(path: Path) -> DriveTable:
    """The section of a file that holds it alone, or among others.

    Raises:
        ConfigurationError: it holds none, or one that reaches no drive on a wire.
    """
    values = read_toml(path)
    section = values.get("drive", values)
    if not isinstance(section, dict) or "kind" not in section:
        raise ConfigurationError(f"{path}: holds no section [drive] with a kind")
    if not issubclass(drive_kind(str(section["kind"])).settings, RealDriveSettings):
        raise ConfigurationError(f"{path}: kind is '{section['kind']}'; commissioning is for drives on a wire")
    return section


def bench_of(section: DriveTable, name: str = "bench") -> BenchConfiguration:
    """The bench of a drive behind which nothing is known yet.

    Raises:
        ConfigurationError: the section is not complete.
    """
    return BenchTable(name, section, 0.0).looking()


def is_known(bench: BenchConfiguration) -> bool:
    """Whether angles of the joint are known, as everything but commissioning needs them."""
    return bench.rig.sensor.counts_per_turn != UNKNOWN_COUNTS
