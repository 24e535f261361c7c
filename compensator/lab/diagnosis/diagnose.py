"""Which effect is missing: screen the catalogue, name the best, find its rivals, and measure the gain on held-out rows.

Three questions, three statistics (docs/diagnosis.md): is anything missing (maximum over all candidates of a robust
score, its null by sign flips of whole stretches), what is it called (likelihood less the price of parameters and
shapes), does it help (held-out error, resampled by whole trials).
"""

from math import nan

import numpy as np

from compensator.lab.at_rest.breakaway_rows import breakaway_rows
from compensator.lab.at_rest.rest_comparison import at_rest_in_words, compare_at_rest
from compensator.lab.diagnosis.breakaway_family import breakaway_answer
from compensator.lab.diagnosis.data_checks import data_problems, fatal_problems, unexplained
from compensator.lab.diagnosis.diagnosis import Candidate, Diagnosis
from compensator.lab.diagnosis.drawn_shape import answer_beside
from compensator.lab.diagnosis.examination import SIGNIFICANT
from compensator.lab.diagnosis.families import Answer, answer_of, beside, what_remains
from compensator.lab.diagnosis.run_to_run import by_run_in_words, differences_by_run
from compensator.lab.diagnosis.unfollowed import FORMULA_SHARE
from compensator.lab.diagnosis.wording import problem_in_words
from compensator.lab.effects.catalogue import candidates, catalogue, effect_named
from compensator.lab.effects.effect import MotionRows
from compensator.lab.errors import UnusableDataError
from compensator.lab.model.fit import fit_effects, widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.validation import held_out
from compensator.lab.recordings.regimes import Regime
from compensator.lab.screening.candidates import Candidates, gather
from compensator.lab.screening.clearing import with_noise
from compensator.lab.screening.evidence import Screening, kept_evidence, least_p_value, screen, screen_against_noise
from compensator.lab.screening.own_load import on_own_load

FEWEST_REVERSAL_ROWS = 40
EXPLAINED = 0.75  # of the error: what an effect may leave of an effort that seemed alien to the motion


def diagnose(fit: Fit) -> Diagnosis:
    """Diagnose a fitted model on its training rows.

    Four families are judged one after the other: effects of the joint that show in steady sliding; effects with
    memory, which live near reversals and starts; effects that show in the effort of breaking away from rest; effects of
    the measuring chain. The first that has something missing
    is the answer, the others are notes: while something large is missing, the smaller may be its shadow. For the same
    reason a larger effect with memory goes before one of steady sliding. Where the data themselves are wrong, that is
    the answer, and nothing is ranked.

    Raises:
        UnusableDataError: no candidate can be judged on these trials.
    """
    if problems := fatal_problems(fit):
        return _data_problem(fit, problems[0])
    gathered = with_noise(gather(fit))
    stretch = fit.dataset.block_index[gathered.rows]
    physical = [block for block in gathered.named if not effect_named(block.name).pipeline]
    pipeline = [block for block in gathered.named if effect_named(block.name).pipeline]
    if not physical:
        raise UnusableDataError(
            "no effect of the catalogue can be judged on these trials; record " + "; ".join(gathered.left_out.values())
        )
    assert gathered.noise is not None
    generic = screen(gathered.bases, gathered.curves.blocks, stretch, noise=gathered.noise)
    sliding = screen_against_noise(gathered.bases, physical, gathered.noise)
    steady = answer_of(fit, gathered, sliding, generic)
    chain = answer_of(fit, gathered, screen_against_noise(gathered.bases, pipeline, gathered.noise), None)
    beside_drawn = None if steady.verdict == "missing" else answer_beside(fit, gathered)
    if beside_drawn is not None:
        steady, gathered = beside_drawn
    memory, wide, not_judged = _memory(fit)
    rest, not_at_rest = breakaway_answer(fit, breakaway_rows(fit), _least_p(sliding))
    families = [steady, *(answer for answer in (memory, rest) if answer is not None), chain]
    first = _first_of(families)
    if memory is not None and wide is not None and first is steady and _casts(wide, memory, steady):
        first = memory
    if (problems := unexplained(fit)) and not _explains_most(first):
        return _data_problem(fit, problems[0])
    others = [answer for answer in families if answer is not first]
    if first is steady or first is chain:
        first = beside(first, chain if first is steady else steady, fit, gathered)
    ranked = _once([candidate for answer in (first, *others) for candidate in answer.candidates])
    left = _left_in_sliding(fit, gathered, first) if first is memory else []
    notes = [*first.notes, *left, *(answer.sentence for answer in others if answer.verdict == "missing")]
    if rest is not None and rest is not first:
        notes += rest.notes
    return Diagnosis(
        verdict=first.verdict,
        sentence=first.sentence,
        p_value=first.p_value,
        classes=_classes(ranked),
        candidates=ranked,
        driver=first.driver,
        data_problems=data_problems(fit),
        notes=[*notes, *_at_rest(fit), *_by_run(first.explained or fit)],
        left_out={**gathered.left_out, **not_judged, **not_at_rest},
        too_short=first.verdict == "nothing" and least_p_value(len(np.unique(stretch))) > SIGNIFICANT,
        remains=first.remains or bool(left) or (first.verdict == "nothing" and steady.remains),
        shapes=gathered.fit.shapes if beside_drawn is not None else None,
    )


def best_named(fit: Fit, show_in: MotionRows) -> str | None:
    """The effect of one family that the rows speak for most, by score alone; None where none can be judged."""
    rows = fit.dataset.choice_for([effect for effect in catalogue().values() if effect.rows == show_in])
    gathered = gather(widened(fit, rows), show_in)
    blocks = [block for block in gathered.named if not effect_named(block.name).pipeline]
    screening = screen(gathered.bases, blocks, fit.dataset.block_index[gathered.rows])
    return screening.evidence[0].block.name if screening.evidence else None


def _explains_most(answer: Answer) -> bool:
    """Whether an effect is named that makes sense of an effort that seemed alien to the motion, as a resonance can."""
    if answer.verdict != "missing":
        return False
    return answer.candidates[0].gain.value > 1.0 - EXPLAINED


def _data_problem(fit: Fit, problem: str) -> Diagnosis:
    """The answer where the data are wrong: nothing is ranked."""
    return Diagnosis("data-problem", problem_in_words(problem), nan, [], [], data_problems=data_problems(fit))


def _at_rest(fit: Fit) -> list[str]:
    """What rests say against the model, which sliding cannot say."""
    found = compare_at_rest(fit)
    if found is None or not found.is_evidence:
        return []
    return [at_rest_in_words(found, fit.dataset.effort_definition.unit)]


def _by_run(fit: Fit) -> list[str]:
    """What differs from run to run with what is named in the model: a floor, or the work of what is still missing."""
    unit = fit.dataset.effort_definition.unit
    return [by_run_in_words(one, unit) for one in differences_by_run(fit, held_out(fit))]


def _memory(fit: Fit) -> tuple[Answer | None, Candidates | None, dict[str, str]]:
    """The family of effects with memory, on all rows in motion; None, and why, where these hold no reversals."""
    dataset = fit.dataset
    trained = np.isin(dataset.trial_index, np.unique(dataset.trial_index[fit.training]))
    near_reversals = int((trained & (dataset.regime == Regime.TRANSIENT)).sum())
    wanted = [effect for effect in candidates(fit.names, dataset.facts) if effect.rows == "moving"]
    if near_reversals < FEWEST_REVERSAL_ROWS:
        why = f"needs reversals and starts: {near_reversals} rows lie near one, wanted {FEWEST_REVERSAL_ROWS}; record "
        return None, None, {effect.name: f"{effect.name} {why}{effect.excited_by}" for effect in wanted}
    wide = widened(fit, "moving" if dataset.rows == "sliding" else dataset.rows)
    gathered = on_own_load(gather(wide, "moving"))
    screening = screen(gathered.bases, gathered.named, dataset.block_index[gathered.rows])
    return answer_of(wide, gathered, screening, None), gathered, gathered.left_out


def _left_in_sliding(fit: Fit, gathered: Candidates, memory: Answer) -> list[str]:
    """What an effect with memory that is named leaves in steady sliding: near reversals not all of it is asked for."""
    if memory.verdict != "missing" or memory.remains:
        return []
    name = memory.candidates[0].effect.name
    return what_remains(fit_effects(fit.dataset, [*fit.names, name], fit.training), gathered, name)


def _casts(wide: Candidates, memory: Answer, steady: Answer) -> bool:
    """Whether what steady sliding speaks for is the shadow of a larger effect with memory, which stands without it."""
    if memory.verdict == "nothing" or steady.verdict != "missing" or memory.strength <= steady.strength:
        return False
    shadow = steady.candidates[0]
    given = wide.with_columns(wide.fit.dataset.columns(shadow.effect, shadow.shape))
    name = memory.candidates[0].effect.name
    return kept_evidence(given.bases, [block for block in given.named if block.name == name])[name] > steady.strength


def _first_of(families: list[Answer]) -> Answer:
    """The first family with an answer; a curve that no effect follows, unless another family explains it."""
    steady = families[0]
    if steady.verdict == "nothing":
        return next((answer for answer in families if answer.verdict != "nothing"), steady)
    if steady.verdict == "missing":
        chain = families[-1]
        return chain if chain.verdict == "missing" and _explains_more(chain, steady) else steady
    enough = FORMULA_SHARE * steady.strength
    return next((a for a in families[1:] if a.verdict != "nothing" and a.strength >= enough), steady)


def _least_p(screening: Screening) -> dict[str, float]:
    """The least p-value of each effect's shapes, times how many there are."""
    found: dict[str, float] = {}
    for item in screening.evidence:
        p_value = min(1.0, item.block.scanned * item.p_value)
        found[item.block.name] = min(found.get(item.block.name, 1.0), p_value)
    return found


def _explains_more(one: Answer, other: Answer) -> bool:
    """Whether one family's best effect has more evidence, and leaves less, than another's on the same rows."""
    return one.strength > other.strength and one.candidates[0].gain.value > other.candidates[0].gain.value


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
