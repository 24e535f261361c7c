"""Moments of a study: when the joint was somewhere, and when an effect that the model lacks would act."""

import math
from collections.abc import Sequence

from bench.store import Store
from bench.study.errors import StudyError, lab_errors
from bench.study.material import Material, load_model
from bench.study.models.plots import Action, GainedMoment, Moment, Moments
from bench.study.plots.series import series_of
from compensator.lab.comparison import moments as lab
from compensator.lab.effects.catalogue import effect_named


def moments(store: Store, study_id: int, where: Sequence[str], model_id: int | None = None) -> Moments:
    """When the joint was somewhere, and how wrong the model was then.

    Args:
        store: with the study.
        study_id: which study.
        where: criteria `driver=low..high`, such as `velocity=0.5..1`.
        model_id: which model; None takes the newest.

    Raises:
        StudyError: no such model, a criterion that is none, or a driver that these trials do not have.
    """
    criteria = dict(_parse(text) for text in where)
    material, model = load_model(store, study_id, model_id)
    with lab_errors():
        found = lab.moments(material.fit_of(model), criteria)
    items = [_moment(material, one) for one in found]
    return Moments(study_id=study_id, model_id=model.id, effort=material.effort, items=items)


def action(store: Store, study_id: int, effect: str, model_id: int | None = None) -> Action:
    """When an effect that a model lacks would bring its prediction closer. Nothing is kept.

    Raises:
        StudyError: no such model, an unknown effect, one that the model has, or one that these trials cannot show.
    """
    material, model = load_model(store, study_id, model_id)
    with lab_errors():
        title = effect_named(effect).title
    if effect in model.effects:
        raise StudyError(f"model {model.id} has {effect} already; its effects are: {', '.join(model.effects)}")
    before = material.fit_of(model, beside=[effect])
    after = material.fit([*model.effects, effect], before.shapes, beside=model.effects)
    items = [
        GainedMoment(**dict(_moment(material, one.moment)), rms_with=one.rms_after, share=one.share)
        for one in lab.gained(before, after)
    ]
    return Action(
        study_id=study_id,
        model_id=model.id,
        effect=effect,
        title=title,
        effort=material.effort,
        items=items,
        series=series_of(material, after),
    )


def _moment(material: Material, one: lab.Moment) -> Moment:
    return Moment(
        trial_id=material.trials[one.trial].id,
        name=material.trials[one.trial].name,
        from_s=one.from_s,
        to_s=one.to_s,
        rows=one.rows,
        rms=one.rms,
        mean=one.mean,
    )


def _parse(text: str) -> tuple[str, tuple[float, float]]:
    name, _, ends = text.partition("=")
    low, dots, high = ends.partition("..")
    try:
        found = float(low), float(high)
    except ValueError:
        found = math.nan, math.nan
    if not (name and dots and found[0] <= found[1]):
        raise StudyError(f"'{text}' is no criterion; wanted driver=low..high, for instance velocity=0.5..1")
    return name.strip(), found
