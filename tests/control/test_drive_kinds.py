"""Drive kinds of other packages: found by their entry point, as ours are; here each is installed in its own folder."""

import os
import subprocess
import sys

import pytest

from bench.config.drives.registry import drive_kind, drive_kinds
from bench.errors import ConfigurationError

ACME = '''
"""A drive of the firm Acme: the whole package."""

from typing import Literal

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, joint_scale
from bench.config.drives.simulated_device import Simulated
from bench.config.quantities import quantity


class AcmeSettings(RealDriveSettings):
    kind: Literal["acme"]
    port: str = quantity(..., "", "Where it is")


class AcmeDrive:
    def __init__(self, settings, joint):
        self.port, self.joint = settings.port, joint


class AcmeDevice:
    path, side_channel = "acme://1", "127.0.0.1:1"

    def wait(self, stop):
        """Ends at once."""

    def __enter__(self):
        return self

    def __exit__(self, *error):
        """Nothing to end."""


def simulate(jitter: float = 0.0, *, options):
    """A drive of Acme, simulated."""
    return Simulated(AcmeDevice(), "Acme drive", {"kind": "acme", "port": f"acme://{jitter:g}/{options.seed}"})


KIND = DriveKind(
    title="Acme drive",
    settings=AcmeSettings,
    make=lambda settings, rig: AcmeDrive(settings, joint_scale(settings, rig)),
    simulate=lambda: simulate,
    conformance=(ConformanceBench("acme"),),
)
'''
MAKE = """
from bench.config.configuration import default_configuration, parse_configuration
from bench.control.drive_factory import has_hardware, make_equipment
values = default_configuration().model_dump(mode="json", exclude_none=True)
configuration = parse_configuration(values | {"drive": {"kind": "acme", "port": "acme://7", "motor_sign": -1}}, "b")
drive = make_equipment(configuration).drive
print(type(drive).__name__, drive.port, drive.joint.motor_sign, has_hardware(configuration))
"""
LIST = """
from tests.drivers.conformance.benches import BENCHES
print(*BENCHES)
"""
WRONG = """
from bench.config.configuration import default_configuration, parse_configuration
values = default_configuration().model_dump(mode="json", exclude_none=True)
print(default_configuration().drive.kind)
parse_configuration(values | {"drive": {"kind": "acm"}}, "bench.toml")
"""


@pytest.fixture
def installed(tmp_path):
    """Returns a function that runs Python with packages in `tmp_path` on its path, each with entry points."""

    def install(package, module_text, target):
        (tmp_path / f"{package}.py").write_text(module_text)
        meta = tmp_path / f"{package}-1.0.dist-info"
        meta.mkdir()
        (meta / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n")
        (meta / "entry_points.txt").write_text(f"[friction_bench.drives]\n{target}\n")

    def run(*words):
        environment = os.environ | {"PYTHONPATH": str(tmp_path)}
        return subprocess.run([sys.executable, *words], env=environment, capture_output=True, text=True, timeout=60)

    run.install = install
    return run


def test_ours_are_entry_points_too():
    first, *others = drive_kinds()
    assert first == "sim"
    assert others == sorted(others)
    assert {"canopen", "modbus", "roboclaw"} <= set(others)
    assert all(kind.conformance for kind in drive_kinds().values())


def test_a_kind_that_is_not_there_is_refused_with_those_that_are():
    with pytest.raises(ConfigurationError, match=r"no drive kind 'acme'; kind should be one of sim, canopen,"):
        drive_kind("acme")


def test_another_package_brings_a_kind(installed):
    installed.install("acme_drive", ACME, "acme = acme_drive:KIND")
    made = installed("-c", MAKE)
    assert made.stdout.split() == ["AcmeDrive", "acme://7", "-1", "True"], made.stderr
    device = installed("-m", "bench.cli", "simulate-device", "acme", "--jitter", "3", "--seed", "9", "--json")
    assert '"port": "acme://3/9"' in device.stdout, device.stderr
    assert "acme" in installed("-c", LIST).stdout.split()  # the conformance tests run on it, too


def test_another_package_takes_none_of_our_names(installed):
    installed.install(
        "acme_drive", ACME.replace('Literal["acme"]', 'Literal["roboclaw"]'), "roboclaw = acme_drive:KIND"
    )
    found = installed("-c", "from bench.config.drives.registry import *; print(drive_kind('roboclaw').title)")
    assert found.stdout.startswith("RoboClaw"), found.stderr


def test_a_package_that_is_broken_breaks_nothing_else_and_is_named(installed):
    installed.install("acme_drive", "import absent_library", "acme = acme_drive:KIND")
    found = installed("-c", WRONG)
    assert found.stdout.strip() == "sim"  # the bench goes on without it
    assert f"kind should be one of {', '.join(drive_kinds())}; 'acme' of package acme_drive cannot be" in found.stderr
    assert "absent_library" in found.stderr
