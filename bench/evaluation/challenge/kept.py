"""Challenges in a store: the recordings as an experiment, the sealed answer among its parameters."""

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime

from bench.evaluation.challenge.answer import Answer
from bench.evaluation.challenge.make import make_challenge
from bench.evaluation.challenge.seal import sealed, unsealed
from bench.recording_set import import_recording_set
from bench.recording_set.transfer import IMPORT_KIND
from bench.store import Store
from bench.store.errors import NotFoundError
from bench.store.records import Experiment

SEALED, DIFFICULTY = "sealed_answer", "difficulty"
PAGE = 1000  # experiments read at once


@dataclass(frozen=True, slots=True)
class KeptChallenge:
    """A challenge without its answer.

    Attributes:
        experiment_id: under which its recordings are; it is the challenge's number, too.
        name: of the recordings.
        difficulty: as it was asked for.
        started_utc: when it was made.
    """

    experiment_id: int
    name: str
    difficulty: str
    started_utc: datetime


def keep_challenge(store: Store, seed: int, difficulty: str) -> KeptChallenge:
    """Draw, record and keep a challenge. Takes half a minute; errors as `make_challenge`."""
    made = make_challenge(seed, difficulty)
    further = {DIFFICULTY: difficulty, SEALED: sealed(made.answer)}
    number = import_recording_set(store, made.recording_set, f"challenge, {difficulty}", further)
    return _shown(store.experiment(number))


def kept_challenges(store: Store) -> Iterator[KeptChallenge]:
    """All of them, newest first; read as far as they are asked for."""
    offset = 0
    while page := store.experiments(kind=IMPORT_KIND, limit=PAGE, offset=offset):
        yield from (_shown(one) for one in page if SEALED in one.parameters)
        offset += PAGE


def answer_of(store: Store, challenge_id: int) -> Answer:
    """Open the seal.

    Raises:
        NotFoundError: there is no such challenge.
        SealError: what is kept was changed.
    """
    text = store.experiment(challenge_id).parameters.get(SEALED)
    if not isinstance(text, str):
        raise NotFoundError(f"experiment {challenge_id} is no challenge; GET /challenges lists those there are")
    return unsealed(text, f"challenge {challenge_id}")


def _shown(experiment: Experiment) -> KeptChallenge:
    parameters = experiment.parameters
    return KeptChallenge(
        experiment.id, str(parameters["name"]), str(parameters.get(DIFFICULTY, "")), experiment.started_utc
    )
