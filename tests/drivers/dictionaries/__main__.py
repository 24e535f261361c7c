"""Figures of the CANopen driver on data sheets: `python -m tests.drivers.dictionaries FOLDER`.

FOLDER holds EDS and DCF files of real drives; FRICTION_BENCH_DICTIONARIES where it is left out. Each drive is simulated
with the plant `paper` behind it, on a bus inside this process.
"""

import os
import sys
import tempfile
from pathlib import Path

from drivers.contract import Watchdog
from sim_backend.devices.canopen.conduct import Conduct
from tests.drivers.dictionaries.attempt import Result, attempt
from tests.drivers.dictionaries.fault_reset import RESETS, TICKS_MS, resets
from tests.drivers.dictionaries.homing import home
from tests.drivers.dictionaries.real import sheets_in
from tests.drivers.dictionaries.traits import TRAITS
from tests.drivers.dictionaries.two_hosts import WAYS

MEETINGS = 20


def say(text: str) -> None:
    print(text, flush=True)


def row(name: str, result: Result) -> str:
    marks = [word for word in ("opened", "moved", "stopped", "recovered") if getattr(result, word)]
    why = f": {result.refusal}" if result.refusal else ""
    return f"  {name:40} {', '.join(marks) or 'refused'}; watchdog {result.watchdog.value}{why}"


def report(folder: Path | None) -> None:
    if folder is not None:
        results = {path.name: attempt(path) for path in sheets_in(folder)}
        right = sum(result.is_right for result in results.values())
        say(f"data sheets of real drives: {right} of {len(results)} run, or are refused for want of a watchdog")
        for name, result in results.items():
            say(row(name, result))
        homes = {path.name: home(path) for path in sheets_in(folder)}
        say(f"homed by an index pulse: {sum(one.found for one in homes.values())} of {len(homes)}")
        for name, homed in homes.items():
            say(f"  {name:40} {'homed' if homed.found else homed.refusal or 'not homed'}")
    with tempfile.TemporaryDirectory() as made:
        _report_traits(Path(made))
        plain = TRAITS["plain"].write(Path(made), "plain")
        for tick_ms in TICKS_MS:
            say(f"fault reset, controlword looked at every {tick_ms} ms: {resets(plain, tick_ms * 1e-3)} of {RESETS}")
        met = [WAYS[number % len(WAYS)](plain, f"two-hosts-{number}") for number in range(MEETINGS)]
        say(f"two hosts on one bus, refused or both guarded: {sum(one.is_safe for one in met)} of {MEETINGS}")
        sheets = [plain] if folder is None else sheets_in(folder)
        deaf = [attempt(path, Conduct(deaf=True, reaction="nothing")) for path in sheets]
        proven = sum(result.watchdog is Watchdog.PROVEN for result in deaf)
        say(f"drives that never watch, called proven: {proven} of {len(deaf)}")


def _report_traits(folder: Path) -> None:
    results = {name: attempt(trait.write(folder, name), **trait.settings) for name, trait in TRAITS.items()}
    right = sum(result.is_right and result.is_safety is TRAITS[name].is_refused for name, result in results.items())
    say(f"data sheets with one trait each: {right} of {len(results)} as wanted")
    for name, result in results.items():
        say(row(name, result))


if __name__ == "__main__":
    given = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("FRICTION_BENCH_DICTIONARIES")
    report(Path(given) if given else None)
