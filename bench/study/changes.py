"""Add an effect to a model or drop one: refit, keep the child, and say what became of the error."""

from bench.store import Store
from bench.store.records import ModelRow
from bench.study.compare import fitted_parameters
from bench.study.errors import StudyError, lab_errors
from bench.study.keep import gain_of, kept_of, result_of, stored
from bench.study.material import Material, load, model_of
from bench.study.models.base import ROWS_IN_WORDS
from bench.study.models.change import BeforeAfter, BreakawayChange, Changed
from bench.study.models.comparison import FittedParameter
from bench.study.models.stages import CHANGE, FITTING, JUDGING
from compensator.lab import progress
from compensator.lab.at_rest.breakaway_comparison import breakaway_estimates, compare_breakaway, held_out_both
from compensator.lab.diagnosis.confirmation import LEAST_GAIN
from compensator.lab.diagnosis.physical import TOLD, why_impossible
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.fit import fit_effects, widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain, held_out_gain
from compensator.lab.model.held_out_error import HeldOut
from compensator.lab.model.intervals import ParameterEstimate, estimates
from compensator.lab.model.validation import held_out

_ADVICE = {
    "Adding": (
        "It helps: keep it.",
        "It harms: drop it.",
        "The interval includes no change: these trials do not show that it is needed.",
        f"That is no difference that is worth it, being under {LEAST_GAIN:.1%}: leave it out.",
    ),
    "Dropping": (
        "Dropping it helps: the model is better without it.",
        "Dropping it harms: add it again.",
        "The interval includes no change: dropping it does no harm that these trials show.",
        f"That is no difference that matters, being under {LEAST_GAIN:.1%}: the model is as good without it.",
    ),
}
"""What was done -> what to do then, where the error falls for sure, rises for sure, neither, or for sure by nothing."""
_DISAGREE = (
    "The two disagree: the gain, by which a diagnosis judges, speaks {} it, and the error, in which all rows count "
    "alike, does not; `study compare` of both models shows in which trials."
)


@progress.stages(CHANGE)
def add_effect(store: Store, study_id: int, effect: str, model_id: int | None = None) -> Changed:
    """Refit with one more effect and keep the child model.

    Raises:
        StudyError: unknown effect, already in the model, or these trials cannot show it.
    """
    parent = model_of(store, study_id, model_id)
    with lab_errors():
        effect_named(effect)
    if effect in parent.effects:
        raise StudyError(f"model {parent.id} has {effect} already; its effects are: {', '.join(parent.effects)}")
    return _change(store, load(store, study_id), parent, [*parent.effects, effect], "Adding", effect)


@progress.stages(CHANGE)
def drop_effect(store: Store, study_id: int, effect: str, model_id: int | None = None) -> Changed:
    """Refit with one effect less and keep the child model. Arguments and errors as `add_effect`."""
    parent = model_of(store, study_id, model_id)
    if effect not in parent.effects:
        raise StudyError(f"model {parent.id} has no {effect}; its effects are: {', '.join(parent.effects)}")
    effects = [name for name in parent.effects if name != effect]
    return _change(store, load(store, study_id), parent, effects, "Dropping", effect)


def _change(store: Store, material: Material, parent: ModelRow, effects: list[str], done: str, effect: str) -> Changed:
    progress.enter(FITTING)
    old, added = material.fit_of(parent, beside=effects), set(effects) - set(parent.effects)
    with lab_errors():  # from its parent's shapes on, as a diagnosis and a search add it
        fit = fit_effects(old, effects) if added else material.fit(effects)
    # a change is judged on the rows where the changed effect lives; the ladder, on those that the study counts
    changed = [effect_named(name) for name in set(effects) ^ set(parent.effects)]
    rows = material.dataset.choice_for(changed)
    alike = bool((fit.training == old.training).all())
    new = fit if alike else material.fit(effects, fit.shapes, beside=parent.effects)
    progress.enter(JUDGING)
    # as a diagnosis judges them
    before, after = (held_out(one if rows == "sliding" else widened(one, rows), rows) for one in (old, new))
    gain = held_out_gain(before, after)
    starts = held_out_both(old, new) if any(one.breakaway for one in changed) else None
    impossible = next((found for name in added if (found := why_impossible(fit, name).words)), "")
    error = "held-out error" if rows == material.dataset.rows else "held-out error, near reversals too,"
    sentence = _sentence(done, effect, error, before.relative, after.relative, gain, impossible)
    if starts is not None:
        error = "held-out error of the breakaway effort"
        sentence += " " + _sentence(done, effect, error, starts[0].relative, starts[1].relative, held_out_gain(*starts))
    judged = gain_of(rows, before.relative, after.relative, gain)
    result = result_of(fit, held_out(fit)).model_copy(update={"gain": judged})
    model_id = store.add_model(material.study_id, parent.id, effects, stored(result))
    return Changed(
        model_id=model_id,
        parent_id=parent.id,
        effects=effects,
        before=BeforeAfter(training=kept_of(parent).training, held_out=before.relative),
        after=BeforeAfter(training=result.training, held_out=after.relative),
        rows=ROWS_IN_WORDS[rows],
        ladder_before=kept_of(parent).held_out,
        ladder_after=result.held_out,
        ladder_rows=ROWS_IN_WORDS[material.dataset.rows],
        gain=gain.value,
        gain_low=gain.low,
        gain_high=gain.high,
        parameters=_of_added(estimates(fit), added),
        breakaway=None if starts is None else _changed(*starts, _of_added(_at_breakaway(fit), added)),
        sentence=sentence.strip(),
    )


def _at_breakaway(fit: Fit) -> list[ParameterEstimate]:
    compared = compare_breakaway(fit)
    return [] if compared is None else breakaway_estimates(compared.fit)


def _of_added(found: list[ParameterEstimate], added: set[str]) -> list[FittedParameter]:
    return fitted_parameters([one for one in found if one.effect in added])


def _changed(before: HeldOut, after: HeldOut, parameters: list[FittedParameter]) -> BreakawayChange:
    gain = held_out_gain(before, after)
    return BreakawayChange(
        held_out_before=before.relative,
        held_out_after=after.relative,
        gain=gain.value,
        gain_low=gain.low,
        gain_high=gain.high,
        parameters=parameters,
    )


def _sentence(done: str, effect: str, error: str, before: float, after: float, gain: Gain, impossible: str = "") -> str:
    helps, harms, neither, slight = _ADVICE[done]
    advice = helps if gain.low > 0.0 else harms if gain.high < 0.0 else neither
    small = max(map(abs, (gain.low, gain.high))) < LEAST_GAIN
    if small or (advice != neither and abs(gain.value) < LEAST_GAIN):
        advice = slight
    elif advice != neither and gain.is_against(before, after):
        advice = _DISAGREE.format("for" if advice == helps else "against")
    if impossible == TOLD:
        advice = f"It is {TOLD}, and no find; {advice[0].lower()}{advice[1:]}"
    elif impossible:
        advice = f"But {impossible}: leave it out."
    told = gain.in_words(before, after)
    return f"{done} {effect} changes the {error} from {before:.2%} to {after:.2%} ({told}). {advice}"
