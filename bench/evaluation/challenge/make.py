"""Makes a challenge: draws a joint that hides something, records it, and seals the answer."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from bench.errors import BenchError, ExperimentError, LimitError
from bench.evaluation.challenge.answer import Answer, Truth
from bench.evaluation.challenge.difficulty import Difficulty, find_difficulty
from bench.evaluation.challenge.hidden_plant import DrawnPlant, Wanted, draw_plant
from bench.evaluation.challenge.owner import bench_of, rig_of
from bench.evaluation.challenge.seal import answer_path, check_free, write_sealed
from bench.evaluation.challenge.session import protocol_of, record
from bench.evaluation.challenge.share import effort_share
from bench.recording_set import RecordingSet, write_recording_set
from bench.recording_set.transfer import BY_CONTROL_LOOP
from compensator.lab.recordings.recording import Recording

ATTEMPTS = 20  # a joint that cannot complete the protocol is no challenge


@dataclass(frozen=True, slots=True)
class Challenge:
    """What was made, in memory."""

    recording_set: RecordingSet
    answer: Answer


def write_challenge(seed: int, difficulty: str, output: Path) -> Path:
    """Make a challenge, and write recordings and answer: both, or nothing.

    Args:
        seed: the same seed makes the same bytes.
        difficulty: one of `DIFFICULTIES`.
        output: a folder, or a file that ends in .zip.

    Returns:
        The answer file.

    Raises:
        ParameterError: no such difficulty.
        RecordingSetError, SealError: a place is taken or cannot be written.
        ExperimentError: no joint of this seed completes the protocol.
    """
    check_free(output)
    sealed = answer_path(output)
    made = make_challenge(seed, difficulty)
    write_recording_set(made.recording_set, output)
    write_sealed(made.answer, output, sealed)
    return sealed


def make_challenge(seed: int, difficulty: str) -> Challenge:
    """Draw, record, and measure what the hidden makes of the effort. Errors as `write_challenge`."""
    chosen = find_difficulty(difficulty)
    reason: BenchError = ExperimentError("no joint was drawn")
    for attempt in range(ATTEMPTS):
        plant_seed, noise_seed = seeds_of(seed, attempt)
        drawn = draw_plant(plant_seed, _wanted(plant_seed, chosen))
        try:
            recordings = _record(drawn, noise_seed, chosen, None)
            truths = _truths(drawn, noise_seed, chosen, recordings)
        except (ExperimentError, LimitError) as error:
            reason = error
            continue
        answer = Answer(seed, difficulty, attempt, truths, drawn.tables())
        told = [replace(one, conditions={**one.conditions, **BY_CONTROL_LOOP}) for one in recordings]
        return Challenge(RecordingSet("challenge", rig_of(drawn), told), answer)
    raise ExperimentError(
        f"none of {ATTEMPTS} joints of seed {seed} completes the protocol ({reason}); take another seed"
    )


def seeds_of(seed: int, attempt: int) -> tuple[int, int]:
    """Seeds of the joint and of its noise. They tell nothing of each other."""
    joint, noise = np.random.SeedSequence((seed, attempt)).generate_state(2)
    return int(joint), int(noise)


def _wanted(seed: int, difficulty: Difficulty) -> Wanted:
    random = np.random.default_rng((seed, 1))
    return Wanted(int(random.choice(3, p=difficulty.counts)), difficulty.sizes, difficulty.noise)


def _record(drawn: DrawnPlant, seed: int, difficulty: Difficulty, without: str | None) -> list[Recording]:
    joint = drawn.joint
    return record(bench_of(drawn, seed, without), protocol_of(difficulty, joint.heaviest_kg, joint.top_rad_s))


def _truths(drawn: DrawnPlant, seed: int, difficulty: Difficulty, recordings: list[Recording]) -> tuple[Truth, ...]:
    if not drawn.hidden:
        return ()
    other_seed = (seed + 1) % 2**32
    pairs = {
        hidden.name: [_record(drawn, one, difficulty, hidden.name) for one in (seed, other_seed)]
        for hidden in drawn.hidden
    }
    shares = {name: effort_share(recordings, *both) for name, both in pairs.items()}
    return tuple(
        Truth(
            hidden.name,
            hidden.title,
            hidden.size,
            hidden.measure,
            hidden.unit,
            shares[hidden.name].value,
            hidden.tables,
            shares[hidden.name].at_most,
        )
        for hidden in drawn.hidden
    )
