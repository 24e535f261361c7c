"""The comparison: per seed the same trials for all rivals, with free play in the gear and without."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from bench.config.configuration import BenchConfiguration
from bench.config.reflected_load import per_kg_a
from bench.control.drive_factory import seed_of, with_seed
from bench.drives.sim.settings import SimulatedDriveSettings
from bench.errors import ConfigurationError
from bench.evaluation.rivals import scoring
from bench.evaluation.rivals.knowledge import calibrated, knowledge_of
from bench.evaluation.rivals.record import Recorded, record
from bench.evaluation.rivals.scoring import Score
from bench.json_types import Values
from compensator.motion.load_estimate import RestResult
from compensator.rivals import RIVALS, Knowledge

LOAD_KG = 0.05
WALL = {"present": True, "angle_rad": 0.4}
STEPS = {"load_kg": LOAD_KG, "repeats": 4}
SPEEDS = {"load_kg": LOAD_KG, "speeds_rad_s": (0.5, 1.5, 3.0, 5.0)}
SINUSOID = {"load_kg": LOAD_KG, "frequency_hz": 0.5, "periods": 3}
WALL_SINUSOID = {"load_kg": LOAD_KG, "frequency_hz": 0.05, "amplitude_rad": 0.5, "periods": 1}
"""Slow: an arm that hits a wall at speed wedges there, and no motor current tells how far."""
HANGING = {"loads_kg": (LOAD_KG,), "angles_rad": (0.0,), "searches": 1}
RIGS = {"with free play": None, "without free play": 0.0}


@dataclass(frozen=True)
class Comparison:
    """What came out on one rig.

    Attributes:
        rig: in words.
        scores: rival's name -> score, over all seeds.
    """

    rig: str
    scores: dict[str, Score]


def compare(
    configuration: BenchConfiguration, seeds: Sequence[int], say: Callable[[str], None] = lambda _sentence: None
) -> list[Comparison]:
    """Compare all rivals on the simulated joint of a configuration.

    Args:
        configuration: of a simulated bench.
        seeds: of its drive; the same trials for each.
        say: told what is under way.

    Raises:
        ConfigurationError: the drive is real.
    """
    if seed_of(configuration) is None:
        raise ConfigurationError(
            "rivals are compared on a simulated joint, where the truth is known; this drive is real"
        )
    found = []
    for rig, free_play_rad in RIGS.items():
        joint = configuration if free_play_rad is None else _with_free_play(configuration, free_play_rad)
        say(f"{rig}: calibration")
        joint = calibrated(joint)
        knowledge, scores = knowledge_of(joint), {rival.name: Score() for rival in RIVALS}
        for seed in seeds:
            say(f"{rig}: seed {seed}")
            _score_seed(with_seed(joint, seed), knowledge, scores)
        found.append(Comparison(rig, scores))
    return found


def _score_seed(configuration: BenchConfiguration, knowledge: Knowledge, scores: dict[str, Score]) -> None:
    """All trials of one seed, each replayed to every rival."""
    per_kg = per_kg_a(configuration.rig)
    plain = _with_method(configuration, "paper").model_copy(update={"rest": None})
    at_rest = {"online": record(configuration, "steps", **STEPS), "paper": record(plain, "steps", **STEPS)}
    hanging = {
        "online": scoring.result_of(record(configuration, "load-sweep", **HANGING)[0]),
        "paper": scoring.result_of(record(plain, "load-sweep", **HANGING)[0]),
    }
    motions = _motions(configuration)
    for rival in RIVALS:
        score = scores[rival.name]
        for trial in at_rest.get(rival.name, at_rest["online"]):
            scoring.score_rest(score, rival, knowledge, trial, configuration.rig, per_kg)
        rest: RestResult | None = hanging.get(rival.name)
        for trial, masks in motions:
            scoring.score_motion(score, rival, knowledge, trial, configuration.rig, rest, masks, per_kg)


def _motions(configuration: BenchConfiguration) -> list[tuple[Recorded, dict[str, scoring.Mask]]]:
    """The trials in motion, with the rows of each regime."""
    steady = record(configuration, "steady-speeds", **SPEEDS)
    sinusoid = record(configuration, "sinusoid", **SINUSOID)
    wall = record(_with_plant(configuration, {"wall": WALL}), "sinusoid", **WALL_SINUSOID)
    return [
        *((trial, {"steady speed": scoring.steady_rows(trial)}) for trial in steady),
        *(
            (trial, {"sinusoid": scoring.sinusoid_rows(trial), "reversal": scoring.reversal_rows(trial)})
            for trial in sinusoid
        ),
        *((trial, {"wall": scoring.wall_rows(trial)}) for trial in wall),
    ]


def _with_method(configuration: BenchConfiguration, method: str) -> BenchConfiguration:
    return configuration.model_copy(update={"search": configuration.search.model_copy(update={"method": method})})


def _with_plant(configuration: BenchConfiguration, plant: Values) -> BenchConfiguration:
    assert isinstance(configuration.drive, SimulatedDriveSettings)  # as was checked
    merged = {**configuration.drive.plant, **plant}
    return configuration.model_copy(update={"drive": configuration.drive.model_copy(update={"plant": merged})})


def _with_free_play(configuration: BenchConfiguration, free_play_rad: float) -> BenchConfiguration:
    """Another gear: in the plant, and in what its owner knows of it."""
    gear = configuration.rig.gear.model_copy(update={"backlash_rad": free_play_rad})
    rig = configuration.rig.model_copy(update={"gear": gear})
    changed = _with_plant(configuration, {"gear": {"backlash_rad": free_play_rad}})
    return changed.model_copy(update={"rig": rig, "friction": None, "rest": None})
