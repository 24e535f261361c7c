"""Which effect is missing: screen the catalogue, name the best, find its rivals, and measure the gain on held-out rows.

Three questions, three statistics (docs/diagnosis.md): is anything missing (maximum over all candidates of a robust
score, its null by sign flips of whole stretches), what is it called (likelihood less the price of parameters and
shapes), does it help (held-out error, resampled by whole trials).
"""

from dataclasses import dataclass

import numpy as np

from compensator.lab.candidates import Candidates, gather
from compensator.lab.catalogue import candidates, effect_named
from compensator.lab.data_checks import data_problems
from compensator.lab.diagnosis import Candidate, Diagnosis, Verdict
from compensator.lab.drivers import DRIVERS
from compensator.lab.effects.effect import EffectRows
from compensator.lab.errors import UnusableDataError
from compensator.lab.evidence import Evidence, Screening, screen
from compensator.lab.examination import SIGNIFICANT, examine, is_confirmed
from compensator.lab.fit import Fit, fit_model, with_columns
from compensator.lab.gain import held_out_gain
from compensator.lab.regimes import Regime
from compensator.lab.validation import held_out
from compensator.lab.wording import answer_in_words

FEWEST_REVERSAL_ROWS = 40
EXAMINED = 6  # candidates that are refitted and drawn
FORMULA_SHARE = 0.6  # of a free curve's evidence: a formula that reaches less is not the right one


def diagnose(fit: Fit) -> Diagnosis:
    """Diagnose a fitted model on its training rows.

    Three families are judged one after the other: effects of the joint that show in steady sliding; effects with
    memory, which live near reversals and starts; effects of the measuring chain. The first that has something missing
    is the answer, the others are notes: while something large is missing, the smaller may be its shadow.

    Raises:
        UnusableDataError: no candidate can be judged on these trials.
    """
    gathered = gather(fit)
    stretch = fit.dataset.block_index[gathered.rows]
    physical = [block for block in gathered.named if not effect_named(block.name).pipeline]
    pipeline = [block for block in gathered.named if effect_named(block.name).pipeline]
    if not physical:
        raise UnusableDataError(
            "no effect of the catalogue can be judged on these trials; record " + "; ".join(gathered.left_out.values())
        )
    generic = screen(gathered.bases, gathered.generic, stretch)
    steady = _answer(fit, gathered, screen(gathered.bases, physical, stretch), generic)
    chain = _answer(fit, gathered, screen(gathered.bases, pipeline, stretch), None)
    memory, not_judged = _memory(fit)
    families = [steady, *([memory] if memory else []), chain]
    first = next((answer for answer in families if answer.verdict != "nothing"), steady)
    others = [answer for answer in families if answer is not first]
    ranked = [candidate for answer in (first, *others) for candidate in answer.candidates]
    notes = [answer.sentence for answer in others if answer.verdict == "missing"]
    return Diagnosis(
        verdict=first.verdict,
        sentence=first.sentence,
        p_value=first.p_value,
        classes=_classes(ranked),
        candidates=ranked,
        driver=first.driver,
        data_problems=data_problems(fit),
        notes=[*first.notes, *notes],
        left_out={**gathered.left_out, **not_judged},
    )


def best_named(fit: Fit, show_in: EffectRows) -> str | None:
    """The effect of one family that the rows speak for most, by score alone; None where none can be judged."""
    gathered = gather(fit, show_in)
    blocks = [block for block in gathered.named if not effect_named(block.name).pipeline]
    screening = screen(gathered.bases, blocks, fit.dataset.block_index[gathered.rows])
    return screening.evidence[0].block.name if screening.evidence else None


def _memory(fit: Fit) -> tuple["_Answer | None", dict[str, str]]:
    """The family of effects with memory, on all rows in motion; None, and why, where these hold no reversals."""
    dataset = fit.dataset
    trained = np.isin(dataset.trial_index, np.unique(dataset.trial_index[fit.training]))
    moving = trained & dataset.in_regimes("moving")
    near_reversals = int((moving & (dataset.regime == Regime.TRANSIENT)).sum())
    wanted = [effect for effect in candidates(fit.names, dataset.facts) if effect.rows == "moving"]
    if near_reversals < FEWEST_REVERSAL_ROWS:
        why = f"needs reversals and starts: {near_reversals} rows lie near one, wanted {FEWEST_REVERSAL_ROWS}; record "
        return None, {effect.name: f"{effect.name} {why}{effect.excited_by}" for effect in wanted}
    wide = fit_model(dataset, fit.names, moving, fit.shapes)
    gathered = gather(wide, "moving")
    screening = screen(gathered.bases, gathered.named, dataset.block_index[gathered.rows])
    return _answer(wide, gathered, screening, None), gathered.left_out


@dataclass(frozen=True)
class _Answer:
    """What one family of effects has to say."""

    verdict: Verdict
    sentence: str
    p_value: float
    candidates: list[Candidate]
    driver: str | None
    notes: list[str]


def _answer(fit: Fit, gathered: Candidates, named: Screening, generic: Screening | None) -> _Answer:
    best_of_each = _best_shapes(named)
    if not best_of_each:
        return _Answer("nothing", answer_in_words("nothing", 1.0, [], None), 1.0, [], None, [])
    examined = examine(fit, gathered, best_of_each[:EXAMINED])
    best = next(item for item in best_of_each if item.block.name == examined[0].effect.name)
    verdict, driver = _verdict(fit, gathered, named, generic, best, examined[0])
    p_value = generic.p_value if generic is not None and verdict == "unknown-effect" else named.p_value
    sentence = answer_in_words(verdict, p_value, examined, driver)
    return _Answer(verdict, sentence, p_value, examined, driver, _notes(gathered, best, verdict))


def _best_shapes(screening: Screening) -> list[Evidence]:
    """The best shape of every effect, best effect first."""
    found: dict[str, Evidence] = {}
    for evidence in screening.evidence:
        found.setdefault(evidence.block.name, evidence)
    return list(found.values())


def _verdict(
    fit: Fit, gathered: Candidates, named: Screening, generic: Screening | None, best: Evidence, candidate: Candidate
) -> tuple[Verdict, str | None]:
    curve = _curve(fit, gathered, generic)
    followed = candidate.physical and curve is not None and best.noncentrality >= FORMULA_SHARE * curve.noncentrality
    if curve is not None and not followed:
        return "unknown-effect", curve.block.name
    formula_found = named.p_value <= SIGNIFICANT and is_confirmed(candidate)
    return ("missing", None) if formula_found else ("nothing", None)


def _curve(fit: Fit, gathered: Candidates, generic: Screening | None) -> Evidence | None:
    """The free curve with the best evidence, if the evidence is no luck and the curve lowers the held-out error."""
    if generic is None or generic.p_value > SIGNIFICANT or not generic.evidence:
        return None
    best = generic.evidence[0]
    if best.score <= 0.0 or best.p_value > SIGNIFICANT:
        return None
    with_curve = with_columns(fit, best.block.name, gathered.splines[best.block.name].columns)
    return best if held_out_gain(held_out(fit), held_out(with_curve)).low > 0.0 else None


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


def _notes(gathered: Candidates, best: Evidence, verdict: Verdict) -> list[str]:
    """What remains once the best effect is in the model."""
    if verdict != "missing":
        return []
    left = gathered.with_block(best.block)
    rest = screen(left.bases, left.generic, gathered.fit.dataset.block_index[gathered.rows])
    if rest.evidence and rest.p_value <= SIGNIFICANT and rest.evidence[0].score > 0.0:
        name = rest.evidence[0].block.name
        driver = DRIVERS[name.removesuffix(" against motion")]
        how = " against the motion" if name.endswith("against motion") else ""
        return [f"After {best.block.name}, structure over {driver.title}{how} remains; add it and diagnose again."]
    return []
