"""What to record next: trials that would separate the rivals of a diagnosis."""

from collections.abc import Collection, Sequence

from bench.calibration import with_friction
from bench.config.configuration import BenchConfiguration
from bench.control.drive_factory import is_simulated
from bench.store import Experiment, Store
from bench.store.records import ModelRow
from bench.study.diagnosis.judged import diagnosis_of_model
from bench.study.errors import StudyError, lab_errors
from bench.study.joint import joint_of
from bench.study.material import Material, facts_of, load_model
from bench.study.models.stages import DIAGNOSING, FITTING, SUGGESTION
from bench.study.models.study import note_for
from bench.study.selection import Criterion
from bench.study.suggestion.earlier_trials import kept_out, without
from bench.study.suggestion.options import Choice, choices
from bench.study.suggestion.predict import choose
from bench.study.suggestion.since import Judged, fallen
from bench.study.suggestion.suggested import KeptOut, PairOfRivals, Suggested, SuggestedTrial
from compensator.lab import progress
from compensator.lab.diagnosis.diagnosis import Diagnosis
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.next_trial.confounded import several, shows_from_rest
from compensator.lab.next_trial.suggestion import Pick, Suggestion

MOST_TRIALS = 6


@progress.stages(SUGGESTION)
def suggest(
    store: Store,
    study_id: int,
    configuration: BenchConfiguration,
    model_id: int | None = None,
    trials: int = MOST_TRIALS,
    refused: Collection[str] = (),
    since_before: bool = True,
) -> Suggested:
    """The trials that would raise the smallest d' of the leading rivals most, per minute of bench time.

    Every trial that the bench can run inside its limits is run on the joint of the fitted model first. What was
    suggested before, and tripped or failed on the joint itself, is kept out, and named. A simulated joint repeats a
    trial to the bit: what the study has of it already is not suggested again.

    Args:
        store: with the study.
        study_id: which study.
        configuration: of the bench.
        model_id: the model; None: the newest.
        trials: how many are suggested at most.
        refused: names of trials that are not suggested.
        since_before: say where the trials that the study was extended by brought less than there seemed to be before.

    Raises:
        StudyError: no such model, a study of another rig, data that are wrong themselves, or what a trial would show
            cannot be computed.
    """
    material, model = load_model(store, study_id, model_id)
    if joint_of(store, material.definition) == "nowhere":
        raise StudyError(
            f"study {study_id} is of a challenge: its joint was drawn at random and recorded once, and no trial of it "
            "can be recorded again. Guess by what these recordings tell"
        )
    if facts_of(configuration.rig) != material.definition.facts:
        raise StudyError(
            f"study {study_id} is of another rig than this bench, '{configuration.rig.name}'. Name the configuration "
            "of its bench with --config. Where you have none, record what this says under 'What would help': "
            f"friction-bench study coverage {study_id}"
        )
    configuration = with_friction(store, configuration)
    progress.enter(FITTING)
    fit = material.fit_of(model)
    progress.enter(DIAGNOSING)
    diagnosis = diagnosis_of_model(material, model, fit)
    with lab_errors():
        if diagnosis.verdict == "data-problem":
            raise StudyError(f"{diagnosis.sentence} Mend it before more is recorded")
        repeats = is_simulated(configuration)
        possible = choices(configuration, not repeats, shows_from_rest(diagnosis))
        impossible = kept_out(store, study_id)
        told = [*impossible, *(_recorded(store, material) if repeats else ())]
        possible = [one for one in without(_fitted_ones(material, possible), told) if one.name not in refused]
        told_of_before = _fallen(store, study_id, model, (fit, diagnosis)) if since_before else ""
        found, chosen = choose(fit, diagnosis, configuration, possible, trials, once=repeats)
    return Suggested(
        study_id=study_id,
        model_id=model.id,
        verdict=diagnosis.verdict,
        diagnosis=diagnosis.sentence,
        sentence=" ".join(filter(None, (told_of_before, _sentence(found, diagnosis)))),
        minutes=sum(pick.minutes for pick in found.picks),
        note=note_for(study_id),
        pairs=[] if diagnosis.too_short else list(map(PairOfRivals.model_validate, found.pairs)),
        hopeless=list(map(PairOfRivals.model_validate, found.hopeless)),
        kept_out=[_kept_out(one) for one in impossible],
        trials=[_pick(pick, choice, found, material) for pick, choice in zip(found.picks, chosen, strict=True)],
    )


def _fallen(store: Store, study_id: int, model: ModelRow, now: Judged) -> str:
    """As `fallen`; empty where the model did not come of an extension: its parent has other effects, or is none."""
    number = model.parent_id
    if number is None or store.model(number).effects != model.effects:
        return ""

    def before() -> Judged:
        material, parent = load_model(store, study_id, number)
        fit = material.fit_of(parent)
        return fit, diagnosis_of_model(material, parent, fit)

    return fallen(before, now)


def _recorded(store: Store, material: Material) -> list[Experiment]:
    """Experiments that the study has trials of."""
    return [store.experiment(number) for number in dict.fromkeys(trial.experiment_id for trial in material.trials)]


def _fitted_ones(material: Material, possible: Sequence[Choice]) -> list[Choice]:
    """Those whose trials the study would fit, not hold out."""
    criteria = [Criterion.parse(text) for text in material.definition.hold_out]
    return [
        choice
        for choice in possible
        if not any(
            criterion.holds({"trial": plan.name, "kind": choice.kind, **plan.conditions})
            for criterion in criteria
            for plan in choice.plans
        )
    ]


def _kept_out(one: Experiment) -> KeptOut:
    return KeptOut(experiment_id=one.id, kind=one.kind, outcome=one.outcome, reason=one.reason)


def _pick(pick: Pick, choice: Choice, found: Suggestion, material: Material) -> SuggestedTrial:
    unit = material.dataset.effort_definition.unit
    return SuggestedTrial(
        name=choice.name,
        kind=choice.kind,
        parameters=choice.parameters,
        minutes=pick.minutes,
        before=pick.before,
        after=pick.after,
        sentence=(
            f"It tells {_names(*pick.pair, ' from ')}: they differ by {pick.difference:.3g} {unit} there, and the "
            f"noise is {found.noise:.3g} {unit}."
        ),
    )


def _names(true: str, rival: str | None, between: str = " and ") -> str:
    other = "no effect" if rival is None else effect_named(rival).in_sentence
    return f"{effect_named(true).in_sentence}{between}{other}"


def _sentence(found: Suggestion, diagnosis: Diagnosis) -> str:
    if not found.pairs:
        if not found.hopeless:
            return "No further trial is needed: nothing else could be what is named."
        return "No trial that this bench can run tells the rivals apart. " + _hopeless(found)
    before, after = min(pair.before for pair in found.pairs), min(pair.after for pair in found.pairs)
    if not found.picks:
        return f"No further trial is needed, or helps: the smallest predicted d' is {before:.1f}. " + _hopeless(found)
    minutes, count = sum(pick.minutes for pick in found.picks), len(found.picks)
    record = f"Record {'this trial' if count == 1 else f'these {count} trials'} ({minutes:.2g} min)"
    if diagnosis.too_short:
        return f"{record}, and diagnose again: there the joint moves as it has not moved yet."
    named = diagnosis.verdict == "missing" and not several(diagnosis)
    return (
        f"{record}. {'What is named gets surer. ' * named}The smallest d' between two names rises from "
        f"{before:.1f} to {after:.1f}: that is predicted. From about 6 on a name is sure. {_promise(found)} "
        + _condition(found, diagnosis)
        + _hopeless(found)
    ).strip()


def _promise(found: Suggestion) -> str:
    """What of the prediction holds for nine in ten of the sizes that the rivals may have."""
    least = min(pair.promised for pair in found.pairs)
    if least > 0.0:
        return f"It rises to at least {least:.1f} in nine of ten cases."
    return "That is no promise: what speaks for these names may be chance."


def _condition(found: Suggestion, diagnosis: Diagnosis) -> str:
    """What the prediction holds for, where nothing is sure to be missing: sizes that may be noise."""
    if diagnosis.verdict == "missing":
        return ""
    rivals = [effect_named(name).in_sentence for name in dict.fromkeys(pair.true for pair in found.pairs)]
    one_of = rivals[0] if len(rivals) == 1 else f"one of {', '.join(rivals[:-1])} and {rivals[-1]}"
    return f"It supposes that {one_of} is missing, and as large as it seems. If not, the trials show that. "


def _hopeless(found: Suggestion) -> str:
    pairs: dict[frozenset[str | None], str] = {}  # once, whichever of the two is taken for the truth
    for pair in found.hopeless:
        pairs.setdefault(frozenset((pair.true, pair.rival)), _names(pair.true, pair.rival))
    return f"Not told apart by any trial of this bench: {'; '.join(pairs.values())}." if pairs else ""
