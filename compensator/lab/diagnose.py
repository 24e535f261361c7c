"""Which effect is missing: screen the catalogue, name the best, find its rivals, and measure the gain on held-out rows.

Three questions, three statistics (docs/diagnosis.md): is anything missing (maximum over all candidates of a robust
score, its null by sign flips of whole stretches), what is it called (likelihood less the price of parameters and
shapes), does it help (held-out error, resampled by whole trials).
"""

from dataclasses import dataclass

import numpy as np

from compensator.lab.candidates import Candidates, gather
from compensator.lab.catalogue import effect_named
from compensator.lab.data_checks import data_problems
from compensator.lab.diagnosis import Candidate, Diagnosis, Verdict
from compensator.lab.drivers import DRIVERS
from compensator.lab.effects.effect import Shape
from compensator.lab.errors import UnusableDataError
from compensator.lab.evidence import Evidence, Screening, screen
from compensator.lab.fit import Fit, fit_model
from compensator.lab.gain import chance_not_worse, held_out_gain
from compensator.lab.pictures import picture_of
from compensator.lab.validation import HeldOut, held_out

SIGNIFICANT = 0.01
EXAMINED = 6  # candidates that are refitted and drawn
EXPLAINED_BY_RIVAL = 0.5  # share of its evidence that a rival loses once the best effect is in the model
NOT_WORSE = 0.10  # one-sided
FORMULA_SHARE = 0.6  # of a free curve's evidence: a formula that reaches less is not the right one


def diagnose(fit: Fit) -> Diagnosis:
    """Diagnose a fitted model on its training rows.

    Effects of the joint are judged first. Effects of the measuring chain are named only where no effect of the joint
    is, and are a note otherwise: every other effect is judged with their columns already in the base.

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
    answer = _answer(fit, gathered, screen(gathered.bases, physical, stretch), generic)
    chain = _answer(fit, gathered, screen(gathered.bases, pipeline, stretch), None)
    first, second = (chain, answer) if answer.verdict == "nothing" and chain.verdict == "missing" else (answer, chain)
    candidates = [*first.candidates, *second.candidates]
    notes = [second.sentence] if second is chain and chain.verdict == "missing" else []
    return Diagnosis(
        verdict=first.verdict,
        sentence=first.sentence,
        p_value=first.p_value,
        classes=_classes(candidates),
        candidates=candidates,
        driver=first.driver,
        data_problems=data_problems(fit),
        notes=[*first.notes, *notes],
        left_out=gathered.left_out,
    )


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
        return _Answer("nothing", "", 1.0, [], None, [])
    candidates = _examine(fit, gathered, best_of_each[:EXAMINED])
    best = next(item for item in best_of_each if item.block.name == candidates[0].effect.name)
    verdict, driver = _verdict(named, generic, best, candidates[0])
    sentence = _sentence(verdict, named.p_value, candidates, driver)
    return _Answer(verdict, sentence, named.p_value, candidates, driver, _notes(gathered, best, verdict))


def _best_shapes(screening: Screening) -> list[Evidence]:
    """The best shape of every effect, best effect first."""
    found: dict[str, Evidence] = {}
    for evidence in screening.evidence:
        found.setdefault(evidence.block.name, evidence)
    return list(found.values())


def _verdict(
    named: Screening, generic: Screening | None, best: Evidence, candidate: Candidate
) -> tuple[Verdict, str | None]:
    curve = generic.evidence[0] if generic is not None and generic.evidence else None
    formula_found = named.p_value <= SIGNIFICANT and _confirmed(candidate)
    curve_found = generic is not None and generic.p_value <= SIGNIFICANT
    if (
        curve is not None
        and curve_found
        and curve.score > 0.0
        and best.noncentrality < FORMULA_SHARE * curve.noncentrality
    ):
        return "unknown-effect", curve.block.name
    return ("missing", None) if formula_found else ("nothing", None)


def _examine(fit: Fit, gathered: Candidates, evidence: list[Evidence]) -> list[Candidate]:
    before = held_out(fit)
    afters = [held_out(_with_effect(fit, item)) for item in evidence]
    given = [_evidence_given(gathered, item) for item in evidence]
    candidates = [
        _candidate(gathered, item, (before, after), _rivals(index, evidence, afters, given[index]))
        for index, (item, after) in enumerate(zip(evidence, afters, strict=True))
    ]
    return sorted(candidates, key=lambda candidate: not _confirmed(candidate))  # stable: by score within each kind


def _confirmed(candidate: Candidate) -> bool:
    """Whether the evidence pays for its parameters, and neither it nor the gain on held-out rows is luck."""
    return candidate.score > 0.0 and candidate.p_value <= SIGNIFICANT and candidate.gain.low > 0.0


def _with_effect(fit: Fit, item: Evidence) -> Fit:
    """The model and one more effect, refitted at the shapes already found."""
    shapes = {**fit.shapes, item.block.name: _shape(item)}
    return fit_model(fit.dataset, [*fit.names, item.block.name], fit.training, shapes)


def _shape(item: Evidence) -> Shape:
    return item.block.key if isinstance(item.block.key, tuple) else ()


def _evidence_given(gathered: Candidates, item: Evidence) -> dict[str, float]:
    """Evidence that every effect keeps once this one is in the model."""
    left = screen(
        gathered.with_block(item.block).bases, gathered.named, gathered.fit.dataset.block_index[gathered.rows]
    )
    kept: dict[str, float] = {}
    for evidence in left.evidence:
        kept[evidence.block.name] = max(kept.get(evidence.block.name, 0.0), evidence.noncentrality)
    return kept


def _rivals(index: int, evidence: list[Evidence], afters: list[HeldOut], left: dict[str, float]) -> dict[str, float]:
    """Rivals of one candidate, with the correlation of their contributions."""
    own = evidence[index]
    found = {}
    for other, after in zip(evidence, afters, strict=True):
        explained = left.get(other.block.name, 0.0) < EXPLAINED_BY_RIVAL * other.noncentrality
        if other is not own and explained and chance_not_worse(after, afters[index]) > NOT_WORSE:
            found[other.block.name] = abs(float(own.direction @ other.direction))
    return found


def _candidate(
    gathered: Candidates, item: Evidence, errors: tuple[HeldOut, HeldOut], rivals: dict[str, float]
) -> Candidate:
    before, after = errors
    nearest = max(rivals.values(), default=0.0)
    return Candidate(
        effect=effect_named(item.block.name),
        shape=_shape(item),
        score=item.score,
        p_value=item.p_value,
        detectability=float(np.sqrt(item.noncentrality * max(0.0, 1.0 - nearest**2))),
        rivals=tuple(sorted(rivals)),
        before=before.relative,
        after=after.relative,
        gain=held_out_gain(before, after),
        physical=_physical(gathered, item),
        picture=picture_of(gathered, item),
    )


def _physical(gathered: Candidates, item: Evidence) -> bool:
    """Whether the freely fitted coefficients lie within the effect's bounds."""
    base = gathered.bases[item.block.base]
    columns = item.block.columns - base.basis @ (base.basis.T @ item.block.columns)
    coefficients = np.linalg.lstsq(columns, base.residual, rcond=1e-6)[0]
    parameters = effect_named(item.block.name).parameters
    return all(p.low <= c <= p.high for p, c in zip(parameters, coefficients, strict=True))


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


def _sentence(verdict: Verdict, p_value: float, candidates: list[Candidate], driver: str | None) -> str:
    if verdict == "nothing":
        return _nothing(p_value)
    best = candidates[0]
    if verdict == "unknown-effect":
        return (
            f"Something is missing, and it is none of the catalogue: it varies with {driver}; the nearest formula, "
            f"{best.effect.title.lower()}, does not follow its curve (p = {p_value:.3g})."
        )
    title = best.effect.title
    also = f"; these trials cannot tell it from {', '.join(best.rivals)}" if best.rivals else ""
    sign = "" if best.physical else "; the sign found is not physical for it, so the shape fits, the name may not"
    return (
        f"{title} is missing{also}{sign}: adding it changes the held-out error from {best.before:.2%} to "
        f"{best.after:.2%} (gain {best.gain.value:.0%}, 90 % interval {best.gain.low:.0%} .. {best.gain.high:.0%}; "
        f"p = {p_value:.3g})."
    )


def _nothing(p_value: float) -> str:
    if p_value > SIGNIFICANT:
        return f"Nothing is missing that these trials can show (p = {p_value:.3g}; {SIGNIFICANT:g} or less would tell)."
    return (
        f"No effect of the catalogue is confirmed: the residual is not mere noise (p = {p_value:.3g}), but none lowers "
        "the held-out error for sure."
    )


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
