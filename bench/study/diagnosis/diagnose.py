"""What is missing from a model, for the page, the command line and reports."""

from math import inf, isfinite

from bench.store import Store
from bench.store.records import ModelRow
from bench.study.diagnosis.findings import conclusion_of, findings_of, findings_of_trials
from bench.study.diagnosis.judged import diagnosis_of_model
from bench.study.joint import joint_of
from bench.study.keep import kept_of
from bench.study.material import load_model
from bench.study.models.diagnosis import Diagnosis, EffectClass, Joint, Picture, ProvisionalTerm, Ranked
from compensator.lab.chance import chance_in_words, stated
from compensator.lab.diagnosis import diagnosis
from compensator.lab.diagnosis.confirmation import LUCK, doubts, explained_part, slight_one
from compensator.lab.diagnosis.unfollowed import Provisional, provisional
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import shown
from compensator.lab.model.validation import held_out
from compensator.lab.rows.dataset import Dataset
from compensator.lab.rows.drivers import DRIVERS


def diagnose(store: Store, study_id: int, model_id: int | None = None) -> Diagnosis:
    """Rank the effects that a model may be missing.

    Raises:
        StudyError: no such model, or no effect can be judged on these trials.
    """
    material, model = load_model(store, study_id, model_id)
    fit = material.fit_of(model)
    found, joint = diagnosis_of_model(material, model, fit), joint_of(store, material.definition)
    return answer_of(fit, found, study_id, model.id, explained_by(store, model), joint)


def answer_of(
    fit: Fit, found: diagnosis.Diagnosis, study_id: int, model_id: int, explained: float = 0.0, joint: Joint = "here"
) -> Diagnosis:
    """What a model of a study may be missing, given its fit and diagnosis.

    Args:
        fit: of the model.
        found: its diagnosis.
        study_id: of the answer.
        model_id: of the answer.
        explained: by effects that were added to the first model, root mean square as a share of the effort, held out.
        joint: where it is.
    """
    named = set(found.classes[0]) if found.verdict == "missing" and found.classes else set()
    findings = [*findings_of_trials(fit, joint), *findings_of(found)]
    advice = _advice(found, explained)
    curve = provisional(fit, found)
    first = curve.effect.name if curve is not None else next(iter(found.classes[0]), "") if named else ""
    return Diagnosis(
        study_id=study_id,
        model_id=model_id,
        verdict=found.verdict,
        sentence=found.sentence,
        p_value=stated(found.p_value),
        notes=[one.text for one in findings if one.code != "data-problem"],
        data_problems=found.data_problems,
        classes=[
            _class(members, _has_hidden_rival(members, fit, found), joint) for members in found.classes[:1] if named
        ],
        held_out_kind=held_out(fit).kind,
        ranking=[] if found.too_short else _ranking(fit.dataset, found, named, first),
        slight=bool(advice),
        advice=advice,
        provisional=None if curve is None else _provisional(fit.dataset, curve),
        conclusion=conclusion_of(found),
        findings=findings,
        joint=joint,
    )


def explained_by(store: Store, model: ModelRow) -> float:
    """What the effects explain that a study's first model had not: see `answer_of`."""
    return explained_part(outset_of(store, model), kept_of(model).held_out)


def outset_of(store: Store, model: ModelRow) -> float:
    """Held-out error of the first model of the lineage, relative, 0..1."""
    return kept_of(root_of(store, model)).held_out


def root_of(store: Store, model: ModelRow) -> ModelRow:
    """The first model of the lineage."""
    while model.parent_id is not None:
        model = store.model(model.parent_id)
    return model


def _advice(found: diagnosis.Diagnosis, explained: float) -> str:
    """What to make of an effect that is named and slight; empty where it is not slight."""
    one = slight_one(found, explained)
    if one is None:
        return ""
    share = explained_part(one.before, one.after) / explained
    return (
        f"Next to nothing is left: {one.effect.title} would take {shown(one.gain.value)} of the held-out error away "
        f"(90 % interval {shown(one.gain.low)} .. {shown(one.gain.high)}), {share:.1%} of what the added effects "
        "explain. A formula that is nearly right leaves as much: this is no reason to add another effect."
    )


def _provisional(dataset: Dataset, curve: Provisional) -> ProvisionalTerm:
    gain = curve.gain
    return ProvisionalTerm(
        effect=curve.effect.name,
        title=curve.effect.title,
        held_out_before=curve.before,
        held_out_after=curve.after,
        gain=gain.value,
        gain_low=gain.low,
        gain_high=gain.high,
        sentence=(
            f"Until its physics is known, {curve.effect.name} can stand in the model as a provisional term: held-out "
            f"error {curve.before:.2%} to {curve.after:.2%} ({gain.in_words(curve.before, curve.after)})."
        ),
        picture=_picture(dataset, curve.picture),
    )


def _has_hidden_rival(members: tuple[str, ...], fit: Fit, found: diagnosis.Diagnosis) -> bool:
    """Whether a free scale of the model hides a rival, so that no trial could judge it; the answer tells its name."""
    hidden = [one for one in map(effect_named, found.left_out) if set(one.hidden_by) & set(fit.names)]
    return any(set(members) & set(one.confused_with) for one in hidden)


def _class(members: tuple[str, ...], hidden_rival: bool, joint: Joint) -> EffectClass:
    titles = [effect_named(name).title for name in members]
    if len(members) == 1:
        among = " among what these trials can judge" if hidden_rival else ""
        return EffectClass(effects=list(members), sentence=f"{titles[0]} stands alone{among}.", separating_trial=None)
    apart = "; ".join(dict.fromkeys(effect_named(name).excited_by for name in members))
    return EffectClass(
        effects=list(members),
        sentence=f"These trials cannot tell apart: {'; '.join(titles)}.",
        separating_trial=apart if joint != "nowhere" else None,
    )


def _ranking(dataset: Dataset, found: diagnosis.Diagnosis, named: set[str], first: str) -> list[Ranked]:
    """In `ORDER`; the lab lists one family of effects after the other."""

    def place(one: diagnosis.Candidate) -> tuple[bool, bool, float]:
        if one.effect.name in named:
            return False, False, 0.0  # as the class has them
        return True, bool(doubts(one)), -one.score if isfinite(one.score) else inf

    return [_ranked(dataset, one, named, first) for one in sorted(found.candidates, key=place)]


def _ranked(dataset: Dataset, candidate: diagnosis.Candidate, named: set[str], first: str) -> Ranked:
    effect = candidate.effect
    luck = f"{LUCK} ({chance_in_words(candidate.p_value)})"
    why_not = [luck if doubt == LUCK else doubt for doubt in doubts(candidate)]
    if not why_not and first and effect.name not in named:
        why_not = [f"{first} first"]
    return Ranked(
        effect=effect.name,
        title=effect.title,
        score=candidate.score,
        p_value=stated(candidate.p_value),
        held_out_before=candidate.before,
        held_out_after=candidate.after,
        gain=candidate.gain.value,
        gain_low=candidate.gain.low,
        gain_high=candidate.gain.high,
        in_class=effect.name in named,
        confused_with=list(candidate.rivals),
        d_prime=candidate.detectability,
        physical=candidate.physical,
        badge=candidate.badge,
        why_not=why_not,
        sentence=_sentence(candidate, why_not),
        picture=_picture(dataset, candidate.picture),
    )


def _sentence(candidate: diagnosis.Candidate, why_not: list[str]) -> str:
    gain = candidate.gain
    of = " of the breakaway effort" if candidate.rows == "breakaway" else ""
    parts = [
        f"held-out error{of} {candidate.before:.2%} to {candidate.after:.2%} "
        f"({gain.in_words(candidate.before, candidate.after)})"
    ]
    if why_not:
        parts.append(f"not named: {', '.join(why_not)}")
    if candidate.rivals:
        parts.append(f"not told apart from {', '.join(candidate.rivals)}")
    return "; ".join(parts) + "."


def _picture(dataset: Dataset, picture: diagnosis.Picture | None) -> Picture | None:
    if picture is None:
        return None
    driver = DRIVERS[picture.driver]
    return Picture(
        driver=driver.title,
        unit=driver.unit_in(dataset.effort_definition.unit, dataset.facts),
        against_motion=picture.against_motion,
        x=picture.residual.x.tolist(),
        residual=picture.residual.mean.tolist(),
        low=picture.residual.low.tolist(),
        high=picture.residual.high.tolist(),
        curve_x=picture.curve.x.tolist(),
        curve=picture.curve.mean.tolist(),
    )
