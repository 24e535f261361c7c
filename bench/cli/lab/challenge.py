"""`friction-bench challenge` and `reveal`: recordings that hide something, and the answer."""

import secrets
import shlex
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.output import Json, percent, print_json, say, table

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.evaluation.challenge.answer import Answer
    from bench.evaluation.challenge.guess import Guess, Score


_DIFFICULTY = (
    "What is hidden. easy: nothing or one mechanism, a large one. medium: nothing, one or two. hard: nothing, one or "
    "two, small ones in short and noisy recordings. How often: --ranges."
)


class Level(Enum):
    """How hard."""

    EASY = "easy"
    MEDIUM = "medium"
    HARD = "hard"


def challenge(
    seed: Annotated[
        int | None,
        typer.Option(min=0, help="The same seed makes the same challenge; without it one that nobody knows."),
    ] = None,
    difficulty: Annotated[Level, typer.Option(help=_DIFFICULTY)] = Level.EASY,
    output: Annotated[Path, typer.Option(help="A folder to make, or a file that ends in .zip.")] = Path("challenge"),
    ranges: Annotated[bool, typer.Option("--ranges", help="Print what is drawn from which range, and why.")] = False,
) -> None:
    """Draw a joint at random, hide nothing, one or two mechanisms in it, record it, and seal the answer.

    The recordings tell nothing of the answer; whoever knows the seed can draw it again.
    """
    if ranges:
        _print_ranges()
        return
    from bench.evaluation.challenge.seal import check_free

    check_free(output)  # what draws and records takes seconds to load

    from bench.evaluation.challenge.make import write_challenge

    sealed = write_challenge(secrets.randbits(64) if seed is None else seed, difficulty.value, output)
    say(f"recordings: {output}")
    say(f"sealed answer: {sealed}")
    say(f"next: friction-bench import {shlex.quote(str(output))}")
    say(f"at last, with the number of its study: friction-bench reveal {shlex.quote(str(sealed))} --study STUDY")


def reveal(
    context: typer.Context,
    answer: Annotated[Path, typer.Argument(help="The sealed answer.")],
    guess: Annotated[
        str | None,
        typer.Option(
            help="What is hidden: effects (spring,viscous_asymmetry), a class (spring/gravity), nothing, none-of-these."
        ),
    ] = None,
    study: Annotated[int | None, typer.Option(help="Take the guess from what a study added and last found.")] = None,
    recordings: Annotated[
        Path | None, typer.Option(help="The recordings; checks that they are those of the answer.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Open the sealed answer of a challenge, and score a guess."""
    from bench.errors import ParameterError
    from bench.evaluation.challenge.guess import Guess, score
    from bench.evaluation.challenge.names import ABSORBED
    from bench.evaluation.challenge.seal import read_sealed
    from bench.evaluation.challenge.share import faint

    if guess is not None and study is not None:
        raise ParameterError("--guess and --study are both given; wanted is one of them")
    guessed = None if guess is None else Guess.parse(guess)
    if study is not None:
        guessed = _guess_of(context, study)
    opened = read_sealed(answer, recordings)
    names = [truth.name for truth in opened.truths]
    found = None if guessed is None else score(names, guessed, ABSORBED, faint(opened.truths))
    if as_json:
        print_json(_as_json(opened, guessed, found))
    else:
        _print(opened, guessed, found)


def _guess_of(context: typer.Context, study: int) -> "Guess":
    from bench.evaluation.challenge.guess import guess_of_study

    with session_of(context).open_store() as store:
        return guess_of_study(store, study)


def _as_json(answer: "Answer", guess: "Guess | None", score: "Score | None") -> dict[str, object]:
    from dataclasses import asdict

    from bench.evaluation.challenge.share import remarks_on

    found: dict[str, object] = {"answer": answer.to_json(), "remarks": remarks_on(answer.truths)}
    if guess is not None and score is not None:
        scored = {**asdict(score), "perfect": score.perfect, "points": score.points}
        found |= {"guess": asdict(guess), "guessed": guess.text, "score": scored}
    return found


def _print(answer: "Answer", guess: "Guess | None", score: "Score | None") -> None:
    from bench.evaluation.challenge.names import accepted
    from bench.evaluation.challenge.share import MEANING, remarks_on, share_in_words

    if answer.truths:
        rows = [
            (
                truth.title,
                " or ".join(accepted(truth.name)) or "none of these",
                f"{truth.size:.3g}{'' if truth.unit == '1' else f' {truth.unit}'} ({truth.measure})",
                share_in_words(truth),
            )
            for truth in answer.truths
        ]
        table("Hidden", ["mechanism", "in the catalogue", "size", "share of the effort#"], rows)
        say(MEANING)
    else:
        say("Hidden: nothing.")
    for sentence in remarks_on(answer.truths):
        say(sentence)
    if score is not None and guess is not None:
        say(f"guess: {guess.text}")
        _print_score(score)


def _print_score(score: "Score") -> None:
    from bench.evaluation.challenge.names import ACCEPTED, RECORDED, accepted

    sizes = ", ".join(map(str, score.class_sizes))
    lines = [
        ("right", score.right, f" (class of {sizes})" if any(size > 1 for size in score.class_sizes) else ""),
        ("missed", score.missed, ""),
        ("not to be told from what every model has", score.untold, ""),
        ("too little of it to count as missed", score.faint, ""),
        ("in every recording", score.recorded, f" ({'; '.join(RECORDED[one] for one in score.recorded)})"),
        ("false", score.wrong, ""),
    ]
    for word, names, note in lines:
        if names:  # as the catalogue calls them; a mechanism outside of it has its own name only
            called = (" or ".join(accepted(one)) or one if one in ACCEPTED else one for one in names)
            say(f"{word}: {', '.join(called)}{note}")
    if score.perfect:
        whole = "All that these recordings can tell" if score.untold or score.faint else "All of it"
        say(f"{whole}, and nothing else.{_by_classes(score)}")
    else:
        say(_loss(score))


def _by_classes(score: "Score") -> str:
    """What naming a class takes from a right guess; empty where each mechanism stands alone."""
    if all(size == 1 for size in score.class_sizes):
        return ""
    return f" A name in a class counts by its size: {score.points:.2g} of {len(score.right)}."


def _loss(score: "Score") -> str:
    """The verdict on a guess that is not all right; what need not be named does not count as hidden."""
    hidden, wrong = len(score.right) + len(score.missed), len(score.wrong)
    found = f"{len(score.right)} of {hidden} hidden mechanism{'s' * (hidden != 1)} found"
    if not hidden:
        found = "nothing was hidden that could be found"
    return f"Not right: {found}, {wrong or 'no'} name{'s' * (wrong != 1)} wrong."


def _print_ranges() -> None:
    from bench.evaluation.challenge.difficulty import DIFFICULTIES
    from bench.evaluation.challenge.hidden_plant import range_tables

    rows = [
        (name, *map(percent, one.counts), " to ".join(map(percent, one.sizes)), percent(one.noise), one.duration_s)
        for name, one in DIFFICULTIES.items()
    ]
    chances = [f"hides {count}#" for count in ("nothing", "one", "two")]
    columns = ["difficulty", *chances, "sizes, of their range", "noise, of the peak current#", "a motion [s]#"]
    table("Difficulty", columns, rows)
    for one in range_tables():
        table(one.title, ["quantity", "from#", "to#", "unit", "why"], one.rows)
