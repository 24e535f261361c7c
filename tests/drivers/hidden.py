"""Whether a hidden effect is found through a wire as it is in process: same name, error within 10 %. Not a test.

    python -m tests.drivers.hidden [KIND ...]

Each effect: the same joint once in process and once behind the simulated device of each kind, through its real driver
and the bytes or frames of its protocol, in virtual time: how busy the machine is changes nothing. The same trials (3
loads up and down, 3 motions), the same base model without the effect, the same cut-off, the same control loop: what a
drive on a wire says is as old as the demand that it has just got, so that the one in process tells it a cycle later.
The lab names what is missing; it is added; the error on the trials held out (50 g) is what is compared.

Not the same is the phase: a simulated device looks at its joint and its demand once a millisecond, and the cycles of
the host drift through that. In process they do not. With free play the trials of one wire differ by a tenth: each
motion is recorded twice there.
"""

from tests.drivers.virtual_devices import KINDS, TIME, device_of, reached  # first: the drivers read its clock

# isort: split
import sys
import tempfile
from typing import Any, NamedTuple

from bench.config.configuration import BenchConfiguration, default_configuration, parse_configuration
from bench.evaluation.paper.measurements import Measurement, measure
from bench.runs.runner import Runner
from bench.store import Store
from bench.study.compare import compare
from bench.study.create import create_study
from bench.study.diagnosis.diagnose import diagnose
from drivers.contract import Mode
from sim_backend.devices.axis import TICK_S
from tests.commission.wires import VirtualWire

SENSED = {"current_sensor": {"present": True}, "current_loop": {"present": True}, "heat": {"present": True}}
KNOWN = ("inertia", "gravity", "offset", "coulomb", "viscous", "stribeck")
PERIOD_S = 0.005
# a cycle later: without it the loop in process goes through free play less often, and errs 30 % less there
AS_ON_A_WIRE = {"latency": {"delay_s": PERIOD_S}}
# up and down: a joint that warms while loads only grow does not tell temperature from load
LOADS_KG = (0.0, 0.05, 0.1, 0.1, 0.05, 0.0)
MOTIONS = {"waveforms": ("slow-sine", "multisine", "triangles"), "loads_kg": LOADS_KG}
# a Feetech servo, which takes a duty, tells speeds in 15 bits: with this joint on it up to 2.5 rad/s
SPEEDS_RAD_S = {Mode.CURRENT: 4.0, Mode.DUTY: 1.6}
# does not swing in free play: the error of a recording differs by 1 % from seed to seed, with twice the gains by 5 %
CALM = {"proportional_a_rad": 6.0, "integral_a_rad_s": 15.0, "derivative_a_s_rad": 0.3}
MOST_DIFFERENCE = 0.1
CUTOFF_HZ = 10.0  # of both: else each recording chooses its own, by its noise, and what is smoothed more errs less


class Hidden(NamedTuple):
    """What is done to the joint, what it is called, and what the model knows before."""

    title: str
    plant: dict[str, Any]
    names: tuple[str, ...]
    base: tuple[str, ...]
    repeats: int = 1  # of each motion


WHOLE = (*KNOWN, "weight_friction", "load_friction")
HIDDEN = (
    Hidden("load-dependent friction", {}, ("load_friction",), (*KNOWN, "weight_friction")),
    Hidden("backlash", {"gear": {"backlash_rad": 0.05}}, ("backlash",), WHOLE, repeats=2),
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


def diagnosed(configuration: BenchConfiguration, hidden: Hidden, mode: Mode, wire: VirtualWire | None = None) -> Found:
    """Record, diagnose, add."""

    def to_its_end(runner: Runner) -> None:
        while not runner.wait(0.02):
            prompt = runner.status().prompt
            if prompt is not None and wire is not None:
                hang(wire, prompt.sentence)
                runner.answer(prompt.number)

    with tempfile.TemporaryDirectory() as folder, Store.open(f"sqlite:///{folder}/bench.sqlite") as store:
        if wire is not None:
            measure(configuration, store, Measurement("commissioning", {}), to_its_end)
        motion = Measurement("excitation", MOTIONS | {"speed_rad_s": SPEEDS_RAD_S[mode], "repeats": hidden.repeats})
        recorded = measure(configuration, store, motion, to_its_end)
        without = _study(store, recorded.id, hidden.base)
        ranking = diagnose(store, without).ranking
        before = compare(store, without).error.held_out.relative
        if not ranking:
            return Found("nothing named", before, before)
        name = ranking[0].effect
        added = _study(store, recorded.id, (*hidden.base, name))
        after = compare(store, added).error.held_out.relative
        return Found(name, before, after)


def hang(wire: VirtualWire, sentence: str) -> None:
    """Do what a person is asked to do."""
    TIME.advance(2.0 * TICK_S)  # a power stage that was told to be off takes a tick
    wire.catch_up()
    words = sentence.split()
    wire.device.axis.hang_load(float(words[1]) / 1000.0 if words[0] == "Hang" else 0.0, "balanced," in words)


def _study(store: Store, recorded: int, base: tuple[str, ...]) -> int:
    made = create_study(
        store, "hidden", [recorded], hold_out=["load_kg=0.05"], base=base, rows="moving", cutoff_hz=CUTOFF_HZ
    )
    return made.study_id


def on_bench(drive: dict[str, Any]) -> BenchConfiguration:
    """The bench of the package with a drive."""
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    values["control"]["period_s"] = PERIOD_S
    values["servo"] |= CALM
    values["limits"] |= {"sample_age_s": 1.0, "tracking_error_rad": 1.0}
    values["drive"] = drive
    return parse_configuration(values, "bench.toml")


def through_wire(kind: str, hidden: Hidden) -> Found:
    """The same behind a simulated device."""
    device, section = device_of(kind, hidden.plant)
    wire = VirtualWire(device)
    with reached(wire, section):
        return diagnosed(on_bench({"kind": kind, **section}), hidden, mode_of(kind), wire)


def report(kinds: list[str]) -> bool:
    """Print a row for each effect and kind; whether every one is as asked."""
    met = True
    print(f"{'hidden':<26}{'in process':<40}{'through':<12}{'':<40}difference", flush=True)
    for hidden in HIDDEN:
        near = {mode: in_process(hidden, mode) for mode in dict.fromkeys(map(mode_of, kinds))}
        for kind in kinds:
            met = _row(hidden, near[mode_of(kind)], kind) and met
    return met


def mode_of(kind: str) -> Mode:
    """How the bench moves a joint with a drive of a kind."""
    return Mode.DUTY if kind == "feetech" else Mode.CURRENT


def in_process(hidden: Hidden, mode: Mode) -> Found:
    """The same without a wire, with the same control loop."""
    plant = SENSED | hidden.plant | AS_ON_A_WIRE | {"current_loop": {"present": mode is Mode.CURRENT}}
    return diagnosed(on_bench({"kind": "sim", "plant": plant}), hidden, mode)


def _row(hidden: Hidden, near: Found, kind: str) -> bool:
    """Print what one wire made of an effect; whether that is as asked."""
    try:
        far = through_wire(kind, hidden)
    except Exception as error:  # the others are worth their time
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
    sys.exit(0 if report(sys.argv[1:] or list(KINDS)) else 1)
