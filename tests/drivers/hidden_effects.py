"""Whether a hidden effect is found through a wire as it is in process: same name, error within 10 %. Not a test.

    python -m tests.drivers.hidden_effects KIND ...

Each effect: the same joint once in process and once behind the simulated device of each kind, in its own process; the
same trials (3 loads, 3 motions, 2 repeats: some 3 minutes by the wall clock), the same base model without the effect.
The lab names what is missing; it is added; the error on the trials held out (50 g) is what is compared.
"""

import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import tomli_w

from bench.config.configuration import BenchConfiguration, default_configuration, parse_configuration
from bench.config.drives.registry import drive_kind
from bench.evaluation.paper.measurements import Measurement, measure
from bench.store import Store
from bench.study.compare import compare
from bench.study.create import create_study
from bench.study.diagnose import diagnose
from tests.devices.device_process import device_process
from tests.devices.turns import turns

SENSED = {"current_sensor": {"present": True}, "current_loop": {"present": True}, "heat": {"present": True}}
KNOWN = ("inertia", "gravity", "offset", "coulomb", "viscous", "stribeck")
EXCITATION = Measurement("excitation", {"waveforms": ("slow-sine", "multisine", "triangles")})
MOST_DIFFERENCE = 0.1
OWN_CLOCK = ("dynamixel",)


class Hidden(NamedTuple):
    """What is done to the joint, what it is called, and what the model knows before."""

    title: str
    plant: dict[str, Any]
    names: tuple[str, ...]
    base: tuple[str, ...]


WHOLE = (*KNOWN, "weight_friction", "load_friction")
HIDDEN = (
    Hidden("load-dependent friction", {}, ("load_friction",), (*KNOWN, "weight_friction")),
    Hidden("backlash", {"gear": {"backlash_rad": 0.05}}, ("backlash",), WHOLE),
    Hidden(
        "thermal",
        {
            "lubricant": {"vogel_k": 1500.0},
            "heat": {"present": True, "winding_j_k": 2.0, "housing_j_k": 4.0},
            "friction": {"viscous_n_m_s_rad": 3e-4},
        },
        ("viscous_temperature",),
        WHOLE,
    ),
)


class Found(NamedTuple):
    """What the lab made of one recording."""

    name: str
    before: float
    after: float


def diagnosed(configuration: BenchConfiguration, hidden: Hidden) -> Found:
    """Record, diagnose, add."""
    with tempfile.TemporaryDirectory() as folder, Store.open(f"sqlite:///{folder}/bench.sqlite") as store:
        if "kind" in configuration.drive.model_dump() and configuration.drive.kind != "sim":
            measure(configuration, store, Measurement("commissioning", {}), lambda runner: runner.wait())
        recorded = measure(configuration, store, EXCITATION, lambda runner: runner.wait())
        without = _study(store, recorded.id, hidden.base)
        name = diagnose(store, without).ranking[0].effect
        added = _study(store, recorded.id, (*hidden.base, name))
        before, after = (compare(store, study).error.held_out.relative for study in (without, added))
        return Found(name, before, after)


def _study(store: Store, recorded: int, base: tuple[str, ...]) -> int:
    return create_study(store, "hidden", [recorded], hold_out=["load_kg=0.05"], base=base, rows="moving").study_id


def on_bench(drive: dict[str, Any], **sections: Any) -> BenchConfiguration:
    """The bench of the package with a drive."""
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    values["control"]["period_s"] = 0.005
    values["servo"] |= {"proportional_a_rad": 12.0, "integral_a_rad_s": 40.0, "derivative_a_s_rad": 0.3}
    values["limits"] |= {"sample_age_s": 1.0, "tracking_error_rad": 1.0}
    values["drive"] = drive
    for name, changes in sections.items():
        values[name] |= changes
    return parse_configuration(values, "bench.toml")


def through_wire(kind: str, hidden: Hidden) -> Found:
    """The same behind a simulated device."""
    variant = drive_kind(kind).conformance[0]
    with tempfile.TemporaryDirectory() as folder:
        plant = Path(folder) / "plant.toml"
        plant.write_text(tomli_w.dumps(hidden.plant))
        # a device whose stamps are its own may wait for a late host; of the others the stamps are the host's
        patience = ("--patience", "0.006") if kind in OWN_CLOCK else ()
        with device_process(kind, *variant.device, "--plant", str(plant), *patience) as device:
            return diagnosed(on_bench(device.drive | dict(variant.settings)), hidden)


def report(kinds: list[str]) -> bool:
    """Print a row for each effect and kind; whether every one is as asked."""
    met = True
    print(f"{'hidden':<26}{'in process':<40}{'through':<12}{'':<40}difference", flush=True)
    for hidden in HIDDEN:
        near = diagnosed(on_bench({"kind": "sim", "plant": SENSED | hidden.plant}), hidden)
        for kind in kinds:
            met = _row(hidden, near, kind) and met
    return met


def _row(hidden: Hidden, near: Found, kind: str) -> bool:
    """Print what one wire made of an effect; whether that is as asked."""
    try:
        far = through_wire(kind, hidden)
    except Exception as error:  # a run that a busy machine has ended: the others are worth their time
        print(f"{hidden.title:<26}{_words(near):<40}{kind:<12}NOT MET: {error}", flush=True)
        return False
    difference = far.after / near.after - 1.0
    right = near.name == far.name and far.name in hidden.names and abs(difference) <= MOST_DIFFERENCE
    ends = "" if right else "  NOT MET"
    print(f"{hidden.title:<26}{_words(near):<40}{kind:<12}{_words(far):<40}{difference:+.1%}{ends}", flush=True)
    return right


def _words(found: Found) -> str:
    return f"{found.name} ({found.before:.2%} -> {found.after:.2%})"


if __name__ == "__main__":
    with turns():
        sys.exit(0 if report(sys.argv[1:]) else 1)
