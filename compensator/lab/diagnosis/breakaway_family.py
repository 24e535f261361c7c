"""What breakaway events have to say: which effect is missing in the effort of breaking away from rest."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from compensator.lab.at_rest.breakaway_regression import (
    LAG,
    BreakawayFit,
    fit_breakaway,
    held_out_breakaway,
    lag_column,
)
from compensator.lab.at_rest.breakaway_rows import BreakawayRows, shares_of
from compensator.lab.chance import SIGNIFICANT, chance_in_words
from compensator.lab.diagnosis.answer import EXAMINED, Answer
from compensator.lab.diagnosis.confirmation import is_confirmed
from compensator.lab.diagnosis.diagnosis import Candidate, Verdict
from compensator.lab.diagnosis.examination import best_shapes, detectability, explains
from compensator.lab.diagnosis.note import Note
from compensator.lab.diagnosis.pictures import picture_of_breakaway
from compensator.lab.diagnosis.wording import named_in_words
from compensator.lab.effects.catalogue import candidates, effect_named
from compensator.lab.effects.effect import Effect
from compensator.lab.errors import EffectFailedError, NotApplicableError
from compensator.lab.model.fit import fit_effects
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import held_out_gain, predicts_better
from compensator.lab.model.held_out_error import HeldOut
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.evidence import (
    Evidence,
    among_all,
    independent_rows,
    kept_evidence,
    least_p_value,
    screen_events,
)

SPREAD = 3.0  # longest over shortest rest, or quickest over slowest rate, that shows an effect of it
WITH_LAG, WITHOUT_LAG = 0, 1  # bases that effects are judged on top of
TINY = float(np.finfo(float).tiny)
RANGES = {"rest": "rests", "start_rate": "rates of the effort"}


@dataclass(frozen=True)
class _Judged:
    effect: Effect
    item: Evidence
    after: HeldOut
    fit: BreakawayFit


def breakaway_answer(
    fit: Fit, rows: BreakawayRows, sliding: Mapping[str, float] | None = None
) -> tuple[Answer, dict[str, str]]:
    """Judge the family on breakaway events; beside the answer, why effects cannot be judged.

    Args:
        fit: of the model.
        rows: its starts from rest.
        sliding: p-value in steady sliding of every effect that shows there. A joint whose friction depends on load or
            warmth shows that a hundred times in sliding for once in a start: where sliding says no, starts are not
            enough to name it.
    """
    base = fit_breakaway(rows, fit.effects)
    blocks, bases, left_out = breakaway_blocks(base, candidates(fit.names, fit.dataset.facts))
    unit = rows.unit[rows.training]
    lag = base.coefficients_of(LAG)
    late = lag is not None and bool(lag[0] > 0.0)  # no start is seen before it happens
    screening = screen_events(bases, blocks, unit, model=WITH_LAG if late else WITHOUT_LAG)
    evidence = screening.evidence if late else _over_one_model(base, bases, screening.evidence)
    judged = _judge(base, evidence)
    if not judged:
        return Answer("nothing", "", 1.0, [], None, []), left_out
    before = held_out_breakaway(base)
    ranked = sorted(
        (held_against(_candidate(one, before, judged, bases, blocks), sliding) for one in judged),
        key=lambda one: not is_confirmed(one),
    )
    p_value, found = ranked[0].p_value, is_confirmed(ranked[0])
    stretches = len(np.unique(unit))
    sentence = _sentence(ranked[0], p_value, int(rows.training.sum()), stretches) if found else ""
    notes = [] if found else _too_few(stretches)
    verdict: Verdict = "missing" if found else "nothing"
    if found:
        ranked[0] = replace(ranked[0], explained=fit_effects(fit, [*fit.names, ranked[0].effect.name]))
    return Answer(verdict, sentence, p_value, ranked, None, notes), left_out


def breakaway_blocks(base: BreakawayFit, wanted: Sequence[Effect]) -> tuple[list[Block], list[Base], dict[str, str]]:
    """Candidates' columns on the training rows, the two bases, and why effects cannot be judged.

    The first base has the column of the late onset, the second has not.

    Args:
        base: fit of the model's own shares; rows count by its weights.
        wanted: effects; those with a share in breakaway are judged.
    """
    rows = base.rows
    inside, weight = rows.training, base.weight[rows.training]
    model = base.columns[:, :-1]
    effort = weight * rows.free[inside]
    with_lag = np.column_stack([model, lag_column(rows)])
    bases = [Base.of(weight[:, None] * columns[inside], effort) for columns in (with_lag, model)]
    blocks, left_out = [], {}
    for effect, share in shares_of(wanted):
        try:
            rows.fit.dataset.check_applicable(effect)
        except NotApplicableError as reason:
            left_out[effect.name] = str(reason)
            continue
        values = rows.driver(share.driver)
        if share.driver in RANGES and values is not None and values.max() < SPREAD * values.min():
            left_out[effect.name] = (
                f"{effect.name} needs {RANGES[share.driver]} that differ, and all are within {values.min():.2g} .. "
                f"{values.max():.2g}; record {effect.excited_by}"
            )
            continue
        try:
            shapes = rows.shapes(share)
            made = [(shape, rows.columns(share, shape)) for shape in shapes]
        except EffectFailedError as reason:
            left_out[effect.name] = str(reason)
            continue
        for shape, columns in made:
            if np.isfinite(columns).all():
                weighted = weight[:, None] * columns[inside]
                blocks.append(
                    Block(effect.name, weighted, WITHOUT_LAG if share.replaces_lag else WITH_LAG, len(shapes), shape)
                )
    return blocks, bases, left_out


def held_against(candidate: Candidate, sliding: Mapping[str, float] | None) -> Candidate:
    """The candidate, refused where steady sliding speaks against an effect that shows there, too, and by no start."""
    share = candidate.effect.breakaway
    if sliding is None or candidate.effect.rows != "sliding" or (share is not None and share.driver in RANGES):
        return candidate
    shown = sliding.get(candidate.effect.name, 1.0) <= SIGNIFICANT
    return candidate if shown else replace(candidate, refused="steady sliding does not show it")


def _over_one_model(base: BreakawayFit, bases: list[Base], evidence: list[Evidence]) -> list[Evidence]:
    """The evidence by scores over the same model, where that has no late onset: best score first.

    An onset would have to be early in it, and so is left out. Beside an effect it may be late after all: what it
    explains then comes with the effect, and is no less to its credit than what an effect in its place explains.
    """
    inside = base.rows.training
    lag = base.weight[inside] * lag_column(base.rows)[inside, 0]
    left = [float(one.residual @ one.residual) for one in bases]
    rows = min(independent_rows(one.residual) for one in bases)
    gained = rows * float(np.log(max(left[WITHOUT_LAG], TINY) / max(left[WITH_LAG], TINY))) - float(np.log(rows))
    found = []
    for item in evidence:
        late = float(lag @ bases[WITHOUT_LAG].extended(item.block.columns).residual) > 0.0
        more = gained if late and item.block.base == WITH_LAG else 0.0
        found.append(replace(item, score=item.score + more))
    return sorted(found, key=lambda item: -item.score)


def _judge(base: BreakawayFit, evidence: list[Evidence]) -> list[_Judged]:
    """The best shape of every effect, best effect first, refitted."""
    shapes = {share.name: share.shape for share in base.shares}
    judged = []
    for item in best_shapes(evidence)[:EXAMINED]:
        effect = effect_named(item.block.name)
        fit = fit_breakaway(base.rows, [*base.rows.fit.effects, effect], {**shapes, effect.name: item.block.shape})
        judged.append(_Judged(effect, item, held_out_breakaway(fit, base.weight), fit))
    return judged


def _candidate(
    one: _Judged, before: HeldOut, judged: list[_Judged], bases: list[Base], blocks: list[Block]
) -> Candidate:
    left = kept_evidence([given.extended(one.item.block.columns) for given in bases], blocks)
    rivals = {
        other.effect.name: abs(float(one.item.direction @ other.item.direction))
        for other in judged
        if other is not one and explains(left, other.item) and not predicts_better(one.after, other.after)
    }
    nearest = max(rivals.values(), default=0.0)
    coefficients = one.fit.coefficients_of(one.effect.name)
    explains_some = coefficients is not None and bool(np.any(coefficients != 0.0))
    return Candidate(
        effect=one.effect,
        shape=one.item.block.shape,
        score=one.item.score,
        p_value=among_all(one.item.p_value),
        detectability=detectability(one.item, nearest),
        rivals=tuple(sorted(rivals)),
        before=before.relative,
        after=one.after.relative,
        gain=held_out_gain(before, one.after),
        impossible="" if explains_some else "within its bounds it explains nothing of a start",
        picture=picture_of_breakaway(one.fit, one.effect),
        rows="breakaway",
    )


def _sentence(best: Candidate, p_value: float, starts: int, units: int) -> str:
    return (
        f"{named_in_words(best, 'starts')}: over {starts} starts from rest ({units} of them independent), adding "
        f"it changes the held-out error of the breakaway effort from {best.before:.2%} to {best.after:.2%} "
        f"({best.gain.in_words(best.before, best.after)}; {chance_in_words(p_value)})."
    )


def _too_few(units: int) -> list[Note]:
    least = least_p_value(units)
    if least <= SIGNIFICANT:
        return []
    text = (
        f"Breakaway: only {units} independent starts: at best p = {least:.2g}, and {SIGNIFICANT:g} is needed; record "
        "breakaway ramps, at three rates and after three rests."
    )
    return [Note("too-few-starts", text, {"starts": units, "least_p_value": least})]
