"""How many lines each kind of drive is: its driver, its place in the bench, its simulated device. Not a test.

python -m tests.drivers.sizes
"""

from collections.abc import Iterator
from pathlib import Path

from bench.config.drives.registry import drive_kinds

ROOT = Path(__file__).resolve().parents[2]
SHARED = ("actuator", "servos", "mit", "can_bus")


def lines_in(*parts: str) -> int:
    """Of all files of a folder; 0 where it is not there."""
    return sum(len(file.read_text(encoding="utf-8").splitlines()) for file in ROOT.joinpath(*parts).rglob("*.py"))


def rows() -> Iterator[str]:
    """A row a kind, then what several kinds share."""
    yield f"{'kind':<12}{'driver':>8}{'bench':>8}{'simulated device':>18}"
    for name in sorted(drive_kinds()):
        numbers = lines_in("drivers", name), lines_in("bench", "drives", name), lines_in("sim_backend", "devices", name)
        yield f"{name:<12}{numbers[0]:>8}{numbers[1]:>8}{numbers[2]:>18}"
    for name in SHARED:
        yield f"{name + ' *':<12}{lines_in('drivers', name):>8}{'':>8}{lines_in('sim_backend', 'devices', name):>18}"
    yield "* shared by several kinds"


if __name__ == "__main__":
    print("\n".join(rows()))
