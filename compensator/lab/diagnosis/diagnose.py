"""Which effect is missing: screen the catalogue, name the best, find its rivals, and measure the gain on held-out rows.

Three questions, three statistics (docs/explanation/diagnosis.md): is anything missing (the least chance of all
candidates, over draws of the noise that is estimated), what is it called (likelihood less the price of parameters and
shapes), does it help (held-out error, resampled by whole trials).
"""

from math import nan

from compensator.lab import progress
from compensator.lab.at_rest.rest_comparison import RestComparison, at_rest_in_words, compare_at_rest
from compensator.lab.chance import SIGNIFICANT
from compensator.lab.diagnosis.absorbed import absorbed
from compensator.lab.diagnosis.alien_effort import alien_effort
from compensator.lab.diagnosis.answer import Answer
from compensator.lab.diagnosis.confirmation import nearest_one
from compensator.lab.diagnosis.data_checks import data_problems, fatal_problems, lesser_problems
from compensator.lab.diagnosis.diagnosis import Candidate, Diagnosis
from compensator.lab.diagnosis.four_families import LEFT, STAGES, judged
from compensator.lab.diagnosis.note import Note, Value
from compensator.lab.diagnosis.remaining import what_remains
from compensator.lab.diagnosis.run_to_run import ByRun, by_run_in_words, differences_by_run
from compensator.lab.diagnosis.wording import nearest_in_words
from compensator.lab.effects.catalogue import catalogue, effect_named
from compensator.lab.effects.effect import MotionRows
from compensator.lab.errors import UnusableDataError
from compensator.lab.left_over.orders import with_found_order
from compensator.lab.model.fit import fit_model, widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.validation import held_out
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import too_few_stretches
from compensator.lab.screening.gathering import gather, with_noise


@progress.stages(STAGES)
def diagnose(fit: Fit) -> Diagnosis:
    """Diagnose a fitted model on its training rows.

    Four families are judged one after the other: effects of the joint that show in steady sliding; effects with
    memory, which live near reversals and starts; effects that show in the effort of breaking away from rest; effects of
    the measuring chain. The first that has something missing is the answer, the others are notes: while something large
    is missing, the smaller may be its shadow. For the same reason a larger effect with memory goes before one of steady
    sliding. Where the data themselves are wrong, that is the answer, and nothing is ranked.

    Raises:
        UnusableDataError: no candidate can be judged on these trials.
    """
    if problems := fatal_problems(fit):
        return _data_problem(fit, problems[0])
    alien = alien_effort(fit)
    try:
        families = judged(fit)
    except UnusableDataError:
        if alien is None:
            raise
        return _data_problem(fit, alien.text)
    progress.enter(LEFT)
    first = families.first()
    too_short = first.verdict == "nothing" and too_few_stretches(families.gathered.stretches)
    # an effect that leaves less than mending the data would makes more sense of an effort that seems alien
    explained = alien is not None and first.verdict == "missing" and first.candidates[0].after <= alien.leaves
    if alien is not None and not explained and (alien.mended or not too_short):
        return _data_problem(fit, alien.text)
    others = [answer for answer in families.in_order if answer is not first]
    left = _left_in_sliding(first, families.gathered) if first is families.memory else []
    rest = compare_at_rest(fit)
    at_rest = [] if rest is None or not rest.is_evidence else [_at_rest(rest, fit.dataset.effort_definition.unit)]
    # what sliding leaves no room for, rest may: static friction beyond the model's is something that is missing
    sticks = first.verdict == "nothing" and rest is not None and rest.is_friction
    ranked = _once([candidate for answer in (first, *others) for candidate in answer.candidates])
    hiding = absorbed(first.explained or fit, families.left_out)
    notes = [*first.notes, *left, *(_also_missing(answer) for answer in others if answer.verdict == "missing")]
    notes += [note for answer in others if answer is families.rest for note in answer.notes]
    return Diagnosis(
        verdict=first.verdict,
        sentence=(f"{at_rest[0].text} In motion: " if sticks else "")
        + (first.sentence if too_short else with_nearest(first, ranked))
        + "".join(f" {note.text}" for note in hiding if first.verdict == "nothing"),
        p_value=first.p_value,
        classes=_classes(ranked),
        candidates=ranked,
        driver=first.driver,
        data_problems=[*([] if alien is None or explained else [alien.text]), *lesser_problems(fit)],
        notes=[
            *notes,
            *([] if sticks else at_rest),
            *([] if first.verdict == "nothing" else hiding),
            *_by_run(first.explained or fit),
        ],
        left_out=families.left_out,
        too_short=too_short,
        remains=first.remains or bool(left) or sticks,
    )


def best_named(fit: Fit, show_in: MotionRows) -> str | None:
    """The effect of one family that the rows speak for most, by score alone; None where none can be judged."""
    rows = fit.dataset.choice_for([effect for effect in catalogue().values() if effect.rows == show_in])
    gathered = with_noise(with_found_order(gather(widened(fit, rows), show_in)))
    blocks = [block for block in gathered.named if not effect_named(block.name).pipeline]
    screening = gathered.screened(blocks)
    return screening.evidence[0].block.name if screening.evidence else None


def with_nearest(first: Answer, ranked: list[Candidate]) -> str:
    """An answer in words; where nothing is confirmed, with what comes nearest: then something may be missing."""
    nearest = nearest_one(ranked) if first.verdict == "nothing" else None
    if nearest is None:
        return first.sentence
    plain = not first.remains and first.p_value > SIGNIFICANT
    return f"{'No effect is confirmed.' if plain else first.sentence} {nearest_in_words(nearest)}"


def _data_problem(fit: Fit, problem: str) -> Diagnosis:
    """The answer where the data are wrong: nothing is ranked."""
    sentence = f"The data have a problem that no effect could be told from: {problem}."
    return Diagnosis("data-problem", sentence, nan, [], [], data_problems=data_problems(fit))


def _also_missing(answer: Answer) -> Note:
    """Of another family than the one that has the answer."""
    text = f"{answer.sentence} It may be the shadow of the first finding: add that, and diagnose again."
    return Note("also-missing", text, {"effect": answer.candidates[0].effect.name})


def _at_rest(found: RestComparison, unit: str) -> Note:
    """What rests say against the model, which sliding cannot say."""
    values: dict[str, Value] = {"stretches": found.windows, "outside": found.outside, "largest": found.largest}
    return Note("at-rest", at_rest_in_words(found, unit), {**values, "unit": unit})


def _by_run(fit: Fit) -> list[Note]:
    """What differs from run to run with what is named in the model: a floor, or the work of what is still missing."""
    unit = fit.dataset.effort_definition.unit
    return [_differs_by_run(one, unit) for one in differences_by_run(fit, held_out(fit))]


def _left_in_sliding(memory: Answer, sliding: Candidates) -> list[Note]:
    """What an effect with memory that is named leaves in steady sliding: near reversals not all of it is asked for."""
    if memory.explained is None or memory.remains:
        return []
    fit = memory.explained
    seen = fit_model(sliding.fit.dataset, fit.names, fit.training, fit.shapes)
    return what_remains(seen, sliding, memory.candidates[0].effect.name)


def _once(candidates: list[Candidate]) -> list[Candidate]:
    """Each effect once, by the family that comes first."""
    found: dict[str, Candidate] = {}
    for candidate in candidates:
        found.setdefault(candidate.effect.name, candidate)
    return list(found.values())


def _classes(candidates: list[Candidate]) -> list[tuple[str, ...]]:
    """Group candidates with their rivals, in order of rank; each effect is in one class."""
    classes: list[tuple[str, ...]] = []
    placed: set[str] = set()
    for candidate in candidates:
        if candidate.effect.name in placed:
            continue
        members = [candidate.effect.name, *(name for name in candidate.rivals if name not in placed)]
        placed.update(members)
        classes.append(tuple(members))
    return classes


def _differs_by_run(found: ByRun, unit: str) -> Note:
    """A constant that differs from run to run."""
    values: dict[str, Value] = {
        "what": found.what,
        "scatter": found.scatter,
        "unit": unit,
        "trial": found.trial,
        "difference": found.difference,
        "floor": found.floor,
    }
    return Note("differs-by-run", by_run_in_words(found, unit), values)
