"""/challenges: a joint that hides something, to practise on; what it hides is told once a guess is made."""

import secrets
from datetime import datetime
from itertools import islice
from typing import TYPE_CHECKING, Annotated, Literal

from fastapi import Depends, Path, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from bench.errors import ParameterError
from bench.service.auth.access import allow_read, require_token
from bench.service.auth.audit_trail import note
from bench.service.compute import in_lab
from bench.service.http.api_router import api_router
from bench.service.http.pages import Limit, Offset, Page, cut
from bench.service.http.problems import problems
from bench.service.services import StoreOf
from bench.store import Store

if TYPE_CHECKING:  # imported when first needed
    from bench.evaluation.challenge.guess import Score
    from bench.evaluation.challenge.kept import KeptChallenge

router = api_router("/challenges", tags=["challenges"], dependencies=[Depends(allow_read)])
ChallengeId = Annotated[int, Path(ge=1, description="number of the challenge, which is that of its experiment")]
Part = Annotated[str, Field(min_length=1, max_length=1000, pattern=r"^[^,]+$")]
Level = Literal["easy", "medium", "hard"]


class NewChallenge(BaseModel):
    """What is wanted."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"difficulty": "easy"}]})
    difficulty: Level = Field(default="easy", description="how much is hidden, how large, how good the recordings")
    seed: int | None = Field(
        default=None, ge=0, lt=2**64, description="the same seed makes the same challenge; null: one that nobody knows"
    )


class Challenge(BaseModel):
    """A challenge; its answer is sealed."""

    challenge_id: int
    experiment_id: int = Field(description="its recordings: make a study of them")
    name: str
    difficulty: str
    created_utc: datetime


class Challenges(Page):
    """One page of challenges, newest first."""

    items: list[Challenge]


class Reveal(BaseModel):
    """A guess: in words, or what a study amounts to."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"guess": "viscous_asymmetry"}]})
    guess: Annotated[str, Field(max_length=1000)] | Annotated[list[Part], Field(max_length=100)] | None = Field(
        default=None,
        description="nothing, none-of-these, effects (spring,viscous_asymmetry), a class of them (spring/gravity); "
        "or a list of these, as `guessed` tells them, in which none is nothing",
    )
    study_id: int | None = Field(default=None, ge=1, description="take what this study added and last found")


class Hidden(BaseModel):
    """One hidden mechanism."""

    title: str
    effects: list[str] = Field(description="names in the catalogue that are right; none: it is outside of it")
    size: float
    measure: str = Field(description="what `size` is the size of")
    unit: str
    share: float = Field(
        description="rms of what it changes in the motor current over the current's rms, less what two runs of one "
        "joint differ by anyway, 0..1"
    )
    share_at_most: float | None = Field(
        description="the same with what two runs differ by, 0..1; null: of an earlier version"
    )
    share_words: str = Field(description="the share as per cent, or its bound where it is not told from that scatter")


class Revealed(BaseModel):
    """What was hidden, and how good the guess was."""

    challenge_id: int
    hidden: list[Hidden]
    guessed: list[str] = Field(description="each an effect, a class joined by '/', or none-of-these")
    right: list[str]
    missed: list[str]
    untold: list[str] = Field(description="hidden, but no recording of motion can tell; they do not count")
    faint: list[str] = Field(
        description="hidden, but the recordings surely hold less of it than a diagnosis may name; they do not count"
    )
    recorded: list[str] = Field(description="named, and in every recording, whatever is hidden; they do not count")
    wrong: list[str]
    perfect: bool
    sentence: str


@router.post(
    "",
    status_code=201,
    summary="Make a challenge",
    dependencies=[Depends(require_token)],
    responses=problems(401, 403, 409, 422),
)
async def create(request: Request, response: Response, body: NewChallenge) -> Challenge:
    """Draws a joint at random, hides nothing, one or two mechanisms in it, and records it. Takes half a minute."""
    seed = secrets.randbits(64) if body.seed is None else body.seed
    made = await in_lab(request, _made, seed, body.difficulty)
    note(request, f"made challenge {made.challenge_id} ({made.difficulty})")
    response.headers["Location"] = f"{request.url.path}/{made.challenge_id}"
    return made


def _made(store: Store, seed: int, difficulty: Level) -> Challenge:
    from bench.evaluation.challenge.kept import keep_challenge  # the plant and the lab are imported when first needed

    return _represent(keep_challenge(store, seed, difficulty))


@router.get("", summary="The challenges there are", responses=problems(422))
def challenges(store: StoreOf, limit: Limit = 100, offset: Offset = 0) -> Challenges:
    """Newest first, without their answers."""
    from bench.evaluation.challenge.kept import kept_challenges

    items, page = cut(list(islice(kept_challenges(store), offset, offset + limit + 1)), limit, offset)
    return Challenges(items=[_represent(one) for one in items], **page)


@router.post(
    "/{challenge_id}/reveal",
    summary="Guess, and be told",
    dependencies=[Depends(require_token)],
    responses=problems(401, 403, 404, 409, 422),
)
async def reveal(request: Request, challenge_id: ChallengeId, body: Reveal) -> Revealed:
    """Opens the seal and holds the guess against what was hidden."""
    if (body.guess is None) == (body.study_id is None):
        raise ParameterError("wanted is one of guess and study_id: what do you say is hidden?")
    told = await in_lab(request, _reveal, challenge_id, body)
    note(request, f"revealed challenge {challenge_id}: guess {', '.join(told.guessed) or 'nothing'}")
    return told


def _reveal(store: Store, challenge_id: int, body: Reveal) -> Revealed:
    from bench.evaluation.challenge.guess import Guess, guess_of_study, score
    from bench.evaluation.challenge.kept import answer_of
    from bench.evaluation.challenge.names import ABSORBED, accepted, title_of
    from bench.evaluation.challenge.share import faint, remarks_on, share_in_words

    answer = answer_of(store, challenge_id)
    guess = guess_of_study(store, body.study_id or 0) if body.guess is None else Guess.parse(_text(body.guess))
    found = score([truth.name for truth in answer.truths], guess, ABSORBED, faint(answer.truths))
    hidden = [
        Hidden(
            title=truth.title,
            effects=list(accepted(truth.name)),
            size=truth.size,
            measure=truth.measure,
            unit=truth.unit,
            share=truth.share,
            share_at_most=truth.share_at_most,
            share_words=share_in_words(truth),
        )
        for truth in answer.truths
    ]
    return Revealed(
        challenge_id=challenge_id,
        hidden=hidden,
        guessed=guess.words,
        right=[title_of(one) for one in found.right],
        missed=[title_of(one) for one in found.missed],
        untold=[title_of(one) for one in found.untold],
        faint=[title_of(one) for one in found.faint],
        recorded=list(found.recorded),
        wrong=list(found.wrong),
        perfect=found.perfect,
        sentence=" ".join([_sentence(len(hidden), found), *remarks_on(answer.truths)]),
    )


def _text(guess: str | list[str]) -> str:
    """A guess as `Guess.parse` reads it."""
    return guess if isinstance(guess, str) else ",".join(guess) or "nothing"


def _sentence(hidden: int, found: "Score") -> str:
    what = {0: "Nothing was hidden", 1: "One mechanism was hidden"}.get(hidden, f"{hidden} mechanisms were hidden")
    if found.perfect and (found.untold or found.faint):
        return f"{what}, and the guess says all that these recordings can tell."
    if found.perfect:
        return f"{what}, and the guess says just that."
    parts = [f"{len(found.missed)} missed"] * bool(found.missed) + [f"{len(found.wrong)} wrong"] * bool(found.wrong)
    return f"{what}; of the guess {len(found.right)} right, {', '.join(parts)}."


def _represent(found: "KeptChallenge") -> Challenge:
    number = found.experiment_id
    return Challenge(
        challenge_id=number,
        experiment_id=number,
        name=found.name,
        difficulty=found.difficulty,
        created_utc=found.started_utc,
    )
